// On narrow screens the panels become one sheet under the map, chosen by tabs.

import type { Page, Sheet } from '../page';
import { h } from '../ui/dom';
import { icon, type IconName } from '../ui/icons';

const TABS: readonly (readonly [Sheet, IconName, string])[] = [['map', 'layers', 'Map'], ['camera', 'camera', 'Camera'], ['cell', 'target', 'Cell'], ['status', 'pulse', 'Status']];

export function tabs({ focus }: Page): HTMLElement {
  const buttons = TABS.map(([sheet, name, title]) =>
    h('button', { type: 'button', onclick: () => focus.set({ sheet: focus.get().sheet === sheet ? 'none' : sheet }) }, icon(name), h('span', {}, title)));
  focus.watch(['sheet'], ({ sheet }) => {
    document.body.dataset['sheet'] = sheet;
    buttons.forEach((button, i) => button.setAttribute('aria-pressed', String(TABS[i]?.[0] === sheet)));
  });
  return h('nav', { class: 'tabs', 'aria-label': 'Panels' }, ...buttons);
}
