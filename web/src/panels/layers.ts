// The layers, highest first: show, show alone, opacity. A key 1 to 9 switches the layer of that number.

import type { Layer } from '../gen/flogmap/v1/map_pb';
import { cssColour, layerColour } from '../palette';
import type { Page } from '../page';
import { layerSetting, withLayer } from '../settings';
import { h } from '../ui/dom';
import { iconButton, section, setIcon, slider } from '../ui/controls';

export function layersPanel(page: Page): HTMLElement {
  const list = h('ul', { class: 'layers' });
  const hint = h('p', { class: 'hint' }, 'Fused in this page: the largest value of the visible layers.');
  let stops: (() => void)[] = [];
  const rebuild = (): void => {
    for (const stop of stops) stop();
    page.view.tiles.pointAt(-1); // the row that was pointed at is gone
    const layers = page.live.info?.layers ?? [];
    const built = layers.map((layer, i) => layerRow(page, layer, i, layers.length));
    stops = built.map(({ stop }) => stop);
    const rows = built.map(({ row }) => row);
    list.replaceChildren(...(rows.length > 0 ? rows.reverse() : [h('li', { class: 'empty' }, 'Layers appear with the map.')]));
  };
  page.live.begun.on(rebuild);
  page.focus.watch(['theme'], rebuild);
  return section('Layers', 'map', list, hint);
}

function layerRow(page: Page, layer: Layer, index: number, count: number): { row: HTMLElement; stop: () => void } {
  const { settings } = page;
  const change = (patch: { visible?: boolean; opacity?: number }): void => settings.set(withLayer(settings.get(), layer.id, patch));
  const dot = h('span', { class: 'layer-dot', 'aria-hidden': 'true' });
  dot.style.background = cssColour(layerColour(index, count, page.focus.get().theme));
  const name = layerName(layer);
  const eye = iconButton('eye', `Hide ${name}`, () => change({ visible: !layerSetting(settings.get(), layer.id).visible }));
  const solo = iconButton('solo', `Show only ${name}`, () => toggleSolo(page, layer.id));
  const opacity = slider(`Opacity of ${name}`, { min: 0, max: 1, step: 0.05 }, (value) => `${Math.round(100 * value)} %`, (value) => change({ opacity: value }));
  const row = h('li', { class: 'layer' },
    h('div', { class: 'layer-head' }, dot, h('span', { class: 'layer-name' }, name, h('kbd', {}, String(index + 1))), solo, eye),
    h('div', { class: 'layer-foot' }, h('span', { class: 'layer-range' }, `${formatHeight(layer.zMin)} – ${formatHeight(layer.zMax)}`), opacity.element));
  for (const [event, pointed] of [['pointerenter', true], ['focusin', true], ['pointerleave', false], ['focusout', false]] as const)
    row.addEventListener(event, () => {
      page.view.tiles.pointAt(pointed ? index : -1);
      page.view.requestDraw();
    });
  const stop = settings.watch(['layers'], (now) => {
    const { visible, opacity: value } = layerSetting(now, layer.id);
    row.classList.toggle('off', !visible);
    setIcon(eye, visible ? 'eye' : 'eyeOff', `${visible ? 'Hide' : 'Show'} ${name}`);
    eye.setAttribute('aria-pressed', String(visible));
    opacity.show(value);
  });
  return { row, stop };
}

/** The layer's name; a name that only repeats its heights is replaced by its number. */
export const layerName = ({ id, name }: Layer): string => (name === '' || /^-?[\d.]+\s*[-–]/.test(name) ? `Layer ${id + 1}` : name);

const formatHeight = (z: number): string => `${z.toFixed(2)} m`;

/** Shows one layer alone; again, and all are back. */
export function toggleSolo(page: Page, id: number): void {
  const { settings, live } = page;
  const layers = live.info?.layers ?? [];
  const alone = layers.every((layer) => layerSetting(settings.get(), layer.id).visible === (layer.id === id));
  for (const layer of layers) settings.set(withLayer(settings.get(), layer.id, { visible: alone || layer.id === id }));
}
