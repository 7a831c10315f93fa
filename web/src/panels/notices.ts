// Short words that come and go, and what to do while there is no map yet.

import type { Notice } from '../live_map';
import type { Page } from '../page';
import { h, setText } from '../ui/dom';
import { icon } from '../ui/icons';

const SHOWN_MS = { info: 6000, warning: 12000 };

export function notices(page: Page): HTMLElement {
  const element = h('div', { class: 'notices', role: 'status', 'aria-live': 'polite' });
  page.live.noticed.on(({ tone, text }: Notice) => {
    if (element.lastElementChild?.textContent === text) return; // said already
    const note = h('div', { class: 'notice', 'data-tone': tone }, tone === 'warning' && icon('warning'), h('span', {}, text));
    element.append(note);
    while (element.children.length > 3) element.firstElementChild?.remove();
    setTimeout(() => note.remove(), SHOWN_MS[tone]);
  });
  return element;
}

export function emptyState(page: Page): HTMLElement {
  const title = h('h2', {});
  const words = h('p', {});
  const element = h('div', { class: 'empty-state' }, h('div', { class: 'empty-mark', 'aria-hidden': 'true' }), title, words);
  const show = (): void => {
    element.hidden = page.live.tiles.count > 0;
    const [head, text] = emptyWords(page);
    setText(title, head);
    setText(words, text);
  };
  page.connection.stateChanged.on(show);
  page.live.statusChanged.on(show);
  page.live.tilesChanged.on(show);
  page.live.begun.on(show);
  show();
  return element;
}

function emptyWords({ connection, live }: Page): readonly [string, string] {
  const { phase } = connection.state;
  if (phase === 'connecting') return ['Connecting to the map', 'Waiting for the server’s first word.'];
  if (phase === 'offline') return ['No connection', 'Is “flogmap serve” running? The page keeps trying by itself.'];
  if (phase === 'resuming') return ['Loading the map', 'Tiles nearest to the middle come first.'];
  switch (live.status?.sessionState) {
    case 'paused': return ['Paused before the first view', 'Press play at the top to go on.'];
    case 'finished': return ['Finished without a map', 'No frame of the recording could be mapped. The status panel may say why.'];
    case 'failed': return ['The source has failed', live.status.warnings[0] ?? 'The server’s log says why.'];
    default: return ['Waiting for the first view', 'The map begins as soon as the camera has moved and seen something in stereo.'];
  }
}
