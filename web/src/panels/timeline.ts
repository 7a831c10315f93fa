// Replay of a recording: play, step, rate, and where in it we are. Hidden for live cameras.

import { attempt, type Page } from '../page';
import { h, setText } from '../ui/dom';
import { iconButton, setIcon } from '../ui/controls';

const RATES = [0.25, 0.5, 1, 2, 4, 0] as const; // 0: as fast as possible

export function formatTime(seconds: number): string {
  const whole = Math.max(0, Math.floor(seconds));
  return `${Math.floor(whole / 60)}:${String(whole % 60).padStart(2, '0')}`;
}

export function timeline(page: Page): HTMLElement {
  const { live, backend } = page;
  const hasEnded = (): boolean => live.status?.sessionState === 'finished';
  const play = iconButton('pause', 'Pause the replay', () => void attempt(page, backend.changePlayback(hasEnded() ? { position_s: 0 } : { paused: !live.playback?.paused })));
  const step = iconButton('step', 'One frame further', () => void attempt(page, backend.step()));
  const time = h('span', { class: 'timeline-time' });
  const scrub = h('input', { type: 'range', min: 0, max: 1, step: 0.01, 'aria-label': 'Position in the recording' });
  const rate = h('select', { 'aria-label': 'Speed of the replay', onchange: () => void attempt(page, backend.changePlayback({ rate: Number(rate.value) })) },
    ...RATES.map((value) => h('option', { value }, value === 0 ? 'max' : `${value} ×`)));
  let dragging = false;
  scrub.addEventListener('input', () => {
    dragging = true;
    setText(time, `${formatTime(Number(scrub.value))} / ${formatTime(live.playback?.durationS ?? 0)}`);
  });
  scrub.addEventListener('change', () => {
    dragging = false;
    void attempt(page, backend.changePlayback({ position_s: Number(scrub.value) }));
  });
  const element = h('div', { class: 'timeline', role: 'group', 'aria-label': 'Replay', hidden: true }, play, step, scrub, time, rate);
  const showButton = (): void => {
    const paused = live.playback?.paused ?? false;
    const words = hasEnded() ? 'Play again from the start' : paused ? 'Go on with the replay' : 'Pause the replay';
    setIcon(play, paused || hasEnded() ? 'play' : 'pause', words);
    step.disabled = !paused;
  };
  live.statusChanged.on(showButton);
  live.playbackChanged.on((playback) => {
    element.hidden = !playback.seekable;
    document.body.classList.toggle('has-timeline', playback.seekable);
    showButton();
    rate.value = String(RATES.find((value) => value === playback.rate) ?? 1);
    if (dragging) return;
    scrub.max = String(playback.durationS);
    scrub.value = String(playback.positionS);
    scrub.style.setProperty('--filled', `${(100 * playback.positionS) / Math.max(1e-3, playback.durationS)}%`);
    setText(time, `${formatTime(playback.positionS)} / ${formatTime(playback.durationS)}`);
  });
  return element;
}
