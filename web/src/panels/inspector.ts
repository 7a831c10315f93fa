// The evidence of one cell in every layer: what the page holds at once, then the server's full precision.

import type { CellEvidence, Layer } from '../gen/flogmap/v1/map_pb';
import type { Page } from '../page';
import { conflictValue, mapValue, motionValue, planningValue, styleValue, type Evidence, type Operators } from '../rules';
import { columnAt, keyText, tileAt } from '../tile_store';
import { h, setText } from '../ui/dom';
import { iconButton, section } from '../ui/controls';
import { layerName } from './layers';
import type { Point } from '../viewport';

interface LayerEvidence extends Evidence {
  readonly layer: Layer;
  readonly rays: number | undefined; // only the server knows
}

const ASK_EVERY_MS = 1000;

export function inspectorPanel(page: Page): HTMLElement {
  const where = h('p', { class: 'cell-where' });
  const body = h('div', { class: 'cell-body' });
  const pins = h('div', { class: 'cell-pins' });
  const copy = iconButton('copy', 'Copy as JSON', () => void navigator.clipboard.writeText(asJson(page)).then(() => page.live.noticed.emit({ tone: 'info', text: 'Cell copied as JSON.' })), 'C');
  const pin = iconButton('pin', 'Pin this cell', () => pinCell(page), 'P');
  const link = h('a', { class: 'rest-link', target: '_blank', rel: 'noopener' }, 'REST');
  const element = section('Cell', 'cell', h('div', { class: 'cell-head' }, where, link, pin, copy), body, pins);
  const show = (): void => {
    const cell = page.focus.get().cell ?? page.focus.get().hover;
    copy.disabled = pin.disabled = page.focus.get().cell === undefined;
    const url = cell ? page.backend.cellUrl(cell.x, cell.y) : undefined;
    link.hidden = !url || page.focus.get().cell === undefined;
    if (url) link.href = url;
    setText(where, cell ? `x ${cell.x.toFixed(2)} m   y ${cell.y.toFixed(2)} m` : '');
    body.replaceChildren(...bodyRows(page, cell));
  };
  page.focus.watch(['cell', 'hover'], show);
  page.focus.watch(['pins'], () => pins.replaceChildren(...pinRows(page)));
  page.live.columnChanged.on(show);
  page.live.tilesChanged.on(show);
  page.settings.watch(['operators', 'style'], show);
  const ask = (): void => {
    const { cell } = page.focus.get();
    if (cell) page.connection.inspect(cell.x, cell.y);
  };
  page.focus.watch(['cell'], ask);
  page.focus.watch(['cell'], ({ cell }) => { if (cell) element.scrollIntoView({ block: 'nearest' }); });
  setInterval(ask, ASK_EVERY_MS);
  return element;
}

/** The server's answer if it is about this cell, else the page's own copy. */
export function evidenceAt(page: Page, cell: Point): LayerEvidence[] | undefined {
  const { info, column, tiles } = page.live;
  if (!info) return undefined;
  const answer = column && Math.hypot(column.x - cell.x, column.y - cell.y) < 1e-6 ? column.layers : [];
  const own = columnAt(tiles, cell.x, cell.y, info.cellSize);
  if (!own && answer.length === 0) return undefined;
  return info.layers.map((layer, i) => {
    const exact = answer.find((evidence) => evidence.layer === layer.id);
    return exact ? fromServer(layer, exact) : { layer, rays: undefined, ...(own?.[i] ?? { E: 0, O: 0, K: 0, C: 0 }) };
  });
}

const fromServer = (layer: Layer, e: CellEvidence): LayerEvidence => ({ layer, rays: e.rays, E: e.empty, O: e.occupied, K: e.confidence, C: e.change });

