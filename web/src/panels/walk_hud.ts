// The walkthrough's controls: keys, sticks and the bar below.

import { attempt, type Page } from '../page';
import { h, setText } from '../ui/dom';
import { button, iconButton, segmented, setIcon, toggle } from '../ui/controls';
import { look, STANDING, type Wish } from '../walk/walker';
import { formatBytes } from './status';
import { formatTime } from './timeline';

const LOOK_PER_PX = 0.0045;
const STICK_PX = 44; // from the middle to full speed

/** Where each key pushes. */
const KEYS: Readonly<Record<string, Partial<Wish>>> = {
  w: { ahead: 1 }, s: { ahead: -1 }, a: { aside: -1 }, d: { aside: 1 }, arrowup: { ahead: 1 }, arrowdown: { ahead: -1 },
  arrowleft: { turn: 1 }, arrowright: { turn: -1 }, q: { turn: 1 }, e: { turn: -1 }, r: { up: 1 }, f: { up: -1 }, pageup: { up: 1 }, pagedown: { up: -1 },
};

export function wishOf(held: ReadonlySet<string>): Wish {
  const wish = { ahead: 0, aside: 0, up: 0, turn: 0 };
  for (const key of held)
    for (const [way, amount] of Object.entries(KEYS[key] ?? {})) wish[way as keyof Wish] = Math.max(-1, Math.min(1, wish[way as keyof Wish] + amount));
  return wish;
}

export async function enterWalk(page: Page): Promise<void> {
  await attempt(page, page.walk.enter().then(() => {
    if (page.walk.state.views === 0) page.live.noticed.emit({ tone: 'info', text: 'No view has been mapped yet; the walkthrough fills as the camera moves.' });
    page.focus.set({ walking: true, tool: 'inspect', sheet: 'none' });
    page.view.canvas.focus();
  }));
}

export function leaveWalk(page: Page): void {
  page.walk.leave();
  page.focus.set({ walking: false });
  const [x, y] = page.walk.walker.position;
  page.view.moveTo({ ...page.view.viewport, x, y });
}

export const toggleWalk = (page: Page): void => {
  if (page.focus.get().walking) leaveWalk(page);
  else void enterWalk(page);
};

export function walkHud(page: Page): HTMLElement {
  const { walk, focus, view } = page;
  listenToWalkKeys(page);
  listenToLooks(page);
  const mode = segmented<'walk' | 'fly'>('Way of moving', [['fly', 'Fly'], ['walk', 'Walk']], (value) => {
    walk.flies = value === 'fly';
    showMode();
    view.requestDraw();
  });
  const walls = toggle('Stop at walls', (on) => (walk.solidWalls = on), 'A walker does not pass through what the map holds for occupied');
  const showMode = (): void => {
    mode.show(walk.flies ? 'fly' : 'walk');
    walls.show(walk.solidWalls);
    walls.element.hidden = walk.flies;
  };
  showMode();
  const ride = iconButton('play', 'Ride the recorded path', () => walk.toggleRide());
  const scrub = h('input', { type: 'range', min: 0, max: 1, step: 0.01, 'aria-label': 'Place on the recorded path', oninput: () => walk.rideTo(Number(scrub.value), false) });
  const time = h('span', { class: 'timeline-time' });
  const words = h('span', { class: 'walk-words', role: 'status' });
  const bar = h('div', { class: 'walk-bar', role: 'group', 'aria-label': 'Walkthrough' }, ride, scrub, time, mode.element, walls.element, words, button('Leave', () => leaveWalk(page), 'primary'));
  walk.changed.on(() => {
    const { views, shown, missing, bytes, rideS, rideOfS, riding } = walk.state;
    setIcon(ride, riding ? 'pause' : 'play', riding ? 'Stop the ride' : 'Ride the recorded path');
    scrub.max = String(rideOfS);
    scrub.value = String(rideS);
    scrub.style.setProperty('--filled', `${(100 * rideS) / Math.max(1e-3, rideOfS)}%`);
    setText(time, `${formatTime(rideS)} / ${formatTime(rideOfS)}`);
    setText(words, missing > 0 ? `Loading ${missing} of ${shown + missing} views` : `${shown} of ${views} views, ${formatBytes(bytes)}`);
  });
  const element = h('div', { class: 'walk', hidden: true }, h('p', { class: 'walk-hint' }, 'W A S D or arrows move, drag looks, R F up and down, Esc leaves'), stick(page), bar);
  focus.watch(['walking'], ({ walking }) => {
    element.hidden = !walking;
    document.body.classList.toggle('walking', walking);
    view.walk(walking ? walk : null);
  });
  return element;
}

