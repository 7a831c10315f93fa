// Someone who walks or flies through the map: where they stand, where they look, and how keys and path move them. Pure.

import { rotate, type Vector } from '../geometry';
import type { PoseValue } from '../gen/flogmap/v1/map_pb';
import type { PathPoints } from '../path';
import { wrapAngle } from '../viewport';
import type { Eye } from './view_choice';

export interface Walker {
  readonly position: Vector;
  /** Direction of looking seen from above, radians counter-clockwise from +x. */
  readonly yaw: number;
  /** Above the horizon, radians. */
  readonly pitch: number;
}

/** What keys and sticks ask for, each in [-1, 1]. */
export interface Wish {
  readonly ahead: number;
  readonly aside: number; // to the right
  readonly up: number;
  readonly turn: number; // to the left
}

export const STANDING: Wish = { ahead: 0, aside: 0, up: 0, turn: 0 };
export const MAX_PITCH = 1.4;
export const WALK_M_PER_S = 1.4;
const FLY_M_PER_S = 2.2;
const TURN_PER_S = 1.6;
const SETTLE_PER_S = 3; // how soon a walker's eyes are at the height they should be

export const isMoving = (wish: Wish): boolean => Object.values(wish).some((part) => part !== 0);

/** `blocked`: a walker may not stand there; sliding along is allowed. `eyeHeight`: where the eyes of a walker settle. */
export interface Ground {
  blocked(x: number, y: number): boolean;
  eyeHeight(x: number, y: number): number;
}

export function step(walker: Walker, wish: Wish, seconds: number, flies: boolean, ground: Ground): Walker {
  const yaw = wrapAngle(walker.yaw + wish.turn * TURN_PER_S * seconds);
  const speed = (flies ? FLY_M_PER_S : WALK_M_PER_S) * seconds;
  const length = Math.max(1, Math.hypot(wish.ahead, wish.aside));
  const ahead = (wish.ahead / length) * speed;
  const aside = (wish.aside / length) * speed;
  const rise = flies ? Math.sin(walker.pitch) * ahead + wish.up * speed : 0;
  const level = flies ? Math.cos(walker.pitch) : 1;
  const dx = Math.cos(yaw) * level * ahead + Math.sin(yaw) * aside;
  const dy = Math.sin(yaw) * level * ahead - Math.cos(yaw) * aside;
  const [x, y, z] = walker.position;
  if (flies) return { ...walker, yaw, position: [x + dx, y + dy, z + rise] };
  const stuck = ground.blocked(x, y); // who stands in a wall already may leave it
  const nextX = stuck || !ground.blocked(x + dx, y) ? x + dx : x;
  const nextY = stuck || !ground.blocked(nextX, y + dy) ? y + dy : y;
  const settled = z + (ground.eyeHeight(nextX, nextY) - z) * (1 - Math.exp(-SETTLE_PER_S * seconds));
  return { ...walker, yaw, position: [nextX, nextY, settled] };
}

export const look = (walker: Walker, left: number, up: number): Walker =>
  ({ ...walker, yaw: wrapAngle(walker.yaw + left), pitch: Math.max(-MAX_PITCH, Math.min(MAX_PITCH, walker.pitch + up)) });

/** As the camera stood, without its roll. */
export function standingAt(pose: PoseValue): Walker {
  const [x, y, z] = rotate(pose, [0, 0, 1]);
  return { position: [pose.x, pose.y, pose.z], yaw: Math.atan2(y, x), pitch: Math.max(-MAX_PITCH, Math.min(MAX_PITCH, Math.asin(Math.max(-1, Math.min(1, z))))) };
}

export function eyeOf({ position, yaw, pitch }: Walker): Eye {
  const c = Math.cos(pitch);
  return { position, forward: [Math.cos(yaw) * c, Math.sin(yaw) * c, Math.sin(pitch)], right: [Math.sin(yaw), -Math.cos(yaw), 0] };
}

/** Seconds from the first to the last pose of a path; pauses longer than `LONGEST_GAP_S` count as that. */
const LONGEST_GAP_S = 1;

export function rideTimes(path: PathPoints): number[] {
  const times: number[] = [];
  let before: bigint | undefined;
  for (let i = 0; i < path.length; ++i) {
    const timeNs = path.at(i)?.timeNs ?? 0n;
    const gap = before === undefined ? 0 : Number(timeNs - before) / 1e9;
    times.push((times[i - 1] ?? 0) + Math.min(LONGEST_GAP_S, Math.max(0, gap)));
    before = timeNs;
  }
  return times;
}

/** Where the camera was, `seconds` after the start of the ride; between poses on the straight way. */
export function rideAt(path: PathPoints, times: readonly number[], seconds: number): Walker | undefined {
  let low = 0;
  let high = times.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if ((times[middle] ?? 0) <= seconds) low = middle;
    else high = middle;
  }
  const a = path.at(low)?.pose;
  const b = path.at(high)?.pose;
  if (!a || !b) return a ? standingAt(a) : undefined;
  const span = (times[high] ?? 0) - (times[low] ?? 0);
  const t = span > 0 ? Math.min(1, Math.max(0, (seconds - (times[low] ?? 0)) / span)) : 0;
  const from = standingAt(a);
  const to = standingAt(b);
  const mix = (x: number, y: number): number => x + (y - x) * t;
  return {
    position: [mix(from.position[0], to.position[0]), mix(from.position[1], to.position[1]), mix(from.position[2], to.position[2])],
    yaw: wrapAngle(from.yaw + wrapAngle(to.yaw - from.yaw) * t), pitch: mix(from.pitch, to.pitch),
  };
}
