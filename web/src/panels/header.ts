// The top of the page: whose map this is, how it runs, and whether it is live.

import { attempt, type Page } from '../page';
import type { ThemeChoice } from '../settings';
import { h, setText } from '../ui/dom';
import { confirm, iconButton, setIcon } from '../ui/controls';
import { mark, type IconName } from '../ui/icons';
import { connectionChip } from './connection_chip';

const STATE_WORDS: Record<string, string> = {
  starting: 'Starting', running: 'Mapping', paused: 'Paused', finished: 'Finished', failed: 'Failed', stored: 'Stored map', draining: 'Shutting down',
};
const THEMES: Record<ThemeChoice, readonly [IconName, string, ThemeChoice]> = {
  auto: ['auto', 'Theme: as the system', 'dark'], dark: ['moon', 'Theme: dark', 'light'], light: ['sun', 'Theme: light', 'auto'],
};

const EXPORTS = [
  ['ros', 'ROS map (pgm + yaml)'], ['png', 'Picture (png)'], ['ply', 'Points (ply)'], ['pcd', 'Points (pcd)'], ['bt', 'OctoMap (bt)'], ['tum', 'Path (TUM)'], ['kitti', 'Path (KITTI)'],
] as const;

export function header(page: Page, actions: { share(): void; help(): void }): HTMLElement {
  const left = iconButton('sliders', 'Map and layers', () => page.settings.set({ leftPanel: !page.settings.get().leftPanel }), '[');
  const right = iconButton('camera', 'Camera, cell and status', () => page.settings.set({ rightPanel: !page.settings.get().rightPanel }), ']');
  for (const button of [left, right]) button.classList.add('wide-only');
  page.settings.watch(['leftPanel', 'rightPanel'], (now) => {
    left.setAttribute('aria-pressed', String(now.leftPanel));
    right.setAttribute('aria-pressed', String(now.rightPanel));
  });
  return h('header', { class: 'header' },
    h('div', { class: 'brand' }, mark(), h('h1', {}, 'flogmap')), left, sessionControls(page), h('div', { class: 'spacer' }), connectionChip(page),
    h('div', { class: 'header-tools' }, exportMenu(page), iconButton('link', 'Copy a link to this view', actions.share, 'L'), themeButton(page), iconButton('help', 'Keys and help', actions.help, '?'), right));
}

function sessionControls(page: Page): HTMLElement {
  const words = h('span', { class: 'session-words' });
  const dot = h('span', { class: 'session-dot', 'aria-hidden': 'true' });
  const pause = iconButton('pause', 'Pause mapping', () => void togglePause(page), 'Space');
  const reset = iconButton('reset', 'Begin a new map', () => void askReset(page));
  const element = h('div', { class: 'session' }, dot, words, pause, reset);
  const show = (): void => {
    const state = page.live.status?.sessionState ?? '';
    const may = page.live.role === 'control';
    setText(words, STATE_WORDS[state] ?? (state || '–'));
    element.dataset['state'] = state;
    pause.hidden = !may || (state !== 'running' && state !== 'paused');
    reset.hidden = !may || state === '' || state === 'stored' || state === 'draining';
    const paused = state === 'paused';
    setIcon(pause, paused ? 'play' : 'pause', paused ? 'Go on mapping' : 'Pause mapping');
  };
  page.live.statusChanged.on(show);
  page.live.begun.on(show);
  show();
  return element;
}

export async function togglePause(page: Page): Promise<void> {
  await attempt(page, page.live.status?.sessionState === 'paused' ? page.backend.resume() : page.backend.pause());
}

async function askReset(page: Page): Promise<void> {
  const text = 'The map and the path so far are thrown away for everybody who looks at them. Export first what you want to keep.';
  if (await confirm('Begin a new map?', text, 'Begin anew')) await attempt(page, page.backend.reset());
}

function themeButton({ settings }: Page): HTMLButtonElement {
  const element = iconButton('auto', 'Theme', () => settings.set({ theme: THEMES[settings.get().theme][2] }));
  settings.watch(['theme'], ({ theme }) => setIcon(element, THEMES[theme][0], THEMES[theme][1]));
  return element;
}

function exportMenu(page: Page): HTMLElement {
  const list = h('ul', { class: 'menu-list' });
  const menu = h('details', { class: 'menu' }, h('summary', { class: 'icon-button', 'aria-label': 'Export', title: 'Export' }), list);
  menu.querySelector('summary')?.append(...iconButton('download', '', () => {}).childNodes);
  menu.addEventListener('toggle', () => {
    const links = EXPORTS.map(([format, title]) => {
      const url = page.backend.exportUrl(format);
      return h('li', {}, url ? h('a', { href: url, download: true, onclick: () => (menu.open = false) }, title) : h('span', {}, title));
    });
    list.replaceChildren(h('li', { class: 'menu-title' }, page.backend.exportUrl('png') ? 'Export the map as it is now' : 'Exports need a real server'), ...links);
  });
  document.addEventListener('pointerdown', (event) => {
    if (menu.open && !menu.contains(event.target as Node)) menu.open = false;
  });
  menu.addEventListener('keydown', (event) => {
    if (event.key === 'Escape') menu.open = false;
  });
  return menu;
}
