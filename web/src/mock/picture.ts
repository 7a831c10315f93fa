// What the simulated camera sees: walls and furniture column by column, and the disparity that goes with it.

import { cssColour, rampColour } from '../palette';
import { hitsAlong, ROOM, type Hit, type Stand } from './room';

export const WIDTH = 376;
export const HEIGHT = 240;
export const FOCAL = 210; // px
export const BASELINE = 0.11; // m
export const MAX_DISPARITY = 32; // px

export const columnAzimuth = (stand: Stand, column: number): number => stand.heading - Math.atan((column + 0.5 - WIDTH / 2) / FOCAL);

/** Draws the left picture and the disparity of a stand onto two canvases of WIDTH x HEIGHT. */
export function drawPictures(stand: Stand, left: OffscreenCanvasRenderingContext2D, disparity: OffscreenCanvasRenderingContext2D): void {
  drawFloor(stand, left, disparity);
  for (let column = 0; column < WIDTH; column += 2) {
    const azimuth = columnAzimuth(stand, column);
    const squint = Math.cos(azimuth - stand.heading); // depth = distance * squint
    for (const hit of hitsAlong(ROOM, stand.x, stand.y, azimuth).reverse()) drawStrip(stand, hit, column, azimuth, squint, left, disparity);
  }
}

const rowOf = (stand: Stand, z: number, depth: number): number => HEIGHT / 2 - (FOCAL * (z - stand.z)) / depth;

function drawFloor(stand: Stand, left: OffscreenCanvasRenderingContext2D, disparity: OffscreenCanvasRenderingContext2D): void {
  for (let row = 0; row < HEIGHT; row += 2) {
    const below = row >= HEIGHT / 2;
    const height = below ? stand.z : 2.4 - stand.z;
    const depth = (FOCAL * height) / Math.max(1, Math.abs(row - HEIGHT / 2));
    const light = below ? 46 - Math.min(26, depth * 4) : 78 - Math.min(40, depth * 6);
    left.fillStyle = `hsl(${below ? 28 : 40} ${below ? 22 : 10}% ${light}%)`;
    left.fillRect(0, row, WIDTH, 2);
    disparity.fillStyle = below ? disparityColour(depth) : '#000';
    disparity.fillRect(0, row, WIDTH, 2);
  }
}

function drawStrip(
  stand: Stand, hit: Hit, column: number, azimuth: number, squint: number,
  left: OffscreenCanvasRenderingContext2D, disparity: OffscreenCanvasRenderingContext2D,
): void {
  const depth = hit.near * squint;
  const top = rowOf(stand, hit.box.z1, depth);
  const bottom = rowOf(stand, hit.box.z0, depth);
  const backTop = rowOf(stand, hit.box.z1, hit.far * squint);
  const x = stand.x + hit.near * Math.cos(azimuth);
  const y = stand.y + hit.near * Math.sin(azimuth);
  const shade = (hit.alongX ? 0.86 : 1) * Math.max(0.35, 1 - depth / 9);
  const grain = 5 * Math.sin(37 * (hit.alongX ? x : y)) * Math.sin(11 * (hit.alongX ? x : y) + 1);
  if (backTop < top) paint(left, column, backTop, top, `hsl(${hit.box.tone} 26% ${(70 + grain * 0.4) * shade}%)`);
  paint(left, column, top, bottom, `hsl(${hit.box.tone} 24% ${(58 + grain) * shade}%)`);
  if (hit.box.z1 > 2.2) paint(left, column, rowOf(stand, 0.09, depth), bottom, `hsl(30 12% ${34 * shade}%)`); // skirting board
  if (backTop < top) paint(disparity, column, backTop, top, disparityColour(0.5 * (hit.near + hit.far) * squint));
  paint(disparity, column, top, bottom, disparityColour(depth));
}

function paint(context: OffscreenCanvasRenderingContext2D, column: number, top: number, bottom: number, colour: string): void {
  context.fillStyle = colour;
  context.fillRect(column, top, 2, Math.max(0, bottom - top));
}

const disparityColour = (depth: number): string => cssColour(rampColour('viridis', (FOCAL * BASELINE) / depth / MAX_DISPARITY));

/** Corners of the furniture that the camera sees: pixel positions, and where they were a little earlier. */
export function visibleCorners(stand: Stand, before: Stand): { current: number[]; key: number[] } {
  const current: number[] = [];
  const key: number[] = [];
  for (const b of ROOM)
    for (const [x, y] of [[b.x0, b.y0], [b.x1, b.y0], [b.x0, b.y1], [b.x1, b.y1]] as const)
      for (const z of [b.z0 + 0.02, (b.z0 + b.z1) / 2, b.z1]) {
        const now = project(stand, x, y, z);
        const then = project(before, x, y, z);
        const azimuth = Math.atan2(y - stand.y, x - stand.x);
        const nearest = hitsAlong(ROOM, stand.x, stand.y, azimuth).find((hit) => hit.box.z0 <= z && z <= hit.box.z1);
        if (!now || !then || (nearest && nearest.near < Math.hypot(x - stand.x, y - stand.y) - 0.12)) continue;
        current.push(...now);
        key.push(...then);
      }
  return { current, key };
}

function project(stand: Stand, x: number, y: number, z: number): [number, number] | null {
  const c = Math.cos(stand.heading);
  const s = Math.sin(stand.heading);
  const depth = c * (x - stand.x) + s * (y - stand.y);
  if (depth < 0.3) return null;
  const u = WIDTH / 2 + (FOCAL * (s * (x - stand.x) - c * (y - stand.y))) / depth;
  const v = rowOf(stand, z, depth);
  return u > 2 && u < WIDTH - 2 && v > 2 && v < HEIGHT - 2 ? [u, v] : null;
}
