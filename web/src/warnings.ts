// What is wrong and what to do, told from the pictures and the path alone. Pure; the server adds its own.

import type { PoseValue } from './gen/flogmap/v1/map_pb';
import type { PathPoints } from './path';

/** Of a picture, in grey levels 0 .. 255. */
export interface Light {
  readonly mean: number;
  readonly spread: number; // standard deviation
}

const FLAT = 6; // below, nothing can be matched
const DARK = 28;
const BRIGHT = 236;
const FAST_RAD_PER_S = 1.6;
const FAST_M_PER_S = 2.5;
const WITHIN_S = 0.7;

export function lightOf(rgba: Uint8ClampedArray): Light {
  let sum = 0;
  let squares = 0;
  const count = rgba.length / 4;
  for (let i = 0; i < rgba.length; i += 4) {
    const grey = ((rgba[i] ?? 0) + (rgba[i + 1] ?? 0) + (rgba[i + 2] ?? 0)) / 3;
    sum += grey;
    squares += grey * grey;
  }
  const mean = sum / Math.max(1, count);
  return { mean, spread: Math.sqrt(Math.max(0, squares / Math.max(1, count) - mean * mean)) };
}

export function lightWarnings(left: Light | undefined, right: Light | undefined): string[] {
  const flat = (light: Light | undefined): boolean => light !== undefined && light.spread < FLAT;
  if (flat(left) && flat(right)) return ['Both pictures are blank. Is there light, and are the lenses free?'];
  if (flat(left)) return ['The left picture is blank. Is the left lens covered, or does it face a bare wall?'];
  if (flat(right)) return ['The right picture is blank. Is the right lens covered, or does it face a bare wall?'];
  if (left && left.mean < DARK) return ['Too dark. Add light, open the aperture, or let the camera expose longer.'];
  if (left && left.mean > BRIGHT) return ['Too bright. Expose shorter, or turn away from the light.'];
  return [];
}

/** The angle between two poses, radians. */
function turned(a: PoseValue, b: PoseValue): number {
  return 2 * Math.acos(Math.min(1, Math.abs(a.qx * b.qx + a.qy * b.qy + a.qz * b.qz + a.qw * b.qw)));
}

/** Over the last two poses of the path, if they follow one another closely. */
export function speedWarnings(path: PathPoints): string[] {
  const [before, now] = [path.at(-2), path.at(-1)];
  const seconds = before && now ? Number(now.timeNs - before.timeNs) / 1e9 : 0;
  if (!before?.pose || !now?.pose || seconds <= 0 || seconds > WITHIN_S) return [];
  if (turned(before.pose, now.pose) / seconds > FAST_RAD_PER_S) return ['Turning too fast. Turn slowly, so that pictures overlap and stay sharp.'];
  if (Math.hypot(now.pose.x - before.pose.x, now.pose.y - before.pose.y, now.pose.z - before.pose.z) / seconds > FAST_M_PER_S) return ['Moving too fast. Go slower, so that pictures overlap and stay sharp.'];
  return [];
}
