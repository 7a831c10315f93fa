// What lies over the map as crisp lines: the chosen cell, pins, the measuring line, the route.

import { areaOf, lengthOf } from '../geometry';
import type { Page } from '../page';
import { append, h, setText, svg } from '../ui/dom';
import { LevelTool } from './level_tool';
import { RobotTool } from './robot_tool';
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
}

export function overlay(page: Page): Overlay {
  const drawing = svg('svg', { class: 'overlay-lines', 'aria-hidden': 'true' });
  const words = h('span', { role: 'status' });
  const work: Work = { measured: [] };
  const robot = new RobotTool(page, () => redraw());
  const level = new LevelTool(page);
  const card = h('div', { class: 'tool-card', hidden: true }, words, robot.element, level.element);
  const redraw = (): void => {
    drawing.replaceChildren();
    drawCells(page, drawing);
    drawMeasure(page, drawing, work);
    drawRoute(page, drawing, robot);
    const { tool } = page.focus.get();
    card.hidden = tool === 'inspect';
    robot.element.hidden = tool !== 'route';
    setText(words, tool === 'measure' ? measureWords(work.measured, page.focus.get().hover, page.live.info?.cellSize ?? 0) : '');
  };
  page.view.drawn.on(redraw);
  page.focus.changed.on(({ now, before }) => {
    if (now.tool !== before.tool) {
      work.measured = [];
      robot.clear();
    } else redraw();
  });
  const back = (): boolean => {
    if (page.focus.get().tool === 'route') return robot.back();
    const had = work.measured.pop() !== undefined;
    redraw();
    return had;
  };
  const click = (world: Point): void => {
    if (page.focus.get().tool === 'route') return robot.click(world);
    if (page.focus.get().tool !== 'measure') return;
    work.measured.push(world);
    redraw();
  };
  return { element: h('div', { class: 'overlay' }, drawing, card), click, back };
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

function drawRoute(page: Page, drawing: SVGElement, { from, to, route }: RobotTool): void {
  if (page.focus.get().tool !== 'route') return;
  if (route && route.points.length > 1) line(page, drawing, route.points, 'route-line');
  for (const point of [from, route?.points.at(-1) ?? to]) if (point) dot(page, drawing, point, 'route-dot');
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
  const rests = hover && measured.at(-1)?.x === hover.x && measured.at(-1)?.y === hover.y; // on the point just clicked
  const points = hover && !rests ? [...measured, hover] : measured;
  const error = (cellSize / Math.SQRT2) * Math.max(1, points.length - 1);
  const length = `${lengthOf(points).toFixed(2)} m ± ${error.toFixed(2)}`;
  const leg = points.length > 2 ? `, last leg ${lengthOf(points.slice(-2)).toFixed(2)} m` : '';
  return `${length}${leg}${points.length > 2 ? `, area ${areaOf(points).toFixed(2)} m²` : ''}`;
}
