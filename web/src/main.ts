// Composition only: makes the parts and connects them.

import './ui/style.css';
import { restBackend } from './backend';
import { Connection, SUBPROTOCOL, type Socket } from './connection';
import type { DecodeAnswer, DecodeRequest } from './decode_worker';
import { ImageStream, Planes } from './gen/flogmap/v1/stream_pb';
import { listenToKeys } from './keyboard';
import { LiveMap } from './live_map';
import { layout } from './layout';
import type { Focus, Page } from './page';
import { linkHash, readHash } from './permalink';
import { Gestures } from './scene/gestures';
import { MapView } from './scene/map_view';
import { Walkthrough } from './scene/walkthrough';
import { keptSettings } from './settings';
import { Store } from './signal';
import { installTestHook } from './test_hook';
import { keyText, TileStore } from './tile_store';
import { levelFor, visibleRect } from './viewport';

const POSE_HZ = 15;
const SMOOTH_MS = 40; // for a picture
const REST_PER_LATE = 3; // so much longer than drawing is behind, taking in tiles has to wait
const LOOK_EVERY_MS = 300; // how often the server hears where we look

const query = new URLSearchParams(location.search);
const linked = readHash(location.hash);
const settings = keptSettings(query.has('fresh') ? null : localStorage);
settings.set(linked.settings);
const focus = new Store<Focus>({ tool: 'inspect', hover: undefined, cell: linked.cell, pins: [], sheet: 'none', theme: 'dark', heldSince: 0, walking: false, floor: undefined });
const phone = matchMedia('(max-width: 760px)').matches;
const budget = Number(query.get('budget') ?? (phone ? 96 : 256)) * 2 ** 20; // bytes of tiles held
const live = new LiveMap(new TileStore(budget));

const apiBase = new URL('api/v1/', document.baseURI);
const mock = query.has('mock') ? await import('./mock/mock_server').then(({ MockServer }) => new MockServer()) : null;
const backend = mock ? (await import('./mock/mock_backend')).mockBackend(mock) : restBackend(apiBase.href);

const decoder = new Worker(new URL('./decode_worker.ts', import.meta.url), { type: 'module' });
const connection = new Connection({
  openSocket: () => mock?.openSocket() ?? openWebSocket(),
  decode: (bytes, number) => decoder.postMessage({ connection: number, bytes } satisfies DecodeRequest, [bytes]),
  clock: { now: () => Date.now(), after: (ms, action) => { const id = setTimeout(action, ms); return () => clearTimeout(id); } },
  trajectoryLength: () => live.path.length,
  restMs: () => (view.picture.pacer.lateMs > SMOOTH_MS ? REST_PER_LATE * view.picture.pacer.lateMs : 0),
});
decoder.onmessage = ({ data }: MessageEvent<DecodeAnswer>) => {
  if (data.event) connection.received(data.connection, data.size, data.event);
  else connection.unreadable(data.connection, data.error ?? 'unknown');
};
connection.events.on((event) => {
  const still = event.kind === 'image' && focus.get().floor !== undefined; // points are being picked in it
  if (!still) live.take(event);
});

function openWebSocket(): Socket {
  const url = new URL('stream', apiBase);
  url.protocol = url.protocol.replace('http', 'ws');
  return new WebSocket(url, SUBPROTOCOL);
}

const holder = document.createElement('main');
const view = new MapView(holder, live, settings);
const walk = new Walkthrough(live, backend, budget / 2, () => view.requestDraw());
const page: Page = { live, settings, focus, view, walk, connection, backend };

function share(): void {
  const hash = linkHash({ epoch: live.info?.epoch ?? '', rev: live.rev, view: view.viewport, cell: focus.get().cell, pitch: view.eye.pitch, settings: settings.get(), layers: live.info?.layers.map(({ id }) => id) ?? [] });
  history.replaceState(null, '', location.pathname + location.search + hash);
  navigator.clipboard.writeText(location.href).then(
    () => live.noticed.emit({ tone: 'info', text: 'Link copied: it opens this view, these layers and this cell.' }),
    () => live.noticed.emit({ tone: 'info', text: 'The address of this page now opens this view.' }),
  );
}

const overlay = layout(page, holder, share);
new Gestures(view, {
  clicked: (world) => (focus.get().tool === 'inspect' ? focus.set({ cell: world, sheet: phone ? 'cell' : focus.get().sheet }) : overlay.click(world)),
  hovered: (hover) => focus.set({ hover }),
});
listenToKeys(page, { share, back: overlay.back });

const systemDark = matchMedia('(prefers-color-scheme: dark)');
function applyTheme(): void {
  const { theme: choice } = settings.get();
  const theme = choice === 'auto' ? (systemDark.matches ? 'dark' : 'light') : choice;
  document.documentElement.dataset['theme'] = theme;
  focus.set({ theme });
  view.setTheme(theme);
}
systemDark.addEventListener('change', applyTheme);
settings.watch(['theme'], applyTheme);

settings.watch(['imageFps', 'imageWidth', 'showFeatures', 'showRight'], ({ imageFps, imageWidth, showFeatures, showRight }) => {
  const streams = [ImageStream.LEFT, ImageStream.DISPARITY, ...(showRight ? [ImageStream.RIGHT] : [])];
  const images = imageFps > 0 ? streams.map((stream) => ({ stream, maxFps: imageFps, maxWidth: imageWidth })) : [];
  connection.subscribe({ planes: Planes.EVIDENCE, images, poseHz: POSE_HZ, features: showFeatures && images.length > 0 });
});

let looking = 0;
view.moved.on(() => {
  if (looking || !live.info) return;
  looking = window.setTimeout(() => {
    looking = 0;
    const { xMin, yMin, xMax, yMax } = visibleRect(view.viewport);
    connection.lookAt({ bounds: { xMin, yMin, xMax, yMax }, level: levelFor(view.viewport, live.info?.cellSize ?? 1, live.info?.levels ?? 1) });
  }, LOOK_EVERY_MS);
});

focus.watch(['heldSince'], ({ heldSince }) => view.hold(heldSince > 0));

live.tilesChanged.on(() => {
  const evicted = live.tiles.evict(new Set(view.tiles.shown.map(keyText)));
  view.release(evicted);
  connection.forget(evicted);
});

live.begun.on((info) => {
  if (linked.epoch && linked.epoch !== info.epoch) live.noticed.emit({ tone: 'warning', text: 'The link was made on another map: this one has begun anew since.' });
  else if (linked.rev !== undefined && linked.rev < info.rev) live.noticed.emit({ tone: 'info', text: `The map has moved on by ${info.rev - linked.rev} changes since the link was made.` });
});
if (linked.pitch !== undefined) view.eye.tiltTo(linked.pitch);
if (linked.view) view.restore(linked.view.x, linked.view.y, linked.view.scale, linked.view.turn);

installTestHook(page);
if (mock) Object.assign(window, { __mock: mock });
connection.start();
