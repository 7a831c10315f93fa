// How the session is doing: state, rates, sizes, stage times, and warnings in words.

import { TrackingState } from '../gen/flogmap/v1/map_pb';
import { ImageStream, type PairSkew, type Status } from '../gen/flogmap/v1/stream_pb';
import type { Page } from '../page';
import type { Path } from '../path';
import { h, setText } from '../ui/dom';
import { icon } from '../ui/icons';
import { section } from '../ui/controls';
import { lightWarnings, speedWarnings } from '../warnings';

const SHOW_EVERY_MS = 250; // words that change faster cannot be read

export const TRACKING_WORDS: Record<TrackingState, string> = {
  [TrackingState.INITIALISING]: 'starting', [TrackingState.OK]: 'good', [TrackingState.WEAK]: 'weak', [TrackingState.LOST]: 'lost',
};

export function formatBytes(bytes: number): string {
  const units = ['B', 'KiB', 'MiB', 'GiB'];
  const power = bytes > 0 ? Math.min(3, Math.floor(Math.log2(bytes) / 10)) : 0;
  const value = bytes / 1024 ** power;
  return `${value >= 100 || power === 0 ? Math.round(value) : value.toFixed(1)} ${units[power]}`;
}

export function statusPanel(page: Page, charts: Node): HTMLElement {
  const warnings = h('ul', { class: 'warnings' });
  const facts = h('dl', { class: 'facts' });
  const stages = h('div', { class: 'stages' });
  let received = { bytes: 0, at: performance.now(), rate: 0 };
  const meter = pathMeter();
  let metres = 0;
  page.live.trajectoryChanged.on(({ from }) => (metres = meter(page.live.path, from)));
  let due = 0;
  const show = (): void => {
    const now = performance.now();
    if (now < due) return;
    due = now + SHOW_EVERY_MS;
    if (now - received.at > 900) {
      const bytes = page.connection.receivedBytes;
      received = { bytes, at: now, rate: ((bytes - received.bytes) * 1000) / (now - received.at) };
    }
    setFacts(facts, factsOf(page, received.rate, metres));
    showStages(stages, page.live.status);
    const words = warningsOf(page);
    warnings.replaceChildren(...words.map((text) => h('li', {}, icon('warning'), h('span', {}, text))));
    warnings.hidden = words.length === 0;
  };
  page.live.statusChanged.on(show);
  page.live.poseChanged.on(show);
  setInterval(show, 1000);
  show();
  return section('Status', 'status', warnings, facts, stages, charts);
}

/** The server's warnings, and why tracking is not good. */
export function warningsOf(page: Page): string[] {
  const { status, pose, lights, path } = page.live;
  const tracking = pose && (pose.state === TrackingState.LOST || pose.state === TrackingState.WEAK)
    ? [`Tracking ${TRACKING_WORDS[pose.state]}${pose.reason ? `: ${pose.reason}` : ''}.${pose.state === TrackingState.LOST ? ' Point the camera back at something it has seen.' : ''}`]
    : [];
  const running = status?.sessionState === 'running';
  const own = running ? [...lightWarnings(lights.get(ImageStream.LEFT), lights.get(ImageStream.RIGHT)), ...speedWarnings(path)] : [];
  return [...tracking, ...own, ...(status?.warnings ?? [])];
}

/** Length of a path that grows: only what came since the last look is added. */
export function pathMeter(): (path: Path, from: number) => number {
  let [metres, measured] = [0, 0];
  return (path, from) => {
    if (from < measured) [metres, measured] = [0, 0];
    for (let i = Math.max(1, measured); i < path.length; ++i) {
      if (path.hasPose(i - 1) && path.hasPose(i)) metres += Math.hypot(path.place(i, 0) - path.place(i - 1, 0), path.place(i, 1) - path.place(i - 1, 1));
    }
    measured = path.length;
    return metres;
  };
}

function factsOf(page: Page, bytesPerSecond: number, metres: number): readonly (readonly [string, string])[] {
  const { status, pose, tiles, path, rev } = page.live;
  const alignment = status?.alignment ? [['Heights from', status.alignment] as const] : [];
  return [
    ['Tracking', pose ? `${TRACKING_WORDS[pose.state]}, ${pose.inliers} inliers` : '–'],
    ['Frames', status ? `${status.framesPerS.toFixed(1)} /s, ${status.frames} in all` : '–'],
    ['Mapped views', status ? `${status.mappedViews}${status.loops > 0n ? `, ${status.loops} loops` : ''}` : '–'],
    ['Lost, dropped', status ? `${status.lost}, ${status.droppedFrames + status.skippedFrames}` : '–'],
    ['Path', `${metres.toFixed(1)} m, ${path.length} poses`],
    ['Map on server', status ? `${status.tiles} tiles, ${formatBytes(Number(status.mapBytes))}` : '–'],
    ['Map in page', `${tiles.count} tiles, ${formatBytes(tiles.bytes)}`],
    ['Received', `${formatBytes(bytesPerSecond)}/s, revision ${rev}`],
    ...alignment,
    ...skewFacts(status?.pairSkew),
    ...(status?.processorCelsius === undefined ? [] : [['Processor', `${Math.round(status.processorCelsius)} °C`] as const]),
    ['Viewers', status ? String(status.viewers) : '–'],
    ['Server', page.live.serverVersion || '–'],
  ];
}

/** Shown where the cameras are timed one by one and really differ. */
function skewFacts(skew: PairSkew | undefined): readonly (readonly [string, string])[] {
  if (!skew || skew.largestMs === 0) return [];
  const dropped = skew.droppedPairs > 0n ? `, ${skew.droppedPairs} dropped above ${skew.allowedMs} ms` : '';
  return [['Left to right', `${skew.meanMs.toFixed(2)} ms, at most ${skew.largestMs.toFixed(1)}${dropped}`]];
}

function setFacts(list: HTMLElement, facts: readonly (readonly [string, string])[]): void {
  while (list.children.length > 2 * facts.length) list.lastElementChild?.remove();
  facts.forEach(([name, value], i) => {
    if (!list.children[2 * i]) list.append(h('dt', {}), h('dd', {}));
    setText(list.children[2 * i] as Element, name);
    setText(list.children[2 * i + 1] as Element, value);
  });
}

function showStages(element: HTMLElement, status: Status | null): void {
  const stages = status?.stages ?? [];
  element.hidden = stages.length === 0;
  const longest = Math.max(1, ...stages.map((stage) => stage.p95Ms));
  element.replaceChildren(...stages.map((stage) => {
    const fill = h('span', { class: 'bar-fill' });
    fill.style.width = `${(100 * stage.medianMs) / longest}%`;
    return h('div', { class: 'bar stage', title: `95 % below ${stage.p95Ms.toFixed(1)} ms` }, h('b', {}, stage.stage), h('span', { class: 'bar-track' }, fill), h('span', { class: 'bar-value' }, `${stage.medianMs.toFixed(1)} ms`));
  }));
}
