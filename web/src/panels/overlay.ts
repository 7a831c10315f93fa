// What lies over the map as crisp lines: the chosen cell, pins, the measuring line, the route.

import { areaOf, lengthOf } from '../geometry';
import { attempt, type Page } from '../page';
import type { Route } from '../backend';
import { append, h, setText, svg } from '../ui/dom';
import { slider } from '../ui/controls';
import type { Point } from '../viewport';

export interface Overlay {
  readonly element: HTMLElement;
  /** A click on the map while a tool other than the inspector is chosen. */
  click(world: Point): void;
  /** Takes back the last point; false if there is none. */
  back(): boolean;
}

interface Work {
  measured: Point[];
  from: Point | undefined;
  route: Route | undefined;
}

export function overlay(page: Page): Overlay {
  const drawing = svg('svg', { class: 'overlay-lines', 'aria-hidden': 'true' });
  const words = h('span', { role: 'status' });
  const radius = slider('Robot radius', { min: 0.05, max: 1, step: 0.05 }, (value) => `${value.toFixed(2)} m`, (robotRadius) => page.settings.set({ robotRadius }));
  page.settings.watch(['robotRadius'], (now) => radius.show(now.robotRadius));
  const card = h('div', { class: 'tool-card', hidden: true }, words, radius.element);
  const work: Work = { measured: [], from: undefined, route: undefined };
  const redraw = (): void => {
    drawing.replaceChildren();
    drawCells(page, drawing);
    drawMeasure(page, drawing, work);
    drawRoute(page, drawing, work);
    const { tool } = page.focus.get();
    card.hidden = tool === 'inspect';
    radius.element.hidden = tool !== 'route';
    setText(words, tool === 'measure' ? measureWords(work.measured, page.focus.get().hover, page.live.info?.cellSize ?? 0) : routeWords(work));
  };
  page.view.drawn.on(redraw);
  page.focus.changed.on(({ now, before }) => {
    if (now.tool !== before.tool) Object.assign(work, { measured: [], from: undefined, route: undefined });
    redraw();
  });
  return { element: h('div', { class: 'overlay' }, drawing, card), click: (world) => clicked(page, work, world, redraw), back: () => takeBack(work, redraw) };
}

function clicked(page: Page, work: Work, world: Point, redraw: () => void): void {
  if (page.focus.get().tool === 'measure') work.measured.push(world);
  else if (!work.from || work.route) Object.assign(work, { from: world, route: undefined });
  else {
    const asked = page.backend.route(work.from, world, page.settings.get().robotRadius);
    void attempt(page, asked.then((route) => {
      work.route = route;
      redraw();
    }));
  }
  redraw();
}

function takeBack(work: Work, redraw: () => void): boolean {
  const had = work.measured.length > 0 || work.from !== undefined;
  work.measured.pop();
  Object.assign(work, { from: undefined, route: undefined });
  redraw();
  return had;
}

const at = (page: Page, p: Point): string => {
  const { x, y } = page.view.project(p.x, p.y);
  return `${x.toFixed(1)} ${y.toFixed(1)}`;
};

function drawCells(page: Page, drawing: SVGElement): void {
  const size = page.live.info?.cellSize;
  if (!size) return;
  const { cell, pins } = page.focus.get();
  const square = (p: Point): string => {
    const x = Math.floor(p.x / size) * size;
    const y = Math.floor(p.y / size) * size;
    return `M${[{ x, y }, { x: x + size, y }, { x: x + size, y: y + size }, { x, y: y + size }].map((q) => at(page, q)).join(' L')}Z`;
  };
  if (cell) {
    const { x, y } = page.view.project(cell.x, cell.y);
    drawing.append(svg('path', { d: square(cell), class: 'cell-square' }), svg('circle', { cx: x, cy: y, r: 11, class: 'cell-ring-case' }), svg('circle', { cx: x, cy: y, r: 11, class: 'cell-ring' }));
  }
  pins.forEach((pin, i) => {
    const { x, y } = page.view.project(pin.x, pin.y);
    const text = svg('text', { x, y: y - 15, class: 'pin-text' });
    text.textContent = String(i + 1);
    drawing.append(svg('path', { d: `M${x} ${y}l-5-9a9 9 0 1 1 10 0Z`, class: 'pin-mark' }), text);
  });
}

function drawMeasure(page: Page, drawing: SVGElement, { measured }: Work): void {
  const { tool, hover } = page.focus.get();
  if (tool !== 'measure') return;
  const points = hover && measured.length > 0 ? [...measured, hover] : measured;
  if (points.length > 1) line(page, drawing, points, 'measure-line');
  for (const point of measured) dot(page, drawing, point, 'measure-dot');
}

function drawRoute(page: Page, drawing: SVGElement, { from, route }: Work): void {
  if (page.focus.get().tool !== 'route') return;
  if (route && route.points.length > 1) line(page, drawing, route.points, 'route-line');
  for (const point of [from, route?.points.at(-1)]) if (point) dot(page, drawing, point, 'route-dot');
}

function line(page: Page, drawing: SVGElement, points: readonly Point[], kind: string): void {
  const d = `M${points.map((point) => at(page, point)).join(' L')}`;
  append(drawing, [svg('path', { d, class: 'line-case' }), svg('path', { d, class: kind })]);
}

function dot(page: Page, drawing: SVGElement, point: Point, kind: string): void {
  const { x, y } = page.view.project(point.x, point.y);
  drawing.append(svg('circle', { cx: x, cy: y, r: 4, class: kind }));
}

/** Length of the line, last leg, and area from three points on; each end may be half a cell off. */
export function measureWords(measured: readonly Point[], hover: Point | undefined, cellSize: number): string {
  if (measured.length === 0) return 'Measure: click the first point. Backspace takes a point back, Esc ends.';
  const points = hover ? [...measured, hover] : measured;
  const error = (cellSize / Math.SQRT2) * Math.max(1, points.length - 1);
  const length = `${lengthOf(points).toFixed(2)} m ± ${error.toFixed(2)}`;
  const leg = points.length > 2 ? `, last leg ${lengthOf(points.slice(-2)).toFixed(2)} m` : '';
  return `${length}${leg}${points.length > 2 ? `, area ${areaOf(points).toFixed(2)} m²` : ''}`;
}

function routeWords({ from, route }: Work): string {
  if (route) return `Route: ${route.lengthM.toFixed(2)} m, least clearance ${route.clearanceM.toFixed(2)} m. Click to begin another.`;
  return from ? 'Route: click where to go.' : 'Route: click where to start.';
}
