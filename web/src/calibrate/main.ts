// The page of `flogmap calibrate --serve`: both cameras, what to do with the board, and the verdict.
import '../ui/theme.css';
import '../ui/base.css';
import './calibrate.css';
import { h, setText } from '../ui/dom';
import { CameraView } from './camera_view';
import { headline, shareDone, verdictRows, type Sitting } from './sitting';

const EVERY_MS = 150;
const API = './api/v1/calibrate';

const views = [new CameraView('left'), new CameraView('right')] as const;
const advice = h('p', { class: 'advice', role: 'status', 'aria-live': 'polite' });
const done = h('progress', { max: 1, value: 0, 'aria-label': 'How much of what is wanted is there' });
const count = h('p', { class: 'count' });
const verdict = h('section', { class: 'verdict', 'aria-label': 'Verdict', hidden: true });
const calibrate = h('button', { type: 'button', class: 'primary', onclick: () => void send('solve') }, 'Calibrate');
const restart = h('button', { type: 'button', onclick: () => void send('restart') }, 'Start again');

document.body.replaceChildren(h('main', { class: 'calibration' },
  h('h1', {}, 'Calibration'), advice, done, count,
  h('div', { class: 'cameras' }, ...views.map((view) => view.element)),
  h('div', { class: 'actions' }, calibrate, restart), verdict));

async function send(what: 'solve' | 'restart'): Promise<void> {
  const response = await fetch(`${API}:${what}`, { method: 'POST' });
  if (!response.ok) setText(advice, ((await response.json()) as { detail?: string }).detail ?? 'The server refused.');
}

function showVerdict(sitting: Sitting): void {
  verdict.hidden = sitting.verdict === null;
  if (!sitting.verdict) return;
  verdict.dataset['grade'] = sitting.verdict.grade;
  verdict.replaceChildren(
    h('dl', {}, ...verdictRows(sitting.verdict).flatMap(([name, value]) => [h('dt', {}, name), h('dd', {}, value)])),
    h('ul', {}, ...sitting.verdict.advice.map((text) => h('li', {}, text))),
    h('p', {}, `Written to ${sitting.file}; use it with --calibration.`));
}

function show(sitting: Sitting): void {
  setText(advice, headline(sitting));
  advice.classList.toggle('good', sitting.enough || sitting.kept);
  done.value = sitting.phase === 'calibrating' ? sitting.progress : shareDone(sitting);
  setText(count, `${sitting.pairs} pairs kept`);
  calibrate.disabled = sitting.pairs < 3 || sitting.phase === 'calibrating';
  views[0].draw(sitting.left);
  views[1].draw(sitting.right);
  showVerdict(sitting);
}

let shownFrame = -1;
let shown = '';

async function look(): Promise<void> {
  try {
    const response = await fetch(API);
    if (response.status === 401) return setText(advice, 'Log in on the main page first.');
    if (!response.ok) return setText(advice, 'Nothing is being calibrated here.');
    const text = await response.text();
    const sitting = JSON.parse(text) as Sitting;
    const thereAreNew = sitting.frame > 0 && sitting.frame !== shownFrame; // before the first pair there is no picture
    if (thereAreNew) await Promise.all(views.map((view) => view.fetch()));
    if (text !== shown) show(sitting);
    shownFrame = sitting.frame;
    shown = text;
  } catch {
    setText(advice, 'The program has ended or cannot be reached.');
  }
}

async function loop(): Promise<void> {
  await look();
  setTimeout(() => void loop(), EVERY_MS);
}
void loop();
