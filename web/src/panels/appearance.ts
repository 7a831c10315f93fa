// How the map is made from the evidence: style, operators, threshold, palette.

import { cssColour, PALETTE_TITLES, PALETTES, rampColour } from '../palette';
import type { Page } from '../page';
import type { Operators, Style } from '../rules';
import { PATH_MINUTES } from '../settings';
import { h, setText } from '../ui/dom';
import { section, segmented, select, slider, toggle } from '../ui/controls';

export const STYLE_TITLES: Record<Style, string> = {
  visual: 'Visual', planning: 'Planning', motion: 'Motion', empty: 'Empty', confidence: 'Confidence', conflict: 'Conflict', changed: 'Changed',
};

const STYLE_WORDS: Record<Style, string> = {
  visual: 'Where something stands. Free and unknown are both blank, unknown is hatched.',
  planning: 'Safe for planning: what is unknown counts as free.',
  motion: 'Safe for motion: what is unknown counts as occupied.',
  empty: 'Membership in “empty”: how surely rays went through.',
  confidence: 'How many rays have met the cell, up to full confidence.',
  conflict: 'Where the evidence contradicts itself: empty and occupied alike.',
  changed: 'Where views of late disagree with what was known before.',
};

const OPERATOR_TITLES: readonly (readonly [Operators, string])[] = [
  ['algebraic', 'Algebraic'], ['minmax', 'Minimum and maximum'], ['lukasiewicz', 'Łukasiewicz'],
];

export function appearancePanel({ settings }: Page): HTMLElement {
  const style = segmented<Style>('Map rule', (Object.keys(STYLE_TITLES) as Style[]).map((key) => [key, STYLE_TITLES[key], STYLE_WORDS[key]]), (value) => settings.set({ style: value }));
  style.element.classList.add('rules');
  const words = h('p', { class: 'hint' });
  const operators = select('Operators', OPERATOR_TITLES, (value) => settings.set({ operators: value }));
  const threshold = slider('Obstacle from', { min: 0.02, max: 1, step: 0.01 }, (value) => value.toFixed(2), (value) => settings.set({ threshold: value }));
  const palette = paletteChoice((name) => settings.set({ palette: name }));
  const spread = slider('Spread layers', { min: 0, max: 2, step: 0.05 }, (value) => (value === 0 ? 'true height' : `${value.toFixed(2)} m apart`), (value) => settings.set({ spread: value }));
  const clip = slider('Cut above', { min: 0.1, max: 10, step: 0.1 }, (value) => (value >= 10 ? 'nothing' : `${value.toFixed(1)} m`), (value) => settings.set({ clipHeight: value }));
  const switches = [
    ['classes', toggle('Three classes only', (classes) => settings.set({ classes }), 'Occupied, free or unknown by the threshold, instead of shades')],
    ['colourByHeight', toggle('Colour by height', (colourByHeight) => settings.set({ colourByHeight }), 'Obstacles take the colour of their layer')],
    ['markConflict', toggle('Mark conflicts', (markConflict) => settings.set({ markConflict }), 'A lattice where the evidence contradicts itself')],
    ['showGrid', toggle('Grid', (showGrid) => settings.set({ showGrid }))],
    ['showPath', toggle('Path', (showPath) => settings.set({ showPath }))],
  ] as const;
  const pathBy = segmented<'time' | 'state'>('Colour of the path', [['time', 'By time'], ['state', 'By tracking']], (value) => settings.set({ pathBy: value }));
  const pathMinutes = segmented<string>('Length of the path', PATH_MINUTES.map((minutes) => [String(minutes), minutes === 0 ? 'All' : `Last ${minutes} min`]), (value) => settings.set({ pathMinutes: PATH_MINUTES.find((minutes) => String(minutes) === value) ?? 0 }));
  settings.watch(['style', 'operators', 'threshold', 'palette', 'classes', 'colourByHeight', 'markConflict', 'showGrid', 'showPath', 'pathBy', 'pathMinutes', 'solid', 'spread', 'clipHeight'], (now) => {
    spread.show(now.spread);
    clip.show(now.clipHeight);
    spread.element.hidden = clip.element.hidden = !now.solid;
    style.show(now.style);
    setText(words, STYLE_WORDS[now.style]);
    operators.show(now.operators);
    threshold.show(now.threshold);
    palette.show(now.palette);
    for (const [key, control] of switches) control.show(now[key]);
    pathBy.show(now.pathBy);
    pathMinutes.show(String(now.pathMinutes));
    pathBy.element.hidden = pathMinutes.element.hidden = !now.showPath;
  });
  return section('Map', 'map', style.element, words, operators.element, threshold.element, spread.element, clip.element, palette.element, ...switches.map(([, control]) => control.element), pathBy.element, pathMinutes.element);
}

function paletteChoice(choose: (name: (typeof PALETTES)[number]) => void): { element: HTMLElement; show(name: string): void } {
  const inputs = PALETTES.map((name) => h('input', { type: 'radio', name: 'palette', value: name, 'aria-label': PALETTE_TITLES[name], onchange: () => choose(name) }));
  const swatches = PALETTES.map((name, i) => {
    const band = h('span', { class: 'swatch' });
    const stops = Array.from({ length: 9 }, (_, k) => cssColour(rampColour(name, k / 8)));
    band.style.background = `linear-gradient(90deg, ${stops.join(', ')})`;
    return h('label', { title: PALETTE_TITLES[name] }, inputs[i], band, h('span', { class: 'swatch-name' }, PALETTE_TITLES[name]));
  });
  const element = h('div', { class: 'palettes', role: 'radiogroup', 'aria-label': 'Palette' }, ...swatches);
  return { element, show: (name) => inputs.forEach((input) => (input.checked = input.value === name)) };
}
