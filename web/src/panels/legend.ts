// What the colours mean, always in step with what is drawn: ramp with numbers, or classes; unknown and conflict hatched.

import { classColours, cssColour, layerColour, rampColour, type Rgb } from '../palette';
import type { Page } from '../page';
import { CONFLICT_MARK, type Style } from '../rules';
import { layerSetting, type Settings } from '../settings';
import { h, svg } from '../ui/dom';
import { hatchColour } from '../scene/map_material';

const ENDS: Record<Style, readonly [string, string, string]> = {
  visual: ['Map value M', 'free', 'occupied'],
  planning: ['Planning value', 'free or unknown', 'blocked'],
  motion: ['Motion value', 'safe', 'unsafe or unknown'],
  empty: ['Empty E', 'not empty', 'empty'],
  confidence: ['Confidence K', 'no rays', 'full'],
  conflict: ['Conflict', 'none', 'full'],
  changed: ['Changed lately', 'no', 'much'],
};

export function legend(page: Page): HTMLElement {
  const element = h('figure', { class: 'legend', role: 'group', 'aria-label': 'Legend' });
  const rebuild = (): void => element.replaceChildren(...legendRows(page));
  page.settings.watch(['style', 'palette', 'classes', 'threshold', 'colourByHeight', 'markConflict', 'layers'], rebuild);
  page.focus.watch(['theme'], rebuild);
  page.live.begun.on(rebuild);
  return element;
}

function legendRows(page: Page): HTMLElement[] {
  const settings = page.settings.get();
  const { theme } = page.focus.get();
  const colours = classColours(settings.palette, theme);
  const [title, low, high] = ENDS[settings.style];
  const keys = [keyRow(hatched(colours.unknown, hatchColour(colours.unknown, theme), 'lines'), settings.style === 'motion' ? 'Unknown (counts as occupied)' : 'Unknown')];
  if (settings.style === 'motion') keys.splice(0, 1, keyRow(hatched(settings.colourByHeight ? colours.free : colours.occupied, colours.unknown, 'lines'), 'Unknown, counts as occupied'));
  if (settings.markConflict) keys.push(keyRow(hatched(colours.occupied, colours.conflict, 'lattice'), `Conflict from ${CONFLICT_MARK}`));
  if (settings.colourByHeight) keys.push(...heightRows(page, settings));
  const head = h('figcaption', {}, title);
  if (settings.classes) {
    const classes = [keyRow(plain(colours.free), low), ...(settings.colourByHeight ? [] : [keyRow(plain(colours.occupied), `${high}, from ${settings.threshold.toFixed(2)}`)])];
    return [head, ...classes, ...keys];
  }
  return [head, ramp(settings, low, high, colours.free), ...keys];
}

function heightRows(page: Page, settings: Settings): HTMLElement[] {
  const layers = page.live.info?.layers ?? [];
  return layers
    .map((layer, i) => ({ layer, colour: layerColour(i, layers.length, page.focus.get().theme) }))
    .filter(({ layer }) => layerSetting(settings, layer.id).visible)
    .map(({ layer, colour }) => keyRow(plain(colour), `${layer.zMin.toFixed(2)} – ${layer.zMax.toFixed(2)} m`));
}

function ramp(settings: Settings, low: string, high: string, free: Rgb): HTMLElement {
  const band = h('div', { class: 'ramp' });
  const stops = settings.colourByHeight ? [cssColour(free), 'var(--text-3)'] : Array.from({ length: 13 }, (_, i) => cssColour(rampColour(settings.palette, i / 12)));
  band.style.background = `linear-gradient(90deg, ${stops.join(', ')})`;
  const mark = h('span', { class: 'ramp-mark', title: `Obstacle from ${settings.threshold.toFixed(2)}` });
  mark.style.left = `${100 * settings.threshold}%`;
  band.append(mark);
  return h('div', {}, band, h('div', { class: 'ramp-ends' }, h('span', {}, `0 ${low}`), h('span', {}, `${high} 1`)));
}

const keyRow = (sample: Element, text: string): HTMLElement => h('div', { class: 'key-row' }, sample, h('span', {}, text));

function plain(rgb: Rgb): SVGElement {
  return svg('svg', { class: 'key-sample', viewBox: '0 0 20 12' }, svg('rect', { width: 20, height: 12, fill: cssColour(rgb) }));
}

function hatched(under: Rgb, line: Rgb, kind: 'lines' | 'lattice'): SVGElement {
  const sample = plain(under);
  const d = kind === 'lines' ? 'M-2 12 10-2 M5 14 19-2 M13 14 25-2' : 'M-2 12 10-2 M5 14 19-2 M13 14 25-2 M22 12 10-2 M15 14 1-2 M7 14-5-2';
  sample.append(svg('path', { d, stroke: cssColour(line), 'stroke-width': kind === 'lines' ? 1.2 : 1.6, fill: 'none' }));
  return sample;
}
