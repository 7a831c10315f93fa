// Levelling by hand: how the world of the automatic start is turned and raised, and what a floor in a picture says of it.
// Rolled about x, then pitched about y, then turned about z, then raised: R = Rz Ry Rx, as the server has it.

import type { PoseValue } from './gen/flogmap/v1/map_pb';
import type { CameraModel } from './gen/flogmap/v1/stream_pb';
import { rotate, type Vector } from './geometry';
import { seededRandom } from './seeded_random';

/** Degrees and metres, as in the server's answers. */
export interface Level {
  readonly roll: number;
  readonly pitch: number;
  readonly yaw: number;
  readonly height: number;
}

export const NO_LEVEL: Level = { roll: 0, pitch: 0, yaw: 0, height: 0 };

export const sameLevel = (a: Level, b: Level): boolean =>
  (['roll', 'pitch', 'yaw', 'height'] as const).every((name) => Math.abs(a[name] - b[name]) < 1e-6);

/** Rows of a rotation. */
export type Rotation = readonly [Vector, Vector, Vector];

/** q = R p + (0, 0, height); of two of them, one after the other, `shift` has all three parts. */
export interface Motion {
  readonly rotation: Rotation;
  readonly shift: Vector;
}

const RADIANS = Math.PI / 180;

export function motionOf({ roll, pitch, yaw, height }: Level): Motion {
  const [sr, cr, sp, cp, sy, cy] = [roll, pitch, yaw].flatMap((degrees) => [Math.sin(degrees * RADIANS), Math.cos(degrees * RADIANS)]) as [number, number, number, number, number, number];
  return {
    rotation: [
      [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
      [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
      [-sp, cp * sr, cp * cr],
    ],
    shift: [0, 0, height],
  };
}

/** Roll, pitch and yaw of a rotation, degrees; pitch within a right angle. */
export function anglesOf(r: Rotation): Pick<Level, 'roll' | 'pitch' | 'yaw'> {
  return {
    roll: Math.atan2(r[2][1], r[2][2]) / RADIANS,
    pitch: Math.asin(Math.max(-1, Math.min(1, -r[2][0]))) / RADIANS,
    yaw: Math.atan2(r[1][0], r[0][0]) / RADIANS,
  };
}

const dot = (a: Vector, b: Vector): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const column = (r: Rotation, k: 0 | 1 | 2): Vector => [r[0][k], r[1][k], r[2][k]];

export const turned = (r: Rotation, p: Vector): Vector => [dot(r[0], p), dot(r[1], p), dot(r[2], p)];

export function product(a: Rotation, b: Rotation): Rotation {
  const row = (i: 0 | 1 | 2): Vector => [dot(a[i], column(b, 0)), dot(a[i], column(b, 1)), dot(a[i], column(b, 2))];
  return [row(0), row(1), row(2)];
}

export const transposed = (r: Rotation): Rotation => [column(r, 0), column(r, 1), column(r, 2)];

/** What takes the world as levelled by `before` to the world as levelled by `after`. */
export function between(before: Level, after: Level): Motion {
  const [from, to] = [motionOf(before), motionOf(after)];
  const rotation = product(to.rotation, transposed(from.rotation));
  const moved = turned(rotation, from.shift);
  return { rotation, shift: [to.shift[0] - moved[0], to.shift[1] - moved[1], to.shift[2] - moved[2]] };
}

/** The smallest rotation that takes one unit vector to the z axis. Rodrigues' formula with axis up x z. */
export function uprighting([x, y, z]: Vector): Rotation {
  if (z < -0.9999) return [[1, 0, 0], [0, -1, 0], [0, 0, -1]]; // upside down: half a turn about x
  const k = 1 / (1 + z);
  return [[1 - k * x * x, -k * x * y, -x], [-k * x * y, 1 - k * y * y, -y], [x, y, z]];
}

/** A place in the disparity picture, pixels of the camera's full size, and the disparity read there. */
export interface Sample {
  readonly x: number;
  readonly y: number;
  readonly d: number;
}

/** The camera over a plane: unit vector away from the plane in the camera's frame, and the distance to it, metres. */
export interface Floor {
  readonly up: Vector;
  readonly distance: number;
}

/**
 * The plane that most of the samples lie on. A plane of the world is one of the disparity picture: with d = a x + b y + c,
 * f t = N p for N = (a f, b f, a cx + b cy + c). Of planes through three samples each the one that most agree with, then
 * least squares over those. Undefined where there is too little to see.
 */
export function floorOf(samples: readonly Sample[], camera: Pick<CameraModel, 'focalPx' | 'cxPx' | 'cyPx' | 'baselineM'>): Floor | undefined {
  const valid = samples.filter(({ d }) => d > 0.5);
  let agreeing = mostAgreed(valid);
  let plane: Vector | undefined;
  for (let round = 0; round < 3; ++round) {
    plane = agreeing.length >= LEAST_SAMPLES ? planeThrough(agreeing) : undefined;
    if (!plane) return undefined;
    agreeing = near(valid, plane);
  }
  if (!plane || 2 * agreeing.length < valid.length) return undefined;
  const [a, b, c] = plane;
  const normal: Vector = [a * camera.focalPx, b * camera.focalPx, a * camera.cxPx + b * camera.cyPx + c];
  const length = Math.hypot(...normal);
  if (length < 1e-6) return undefined;
  return { up: [-normal[0] / length, -normal[1] / length, -normal[2] / length], distance: (camera.focalPx * camera.baselineM) / length };
}

const LEAST_SAMPLES = 50;
const NEAR_PX = 0.5; // disparities are read in steps of a 256th of the scale
const TRIALS = 150;
const LOOKED_AT = 600; // samples that each trial is judged by

const near = (samples: readonly Sample[], [a, b, c]: Vector): Sample[] => samples.filter(({ x, y, d }) => Math.abs(d - a * x - b * y - c) <= NEAR_PX);

/** Those near the best of some planes through three samples; the same samples give the same answer. */
function mostAgreed(samples: readonly Sample[]): Sample[] {
  const random = seededRandom(1);
  const some = samples.filter((_, i) => i % Math.ceil(samples.length / LOOKED_AT) === 0);
  let best: Sample[] = [];
  for (let trial = 0; trial < TRIALS && some.length > 0; ++trial) {
    const three = Array.from({ length: 3 }, () => some[Math.floor(random() * some.length)] as Sample);
    const plane = planeThrough(three);
    const found = plane ? near(some, plane) : [];
    if (found.length > best.length) best = found;
  }
  return best;
}

/** d = a x + b y + c by normal equations about the middle; undefined if the samples lie on a line. */
function planeThrough(samples: readonly Sample[]): Vector | undefined {
  const n = samples.length;
  const mean = (pick: (s: Sample) => number): number => samples.reduce((sum, s) => sum + pick(s), 0) / n;
  const [mx, my, md] = [mean((s) => s.x), mean((s) => s.y), mean((s) => s.d)];
  const over = (f: (x: number, y: number, d: number) => number): number => samples.reduce((sum, s) => sum + f(s.x - mx, s.y - my, s.d - md), 0) / n;
  const [xx, xy, yy, xd, yd] = [over((x) => x * x), over((x, y) => x * y), over((_, y) => y * y), over((x, _, d) => x * d), over((_, y, d) => y * d)];
  const determinant = xx * yy - xy * xy;
  if (determinant < 1) return undefined; // square pixels to the fourth
  const a = (xd * yy - yd * xy) / determinant;
  const b = (yd * xx - xd * xy) / determinant;
  return [a, b, md - a * mx - b * my];
}

/** The level that makes this floor level and puts it at height 0. `pose`: of the camera, in the world levelled by `now`. */
export function levelByFloor(floor: Floor, pose: PoseValue, now: Level): Level {
  const up = rotate(pose, floor.up);
  const rotation = product(uprighting(up), motionOf(now).rotation);
  const angles = anglesOf(rotation);
  const { rotation: again, shift } = between(now, { ...angles, height: 0 });
  const camera = turned(again, [pose.x, pose.y, pose.z]);
  return { ...angles, height: floor.distance - (camera[2] + shift[2]) };
}

/** Whether a point lies in the triangle of three others. */
export function inTriangle(x: number, y: number, corners: readonly { readonly x: number; readonly y: number }[]): boolean {
  const side = (i: number): number => {
    const [a, b] = [corners[i], corners[(i + 1) % 3]];
    return a && b ? (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x) : 0;
  };
  const [p, q, r] = [side(0), side(1), side(2)];
  return (p >= 0 && q >= 0 && r >= 0) || (p <= 0 && q <= 0 && r <= 0);
}
