// Poses as the page needs them. world_from_camera: x right, y down, z forward in the camera; z up in the world.

import type { PoseValue } from './gen/flogmap/v1/map_pb';

export type Vector = readonly [number, number, number];

type Quaternion = Pick<PoseValue, 'qx' | 'qy' | 'qz' | 'qw'>;

/** R v, with the rotation of a pose. */
export function rotate({ qx, qy, qz, qw }: Quaternion, [x, y, z]: Vector): Vector {
  const tx = 2 * (qy * z - qz * y);
  const ty = 2 * (qz * x - qx * z);
  const tz = 2 * (qx * y - qy * x);
  return [x + qw * tx + qy * tz - qz * ty, y + qw * ty + qz * tx - qx * tz, z + qw * tz + qx * ty - qy * tx];
}

/** Direction of the optical axis seen from above, radians counter-clockwise from +x. */
export function heading(pose: Quaternion): number {
  const [x, y] = rotate(pose, [0, 0, 1]);
  return Math.atan2(y, x);
}

/** q = R p + T. */
export function worldFromCamera(pose: PoseValue, p: Vector): Vector {
  const [x, y, z] = rotate(pose, p);
  return [x + pose.x, y + pose.y, z + pose.z];
}

/** Length of a line of points, metres. */
export function lengthOf(points: readonly { readonly x: number; readonly y: number }[]): number {
  let sum = 0;
  for (let i = 1; i < points.length; ++i) {
    const a = points[i - 1];
    const b = points[i];
    if (a && b) sum += Math.hypot(b.x - a.x, b.y - a.y);
  }
  return sum;
}

/** Area inside a closed line of points, square metres; the shoelace formula. */
export function areaOf(points: readonly { readonly x: number; readonly y: number }[]): number {
  let sum = 0;
  points.forEach((a, i) => {
    const b = points[(i + 1) % points.length];
    if (b) sum += a.x * b.y - b.x * a.y;
  });
  return Math.abs(sum) / 2;
}
