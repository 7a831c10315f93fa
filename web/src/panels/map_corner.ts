// The lower right corner of the map: scale bar, and where the pointer is.

import type { Page } from '../page';
import { gridStep } from '../scene/grid_lines';
import { h, setText } from '../ui/dom';
import { formatLength, roundLength } from '../viewport';

const BAR_PX = 110; // at most

export function mapCorner(page: Page): HTMLElement {
  const bar = h('div', { class: 'scale-bar', 'aria-hidden': 'true' });
  const length = h('span', { class: 'scale-length' });
  const grid = h('span', { class: 'scale-grid' });
  const spot = h('span', { class: 'pointer-spot' });
  page.view.drawn.on((view) => {
    const metres = roundLength(BAR_PX / view.scale);
    bar.style.width = `${metres * view.scale}px`;
    setText(length, formatLength(metres));
    setText(grid, page.settings.get().showGrid ? `grid ${formatLength(gridStep(view))}` : '');
  });
  page.focus.watch(['hover'], ({ hover }) => setText(spot, hover ? `${hover.x.toFixed(2)}, ${hover.y.toFixed(2)} m` : ''));
  return h('div', { class: 'map-corner' }, spot, h('div', { class: 'scale' }, h('div', { class: 'scale-text' }, length, grid), bar));
}
