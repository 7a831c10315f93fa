// The tools at the map's edge.

import type { Page, Tool } from '../page';
import type { Follow } from '../settings';
import { h } from '../ui/dom';
import { iconButton, setIcon } from '../ui/controls';
import { toggleWalk } from './walk_hud';

export const FOLLOW_TITLES: Record<Follow, string> = { free: 'Free view', north: 'Follow, north up', heading: 'Follow, heading up' };
const NEXT_FOLLOW: Record<Follow, Follow> = { free: 'north', north: 'heading', heading: 'free' };

export const nextFollow = (page: Page): void => page.settings.set({ follow: NEXT_FOLLOW[page.settings.get().follow] });
export const toggleTool = (page: Page, tool: Tool): void => page.focus.set({ tool: page.focus.get().tool === tool ? 'inspect' : tool });

export const toggleHold = ({ focus }: Page): void => focus.set({ heldSince: focus.get().heldSince > 0 ? 0 : Date.now() });

export function toolbar(page: Page): HTMLElement {
  const { view, settings, focus } = page;
  const follow = iconButton('follow', FOLLOW_TITLES.free, () => nextFollow(page), 'F');
  const north = iconButton('compass', 'Turn north up', () => view.glideTo({ ...view.viewport, turn: 0 }), 'N');
  const solid = iconButton('cube', 'Layers at their height', () => settings.set({ solid: !settings.get().solid }), 'V');
  const measure = iconButton('ruler', 'Measure', () => toggleTool(page, 'measure'), 'M');
  const hold = iconButton('pause', 'Hold the picture', () => toggleHold(page), 'H');
  const route = iconButton('route', 'Route', () => toggleTool(page, 'route'), 'R');
  const level = iconButton('level', 'Level the map', () => toggleTool(page, 'level'), 'T');
  const walk = iconButton('person', 'Walk through the mapped views', () => toggleWalk(page), 'W');
  settings.watch(['follow', 'solid'], (now) => {
    follow.setAttribute('aria-pressed', String(now.follow !== 'free'));
    follow.title = `${FOLLOW_TITLES[now.follow]}  (F)`;
    follow.setAttribute('aria-label', FOLLOW_TITLES[now.follow]);
    solid.setAttribute('aria-pressed', String(now.solid));
  });
  focus.watch(['tool', 'heldSince', 'walking'], ({ tool, heldSince, walking }) => {
    walk.setAttribute('aria-pressed', String(walking));
    hold.setAttribute('aria-pressed', String(heldSince > 0));
    setIcon(hold, heldSince > 0 ? 'play' : 'pause', heldSince > 0 ? 'Let the picture go on' : 'Hold the picture');
    measure.setAttribute('aria-pressed', String(tool === 'measure'));
    route.setAttribute('aria-pressed', String(tool === 'route'));
    level.setAttribute('aria-pressed', String(tool === 'level'));
  });
  const needle = north.querySelector('svg');
  view.drawn.on(({ turn }) => {
    if (needle) needle.style.transform = `rotate(${turn}rad)`;
    north.classList.toggle('quiet', Math.abs(turn) < 1e-3);
  });
  return h('div', { class: 'toolbar', role: 'toolbar', 'aria-label': 'Map tools' },
    h('div', { class: 'tool-group' }, iconButton('plus', 'Zoom in', () => view.zoomBy(1.5), '+'), iconButton('minus', 'Zoom out', () => view.zoomBy(1 / 1.5), '−'), iconButton('fit', 'Show the whole map', () => showAll(page), '0')),
    h('div', { class: 'tool-group' }, follow, north, solid, hold),
    h('div', { class: 'tool-group' }, measure, route, level), h('div', { class: 'tool-group tool-group-walk' }, walk));
}

export function showAll(page: Page): void {
  page.settings.set({ follow: 'free' });
  page.view.fitMap();
}