function push(page: Page, wish: Wish): void {
  page.walk.wish = wish;
  page.view.requestDraw();
}

function listenToWalkKeys(page: Page): void {
  const held = new Set<string>();
  window.addEventListener('keydown', (event) => {
    const key = event.key.toLowerCase();
    if (!page.focus.get().walking || !(key in KEYS) || event.ctrlKey || event.metaKey || event.altKey) return;
    if ((event.target as HTMLElement).closest('input, select, textarea') && key.startsWith('arrow')) return;
    held.add(key);
    push(page, wishOf(held));
    event.preventDefault();
    event.stopImmediatePropagation(); // the map's own keys rest meanwhile
  }, { capture: true });
  const release = (key?: string): void => {
    if (key === undefined) held.clear();
    else held.delete(key.toLowerCase());
    if (page.focus.get().walking) push(page, wishOf(held));
  };
  window.addEventListener('keyup', (event) => release(event.key));
  window.addEventListener('blur', () => release());
  page.focus.watch(['walking'], () => held.clear());
}

/** Dragging on the picture turns the head. */
function listenToLooks({ walk, view, focus }: Page): void {
  const pointers = new Map<number, { x: number; y: number }>();
  const { canvas } = view;
  const only = (act: (event: PointerEvent) => void) => (event: PointerEvent): void => {
    if (!focus.get().walking) return;
    event.stopImmediatePropagation();
    act(event);
  };
  const on = (name: 'pointerdown' | 'pointermove' | 'pointerup' | 'pointercancel', act: (event: PointerEvent) => void): void => canvas.addEventListener(name, only(act), { capture: true });
  on('pointerdown', (event) => {
    canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
  });
  on('pointermove', (event) => {
    const before = pointers.get(event.pointerId);
    if (!before) return;
    pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    walk.walker = look(walk.walker, (event.clientX - before.x) * LOOK_PER_PX, (event.clientY - before.y) * LOOK_PER_PX);
    view.requestDraw();
  });
  for (const name of ['pointerup', 'pointercancel'] as const) on(name, (event) => pointers.delete(event.pointerId));
  canvas.addEventListener('wheel', (event) => {
    if (!focus.get().walking) return;
    event.preventDefault();
    event.stopImmediatePropagation();
  }, { capture: true, passive: false });
}

/** For thumbs: the further from the middle, the faster. */
function stick(page: Page): HTMLElement {
  const knob = h('span', { class: 'stick-knob' });
  const element = h('div', { class: 'stick', 'aria-hidden': 'true' }, knob);
  const move = (event: PointerEvent): void => {
    const box = element.getBoundingClientRect();
    const part = (value: number): number => Math.max(-1, Math.min(1, value / STICK_PX));
    const aside = part(event.clientX - box.left - box.width / 2);
    const ahead = part(box.top + box.height / 2 - event.clientY);
    knob.style.transform = `translate(${aside * STICK_PX * 0.6}px, ${-ahead * STICK_PX * 0.6}px)`;
    push(page, { ...STANDING, ahead, aside });
  };
  const rest = (): void => {
    knob.style.transform = '';
    push(page, STANDING);
  };
  element.addEventListener('pointerdown', (event) => {
    element.setPointerCapture(event.pointerId);
    move(event);
  });
  element.addEventListener('pointermove', (event) => {
    if (element.hasPointerCapture(event.pointerId)) move(event);
  });
  element.addEventListener('pointerup', rest);
  element.addEventListener('pointercancel', rest);
  return element;
}