function bodyRows(page: Page, cell: Point | undefined): HTMLElement[] {
  if (!cell) return [h('p', { class: 'empty' }, 'Point at the map to read a cell, click to hold it.')];
  const evidence = evidenceAt(page, cell);
  if (!evidence) return [h('p', { class: 'empty' }, 'Never seen: no ray has come near this place.')];
  const tile = tileAt(page.live.tiles, cell.x, cell.y, page.live.info?.cellSize ?? 1);
  const about = tile ? [h('p', { class: 'hint cell-tile' }, `Tile ${keyText(tile)}, last changed in revision ${tile.rev}`)] : [];
  return [...[...evidence].reverse().map((layer) => layerBlock(page.settings.get().operators, layer)), ...about];
}

function layerBlock(operators: Operators, e: LayerEvidence): HTMLElement {
  const { E, O, K } = e;
  const bars = ([['E', 'Empty', E], ['O', 'Occupied', O], ['K', 'Confidence', K]] as const).map(([letter, name, value]) => bar(letter, name, value));
  const values = ([
    ['M', 'map value', mapValue(operators, E, O, K)], ['Mp', 'safe for planning', planningValue(operators, O, K)],
    ['Mm', 'safe for motion', motionValue(operators, E, O, K)], ['Cf', 'conflict', conflictValue(E, O, K)], ['Δ', 'changed lately', e.C],
  ] as const).map(([letter, name, value]) => h('span', { title: name }, h('b', {}, letter), ` ${value.toFixed(2)}`));
  return h('div', { class: 'cell-layer', 'data-layer': e.layer.id },
    h('div', { class: 'cell-layer-head' }, h('span', {}, layerName(e.layer)), h('span', { class: 'rays' }, e.rays === undefined ? 'N …' : `N ${e.rays}`)),
    ...bars, h('div', { class: 'cell-values' }, ...values));
}

function bar(letter: string, name: string, value: number): HTMLElement {
  const fill = h('span', { class: `bar-fill bar-${letter}` });
  fill.style.width = `${100 * value}%`;
  return h('div', { class: 'bar', title: name }, h('b', {}, letter), h('span', { class: 'bar-track' }, fill), h('span', { class: 'bar-value' }, value.toFixed(3)));
}

export function pinCell(page: Page): void {
  const { cell, pins } = page.focus.get();
  if (cell && !pins.some((pin) => pin.x === cell.x && pin.y === cell.y)) page.focus.set({ pins: [...pins, cell] });
}

function pinRows(page: Page): HTMLElement[] {
  return page.focus.get().pins.map((point, i) => {
    const evidence = evidenceAt(page, point) ?? [];
    const { style, operators } = page.settings.get();
    const value = Math.max(0, ...evidence.map((e) => styleValue(style, operators, e)));
    const remove = iconButton('close', `Remove pin ${i + 1}`, (event) => {
      event.stopPropagation();
      page.focus.set({ pins: page.focus.get().pins.filter((pin) => pin !== point) });
    });
    return h('div', { class: 'pin-row' }, h('button', { type: 'button', class: 'pin-go', onclick: () => page.focus.set({ cell: point }) },
      h('span', { class: 'pin-number' }, String(i + 1)), `${point.x.toFixed(2)}, ${point.y.toFixed(2)}`, h('b', {}, value.toFixed(2))), remove);
  });
}

export function asJson(page: Page): string {
  const { cell } = page.focus.get();
  const layers = (cell ? evidenceAt(page, cell) : undefined) ?? [];
  const { operators } = page.settings.get();
  return JSON.stringify({
    x: cell?.x, y: cell?.y, epoch: page.live.info?.epoch, rev: Number(page.live.rev), operators,
    layers: layers.map(({ layer, E, O, K, C, rays }) => ({
      layer: layer.id, z_min: layer.zMin, z_max: layer.zMax, empty: E, occupied: O, confidence: K, rays, value: mapValue(operators, E, O, K),
      planning: planningValue(operators, O, K), motion: motionValue(operators, E, O, K), conflict: conflictValue(E, O, K), change: C,
    })),
  }, null, 2);
}
