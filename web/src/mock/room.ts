// The simulated flat that ?mock=1 walks through: boxes with heights, a closed path, and what a ray meets.

export interface Box {
  readonly x0: number;
  readonly y0: number;
  readonly x1: number;
  readonly y1: number;
  readonly z0: number;
  readonly z1: number;
  readonly tone: number; // hue of its surface, degrees
}

const wall = (x0: number, y0: number, x1: number, y1: number): Box => ({ x0, y0, x1, y1, z0: 0, z1: 2.4, tone: 38 });
const box = (x0: number, y0: number, x1: number, y1: number, z0: number, z1: number, tone: number): Box => ({ x0, y0, x1, y1, z0, z1, tone });

const table = (x: number, y: number, w: number, d: number, tone: number): Box[] => [
  box(x, y, x + w, y + d, 0.68, 0.74, tone),
  ...[[x, y], [x + w - 0.06, y], [x, y + d - 0.06], [x + w - 0.06, y + d - 0.06]].map(([lx = 0, ly = 0]) => box(lx, ly, lx + 0.06, ly + 0.06, 0, 0.68, tone)),
];

/** A flat of two rooms, 8.4 x 6 m, and a niche; metres, z up, floor at 0. */
export const ROOM: readonly Box[] = [
  wall(-0.15, -0.15, 8.55, 0), wall(-0.15, 6, 8.55, 6.15), wall(-0.15, 0, 0, 6), wall(8.4, 0, 8.55, 6),
  wall(4.9, 0, 5.02, 2.1), wall(4.9, 3.2, 5.02, 6), wall(2.1, 5.2, 2.22, 6),
  ...table(1.9, 2.6, 1.5, 0.85, 28),
  box(0.25, 0.35, 2.3, 1.2, 0, 0.45, 210), box(0.25, 0.2, 2.3, 0.38, 0, 0.85, 210), // sofa
  box(3.5, 5.62, 4.9, 6, 0, 2, 18), // shelf
  box(0.02, 3.2, 0.4, 4.6, 1.5, 2.1, 160), // hanging cupboard
  box(0.02, 3.0, 0.62, 4.8, 0, 0.86, 96), // counter below it
  box(4.1, 0.4, 4.55, 0.85, 0, 0.5, 130), // box
  ...table(6.2, 0.5, 1.6, 0.75, 330),
  box(6.9, 4.2, 8.4, 5.9, 0, 0.55, 265), // bed
  box(7.9, 2.3, 8.4, 3.3, 0, 1.9, 12), // wardrobe
  box(5.5, 5.3, 5.85, 5.65, 0, 1.2, 60), // plant
];

// The walk, as corners of a smooth closed line.
const WALK = [
  [1.2, 1.95], [2.6, 1.9], [3.9, 1.75], [4.3, 2.55], [5.4, 2.7], [6.6, 2.0], [7.3, 3.0], [6.3, 3.9], [5.7, 3.4],
  [4.6, 2.7], [4.2, 4.0], [3.6, 4.8], [2.6, 4.4], [1.3, 4.7], [1.1, 3.4],
] as const;

export interface Stand {
  readonly x: number;
  readonly y: number;
  readonly z: number;
  /** World direction of the optical axis, radians counter-clockwise from +x. */
  readonly heading: number;
}

/** Where the camera is after `seconds` of walking; one round takes `ROUND_S`. */
export const ROUND_S = 48;
export function standAt(seconds: number): Stand {
  const here = along(seconds);
  const next = along(seconds + 0.9);
  const sweep = 0.75 * Math.sin(seconds * 0.55);
  return { x: here[0], y: here[1], z: 1.1 + 0.015 * Math.sin(seconds * 7), heading: Math.atan2(next[1] - here[1], next[0] - here[0]) + sweep };
}

/** Catmull-Rom through the corners. */
function along(seconds: number): [number, number] {
  const at = (((seconds / ROUND_S) % 1) + 1) % 1 * WALK.length;
  const i = Math.floor(at);
  const t = at - i;
  const corner = (k: number): readonly [number, number] => WALK[(i + k + WALK.length) % WALK.length] ?? [0, 0];
  const [a, b, c, d] = [corner(-1), corner(0), corner(1), corner(2)];
  const curve = (k: 0 | 1): number =>
    0.5 * (2 * b[k] + (c[k] - a[k]) * t + (2 * a[k] - 5 * b[k] + 4 * c[k] - d[k]) * t * t + (3 * (b[k] - c[k]) + d[k] - a[k]) * t * t * t);
  return [curve(0), curve(1)];
}

export interface Hit {
  readonly near: number; // horizontal distance to where the ray enters
  readonly far: number; // and to where it leaves
  readonly box: Box;
  readonly alongX: boolean; // the side that is hit runs along x
}

/** Every box that a horizontal ray meets, nearest first. */
export function hitsAlong(boxes: readonly Box[], x: number, y: number, azimuth: number): Hit[] {
  const dx = Math.cos(azimuth);
  const dy = Math.sin(azimuth);
  const hits: Hit[] = [];
  for (const b of boxes) {
    const [xIn, xOut] = ordered((b.x0 - x) / dx, (b.x1 - x) / dx);
    const [yIn, yOut] = ordered((b.y0 - y) / dy, (b.y1 - y) / dy);
    const near = Math.max(xIn, yIn);
    const far = Math.min(xOut, yOut);
    if (far > Math.max(near, 0.05)) hits.push({ near: Math.max(near, 0.05), far, box: b, alongX: yIn > xIn });
  }
  return hits.sort((a, b) => a.near - b.near);
}

const ordered = (a: number, b: number): [number, number] => (a < b ? [a, b] : [b, a]);
