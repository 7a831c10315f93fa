// What the keys do, on "?".

import { h } from '../ui/dom';
import { button } from '../ui/controls';

const KEYS: readonly (readonly [string, string])[] = [
  ['Drag, arrow keys', 'move the map'], ['Wheel, + −, pinch', 'zoom'], ['Right drag, Q E, twist', 'turn the map'], ['0', 'show the whole map'], ['N', 'north up'],
  ['F', 'follow the camera: north up, heading up, free'], ['V', 'flat map or layers at their height'], ['W', 'walk through the mapped views; W A S D move, drag looks, Esc leaves'], ['H', 'hold the picture while the map goes on'], ['1 … 9', 'show or hide a layer'], ['Shift 1 … 9', 'show a layer alone'],
  ['Click', 'read a cell'], ['P, C', 'pin the cell, copy it as JSON'], ['M', 'measure: lengths and areas'], ['R', 'route: two clicks'], ['T', 'level and turn the map by hand'], ['S', 'next map rule'], ['G', 'grid'],
  ['Space', 'pause or go on mapping'], ['L', 'copy a link to this view'], ['[  ]', 'panels on the left and right'], ['Esc', 'leave the tool, let go of the cell'],
];

export function showHelp(): void {
  const dialog = h('dialog', { class: 'dialog help', 'aria-label': 'Keys' },
    h('h2', {}, 'Keys'),
    h('dl', { class: 'keys' }, ...KEYS.flatMap(([keys, what]) => [h('dt', {}, ...keys.split(', ').map((key) => h('kbd', {}, key))), h('dd', {}, what)])),
    h('div', { class: 'dialog-buttons' }, button('Close', () => dialog.close(), 'primary')));
  dialog.addEventListener('close', () => dialog.remove());
  dialog.addEventListener('click', (event) => {
    if (event.target === dialog) dialog.close();
  });
  document.body.append(dialog);
  dialog.showModal();
}
