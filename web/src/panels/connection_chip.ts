// Whether what is on screen is true now. A stale map is never shown without saying so.

import type { ConnectionState } from '../connection';
import type { Page } from '../page';
import { h, setText } from '../ui/dom';
import { button } from '../ui/controls';

export function timeOfDay(ms: number): string {
  return new Date(ms).toLocaleTimeString([], { hour: '2-digit', minute: '2-digit', second: '2-digit', hour12: false });
}

export function percent(done: number, total: number): number {
  return total > 0 ? Math.min(99, Math.floor((100 * done) / total)) : 0;
}

/** The chip's words and the kind of colour they get. */
export function describe(state: ConnectionState): { readonly text: string; readonly tone: 'good' | 'wait' | 'bad' } {
  switch (state.phase) {
    case 'connecting': return { text: 'Connecting', tone: 'wait' };
    case 'resuming': return { text: `Resuming ${percent(state.done, state.total)} %`, tone: 'wait' };
    case 'live': return { text: 'Live', tone: 'good' };
    case 'lagging': return { text: `Lagging ${state.lagMs < 10000 ? `${Math.round(state.lagMs / 10) * 10} ms` : `${Math.round(state.lagMs / 1000)} s`}`, tone: 'wait' };
    case 'offline': return { text: `Offline since ${timeOfDay(state.since)}`, tone: 'bad' };
  }
}

export function connectionChip(page: Page): HTMLElement {
  const text = h('span', {});
  const chip = h('div', { class: 'chip', role: 'status', 'aria-live': 'polite' }, h('span', { class: 'chip-dot', 'aria-hidden': 'true' }), text);
  const show = (state: ConnectionState): void => {
    const { heldSince } = page.focus.get();
    const held = heldSince > 0 && (state.phase === 'live' || state.phase === 'lagging');
    const { text: words, tone } = held ? { text: `Held at ${timeOfDay(heldSince)}`, tone: 'held' as const } : describe(state);
    setText(text, words);
    chip.dataset['tone'] = tone;
    chip.title = state.phase === 'live' ? `Round trip ${Math.round(state.lagMs)} ms, revision ${page.live.rev}` : words;
  };
  page.connection.stateChanged.on(show);
  page.focus.watch(['heldSince'], () => show(page.connection.state));
  return chip;
}

/** A bar over the map while it is not live, with the way out. */
export function staleBanner(page: Page): HTMLElement {
  const text = h('span', {});
  const banner = h('div', { class: 'banner', role: 'alert', hidden: true }, text, button('Reconnect now', () => page.connection.start()));
  const show = (): void => {
    const { state } = page.connection;
    banner.hidden = state.phase !== 'offline';
    page.view.canvas.classList.toggle('stale', state.phase === 'offline');
    if (state.phase !== 'offline') return;
    const wait = Math.ceil((state.retryAt - Date.now()) / 1000);
    const next = wait > 0 ? `next try in ${wait} s` : 'trying now';
    const what = page.live.tiles.count > 0 ? `This is the map as of ${timeOfDay(state.since)}` : 'No map yet';
    setText(text, `${what}: ${state.reason}, ${next}.`);
  };
  page.connection.stateChanged.on(show);
  setInterval(show, 1000);
  return banner;
}
