// The last two minutes as curves: frame rate, time of the stages, inliers, lag and data rate.

import uPlot from 'uplot';
import 'uplot/dist/uPlot.min.css';
import type { Page } from '../page';
import { h } from '../ui/dom';

const KEPT_S = 120;
const HEIGHT_PX = 92;

interface Chart {
  readonly title: string;
  readonly unit: string;
  readonly curves: readonly string[];
  sample(page: Page): (number | null)[];
  /** The last curve is a limit: dashed. */
  readonly limit?: boolean;
  /** There is nothing to show with this source. */
  absent?(page: Page): boolean;
}

const STAGES = ['rectify', 'disparity', 'odometry', 'map'] as const;
const CURVE_COLOURS = ['--curve-1', '--curve-2', '--curve-3', '--curve-4'] as const;

function charts(): readonly Chart[] {
  let bytes = 0;
  return [
    { title: 'Frames', unit: '/s', curves: ['frames'], sample: ({ live }) => [live.status?.framesPerS ?? null] },
    { title: 'Stages', unit: 'ms', curves: STAGES, sample: ({ live }) => STAGES.map((name) => live.status?.stages.find(({ stage }) => stage === name)?.medianMs ?? null) },
    { title: 'Inliers', unit: '', curves: ['inliers'], sample: ({ live }) => [live.pose ? live.pose.inliers : null] },
    {
      title: 'Left to right', unit: 'ms', curves: ['mean', 'largest', 'allowed'], limit: true,
      absent: ({ live }) => !live.status?.pairSkew,
      sample: ({ live: { status } }) => [status?.pairSkew?.meanMs ?? null, status?.pairSkew?.largestMs ?? null, status?.pairSkew?.allowedMs ?? null],
    },
    { title: 'Tiles', unit: '', curves: ['on server', 'in page'], sample: ({ live }) => [live.status ? Number(live.status.tiles) : null, live.tiles.count] },
    { title: 'Memory of the page', unit: 'MiB', curves: ['tiles', 'meshes'], sample: ({ live, walk }) => [live.tiles.bytes / 2 ** 20, walk.state.bytes / 2 ** 20] },
    { title: 'Round trip', unit: 'ms', curves: ['lag'], sample: ({ connection: { state } }) => [state.phase === 'live' || state.phase === 'lagging' ? state.lagMs : null] },
    {
      title: 'Received', unit: 'KiB/s', curves: ['data'],
      sample: ({ connection }) => {
        const rate = (connection.receivedBytes - bytes) / 1024;
        bytes = connection.receivedBytes;
        return [rate];
      },
    },
  ];
}

export function chartsPanel(page: Page): HTMLElement {
  const element = h('div', { class: 'charts' });
  const drawn = charts().map((chart) => curves(page, chart, element));
  setInterval(() => drawn.forEach((step) => step()), 1000);
  return element;
}

/** Adds a chart to `into`; returns what takes the next sample. */
function curves(page: Page, chart: Chart, into: HTMLElement): () => void {
  const value = h('span', {});
  const place = h('div', { class: 'chart' });
  const keys = chart.curves.length > 1 ? chart.curves.map((name, i) => h('span', { class: `curve-key curve-key-${i + 1}` }, name)) : [];
  const box = h('figure', { class: 'chart-box', 'aria-label': `${chart.title} of the last two minutes` },
    h('figcaption', {}, h('b', {}, chart.title), ...keys, value), place);
  into.append(box);
  const data: (number | null)[][] = [[], ...chart.curves.map(() => [] as (number | null)[])];
  let plot: uPlot | null = null;
  let look = '';
  return () => {
    box.hidden = chart.absent?.(page) ?? false;
    const sample = chart.sample(page);
    [Date.now() / 1000, ...sample].forEach((next, i) => data[i]?.push(next));
    for (const list of data) while (list.length > KEPT_S) list.shift();
    const last = sample.find((one) => one !== null);
    value.textContent = chart.curves.length === 1 && last !== undefined && last !== null ? `${last < 10 ? last.toFixed(1) : Math.round(last)} ${chart.unit}` : chart.unit;
    if (place.clientWidth === 0) return; // folded away: keep counting, draw nothing
    const now = `${page.focus.get().theme} ${place.clientWidth}`;
    if (now !== look) {
      plot?.destroy();
      plot = new uPlot(options(place, chart), data as uPlot.AlignedData, place);
      look = now;
    } else plot?.setData(data as uPlot.AlignedData);
  };
}

function options(place: HTMLElement, { curves: names, limit }: Chart): uPlot.Options {
  const style = getComputedStyle(place);
  const colour = (name: string): string => style.getPropertyValue(name).trim();
  const axis = { stroke: colour('--text-3'), font: `10px ${style.fontFamily}`, grid: { stroke: colour('--line'), width: 1 }, ticks: { show: false } };
  return {
    width: place.clientWidth, height: HEIGHT_PX, legend: { show: false }, cursor: { show: false }, padding: [6, 4, 7, 0],
    scales: { x: { time: false, range: () => [Date.now() / 1000 - KEPT_S, Date.now() / 1000] }, y: { range: (_, __, max) => [0, Math.max(1, (max ?? 1) * 1.15)] } },
    axes: [{ show: false }, { ...axis, size: 34 }],
    series: [{}, ...names.map((_, i) => ({ stroke: colour(CURVE_COLOURS[i] ?? '--curve-1'), width: 1.5, points: { show: false }, ...(limit && i === names.length - 1 ? { dash: [4, 3] } : {}) }))],
  };
}
