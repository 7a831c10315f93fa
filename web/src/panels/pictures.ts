// What the camera sees: left picture with the tracked corners, disparity with its scale, and how old they are.

import type { ImageEvent } from '../decode';
import { placeOnRamp, RAMP_GRADIENT } from '../disparity_ramp';
import { ImageStream } from '../gen/flogmap/v1/stream_pb';
import type { Page } from '../page';
import { h, setText } from '../ui/dom';
import { lightOf } from '../warnings';
import { section, segmented, slider, toggle } from '../ui/controls';

const INLIER = '#3ddc97';
const OUTLIER = '#ff5d6c';
const ROWS = 16;
const ROW_COLOUR = 'rgb(255 210 63 / 0.75)';
const STALE_AFTER_MS = 3000;
const LIGHT_EVERY_MS = 1000;

export function picturesPanel(page: Page): HTMLElement {
  const left = picture(page, ImageStream.LEFT, 'Left', 'No picture yet. It comes with the first frame.');
  const right = picture(page, ImageStream.RIGHT, 'Right', 'No picture yet.');
  const disparity = picture(page, ImageStream.DISPARITY, 'Disparity', 'No disparity yet.');
  const scale = disparityScale(page);
  const features = toggle('Tracked corners', (showFeatures) => page.settings.set({ showFeatures }), 'Corners that agree on the motion, and those that do not');
  const rate = slider('Pictures a second', { min: 0, max: 15, step: 1 }, (value) => (value === 0 ? 'off' : `${value}`), (imageFps) => page.settings.set({ imageFps }));
  const both = toggle('Right picture', (showRight) => page.settings.set({ showRight }));
  const rows = toggle('Rows of the pair', (showRows) => page.settings.set({ showRows }), 'Lines at equal heights in both pictures: what one line goes through on the left it must go through on the right');
  const size = segmented<string>('Width of the pictures', [['240', 'Small'], ['480', 'Middle'], ['960', 'Large']], (value) => page.settings.set({ imageWidth: Number(value) }));
  page.settings.watch(['showFeatures', 'imageFps', 'showRight', 'showRows', 'imageWidth'], (now) => {
    rows.show(now.showRows);
    both.show(now.showRight);
    right.element.hidden = !now.showRight;
    size.show(String(now.imageWidth));
    features.show(now.showFeatures);
    rate.show(now.imageFps);
    left.redraw();
    right.redraw();
  });
  page.live.featuresChanged.on(() => left.redraw());
  return section('Camera', 'camera', left.element, right.element, disparity.element, scale, features.element, both.element, rows.element, rate.element, size.element);
}

interface Picture {
  readonly element: HTMLElement;
  redraw(): void;
}

function picture(page: Page, stream: ImageStream, title: string, emptyText: string): Picture {
  const canvas = h('canvas', { width: 4, height: 3, role: 'img', 'aria-label': `${title} picture of the camera` });
  const age = h('span', { class: 'picture-age' });
  const readout = h('span', { class: 'picture-readout' });
  const empty = h('p', { class: 'picture-empty' }, emptyText);
  const element = h('figure', { class: 'picture' }, canvas, empty, h('figcaption', {}, h('span', {}, title), readout, age));
  let bitmap: ImageBitmap | null = null;
  const redraw = (): void => {
    if (bitmap) paint(page, canvas, bitmap, stream);
  };
  page.live.imageChanged.on((changed) => {
    const image = changed === stream ? page.live.images.get(stream) : undefined;
    if (!image) return;
    void createImageBitmap(new Blob([image.data], { type: image.mediaType })).then((next) => {
      bitmap?.close();
      bitmap = next;
      empty.hidden = true;
      redraw();
      if (stream !== ImageStream.DISPARITY) measureLight(page, stream, next);
    }, () => setText(age, 'unreadable picture'));
  });
  if (stream === ImageStream.LEFT) pickFloor(page, canvas, redraw);
  if (stream === ImageStream.DISPARITY) depthUnderCursor(page, canvas, readout);
  setInterval(() => showAge(page, stream, age), 500);
  return { element, redraw };
}

/** While the floor is being picked, clicks in the left picture are its points. */
function pickFloor(page: Page, canvas: HTMLCanvasElement, redraw: () => void): void {
  canvas.addEventListener('click', (event) => {
    const { floor } = page.focus.get();
    if (!floor || floor.length >= 3) return;
    const box = canvas.getBoundingClientRect();
    page.focus.set({ floor: [...floor, { x: (event.clientX - box.left) / box.width, y: (event.clientY - box.top) / box.height }] });
  });
  page.focus.watch(['floor'], ({ floor }) => {
    canvas.classList.toggle('picking', floor !== undefined);
    redraw();
  });
}

function paintFloor(page: Page, context: CanvasRenderingContext2D): void {
  const { floor } = page.focus.get();
  if (!floor?.length) return;
  const { width, height } = context.canvas;
  context.strokeStyle = context.fillStyle = '#ffd23f';
  context.lineWidth = Math.max(1.5, width / 240);
  context.beginPath();
  for (const { x, y } of floor) context.lineTo(x * width, y * height);
  context.stroke();
  for (const { x, y } of floor) context.fillRect(x * width - width / 100, y * height - width / 100, width / 50, width / 50);
}

const lightCanvas = h('canvas', { width: 32, height: 24 });
const lookedAt = new Map<ImageStream, number>();

function measureLight(page: Page, stream: ImageStream, bitmap: ImageBitmap): void {
  const now = performance.now();
  if (now - (lookedAt.get(stream) ?? -LIGHT_EVERY_MS) < LIGHT_EVERY_MS) return;
  lookedAt.set(stream, now);
  const context = lightCanvas.getContext('2d', { willReadFrequently: true });
  context?.drawImage(bitmap, 0, 0, 32, 24);
  if (context) page.live.lights.set(stream, lightOf(context.getImageData(0, 0, 32, 24).data));
}

function showAge(page: Page, stream: ImageStream, age: HTMLElement): void {
  const image = page.live.images.get(stream);
  if (!image) return;
  const ms = performance.now() - image.receivedAt;
  age.classList.toggle('old', ms > STALE_AFTER_MS);
  setText(age, ms > STALE_AFTER_MS ? `${Math.round(ms / 1000)} s old` : `t = ${(Number((image.timeNs - (page.live.path.at(0)?.timeNs ?? image.timeNs)) / 1000000n) / 1000).toFixed(1)} s`);
}

function paint(page: Page, canvas: HTMLCanvasElement, bitmap: ImageBitmap, stream: ImageStream): void {
  if (canvas.width !== bitmap.width || canvas.height !== bitmap.height) Object.assign(canvas, { width: bitmap.width, height: bitmap.height });
  const context = canvas.getContext('2d', { willReadFrequently: true }); // in memory: the depth under the cursor is read from it
  if (!context) return;
  context.drawImage(bitmap, 0, 0);
  const image = page.live.images.get(stream);
  if (stream === ImageStream.LEFT && page.settings.get().showFeatures && image) paintFeatures(page, context, image);
  if (stream !== ImageStream.DISPARITY && page.settings.get().showRows) paintRows(context);
  if (stream === ImageStream.LEFT) paintFloor(page, context);
}

/** The pair is rectified: a point of the scene lies in the same row of both pictures. */
function paintRows(context: CanvasRenderingContext2D): void {
  const { width, height } = context.canvas;
  context.fillStyle = ROW_COLOUR;
  for (let row = 1; row < ROWS; ++row) context.fillRect(0, Math.round((row * height) / ROWS), width, Math.max(1, Math.round(height / 400)));
}

function paintFeatures(page: Page, context: CanvasRenderingContext2D, image: ImageEvent): void {
  const { features } = page.live;
  if (!features) return;
  const factor = context.canvas.width / Math.max(1, image.fullSize[0]);
  context.lineWidth = Math.max(1, context.canvas.width / 400);
  features.inlier.forEach((inlier, i) => {
    const at = (list: readonly number[], k: number): number => (list[2 * i + k] ?? 0) * factor;
    const [x, y] = [at(features.currentPx, 0), at(features.currentPx, 1)];
    context.strokeStyle = inlier ? INLIER : OUTLIER;
    context.beginPath();
    context.moveTo(at(features.keyPx, 0), at(features.keyPx, 1));
    context.lineTo(x, y);
    context.stroke();
    context.strokeRect(x - 1.5 * context.lineWidth, y - 1.5 * context.lineWidth, 3 * context.lineWidth, 3 * context.lineWidth);
  });
}

/** Reads a pixel's disparity back from its colour's place on the scale, and says what depth it means. */
function depthUnderCursor(page: Page, canvas: HTMLCanvasElement, readout: HTMLElement): void {
  canvas.addEventListener('pointermove', (event) => {
    const box = canvas.getBoundingClientRect();
    const x = Math.floor(((event.clientX - box.left) / box.width) * canvas.width);
    const y = Math.floor(((event.clientY - box.top) / box.height) * canvas.height);
    const image = page.live.images.get(ImageStream.DISPARITY);
    const pixel = canvas.getContext('2d', { willReadFrequently: true })?.getImageData(x, y, 1, 1).data;
    if (!pixel || !image || !page.live.camera) return;
    const place = placeOnRamp(pixel[0] ?? 0, pixel[1] ?? 0, pixel[2] ?? 0);
    const px = image.scale[0] + (place ?? 0) * (image.scale[1] - image.scale[0]);
    const depth = (page.live.camera.focalPx * page.live.camera.baselineM) / Math.max(px, 1e-3);
    setText(readout, place === undefined || px < 0.5 ? 'no match' : `≈ ${px.toFixed(1)} px, ${depth.toFixed(2)} m`);
  });
  canvas.addEventListener('pointerleave', () => setText(readout, ''));
}

function disparityScale(page: Page): HTMLElement {
  const band = h('div', { class: 'ramp' });
  band.style.background = RAMP_GRADIENT;
  const low = h('span', {});
  const high = h('span', {});
  const element = h('div', { class: 'disparity-scale', hidden: true }, band, h('div', { class: 'ramp-ends' }, low, high));
  page.live.imageChanged.on((stream) => {
    const image = stream === ImageStream.DISPARITY ? page.live.images.get(stream) : undefined;
    if (!image) return;
    element.hidden = false;
    const ft = (page.live.camera?.focalPx ?? 0) * (page.live.camera?.baselineM ?? 0);
    setText(low, `${image.scale[0].toFixed(0)} px, far`);
    setText(high, ft > 0 ? `${image.scale[1].toFixed(0)} px, ${(ft / Math.max(image.scale[1], 1e-3)).toFixed(2)} m` : `${image.scale[1].toFixed(0)} px`);
  });
  return element;
}
