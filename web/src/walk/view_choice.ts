// Which mapped views show best what an eye sees. Pure.

import { rotate, type Vector } from '../geometry';

export interface MappedView {
  readonly number: number;
  readonly timeNs: bigint;
  readonly position: Vector;
  readonly orientation: { readonly qx: number; readonly qy: number; readonly qz: number; readonly qw: number };
}

/** The camera that took the views. */
export interface ViewCameraModel {
  readonly focalPx: number;
  readonly cxPx: number;
  readonly cyPx: number;
  readonly widthPx: number;
  readonly heightPx: number;
}

export interface Eye {
  readonly position: Vector;
  readonly forward: Vector; // unit
  readonly right: Vector; // unit, level
}

const PROBE_DISTANCES_M = [1, 2.5, 5] as const;
const PROBE_ANGLES = [0, -0.35, 0.35, -0.7, 0.7] as const; // radians to the side; what matters most first
const PER_METRE = 1; // cost of a view taken a metre away ...
const PER_RADIAN = 2.5; // ... and of looking at a place from another direction than the view did
const OFF_AXIS = 0.3; // per radian: the middle of a picture is its best part
const OUTSIDE = 3; // the view does not see the place at all
const MAX_DEPTH_M = 8;

const minus = (a: Vector, b: Vector): Vector => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const dot = (a: Vector, b: Vector): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const norm = (a: Vector): number => Math.hypot(...a);

const angleBetween = (a: Vector, b: Vector): number => Math.acos(Math.max(-1, Math.min(1, dot(a, b) / Math.max(1e-6, norm(a) * norm(b)))));

/** True if a world point falls into the picture of a view, not too far away. */
export function sees(view: MappedView, camera: ViewCameraModel, point: Vector): boolean {
  const { qx, qy, qz, qw } = view.orientation;
  const [x, y, z] = rotate({ qx: -qx, qy: -qy, qz: -qz, qw }, minus(point, view.position));
  if (z < 0.2 || z > MAX_DEPTH_M) return false;
  const u = camera.cxPx + (camera.focalPx * x) / z;
  const v = camera.cyPx + (camera.focalPx * y) / z;
  return u >= 0 && v >= 0 && u < camera.widthPx && v < camera.heightPx;
}

function costAt(view: MappedView, camera: ViewCameraModel, eye: Eye, point: Vector): number {
  const fromView = minus(point, view.position);
  const fromEye = minus(point, eye.position);
  const offAxis = angleBetween(fromView, rotate(view.orientation, [0, 0, 1]));
  return PER_METRE * norm(minus(view.position, eye.position)) + PER_RADIAN * angleBetween(fromView, fromEye) + OFF_AXIS * offAxis + (sees(view, camera, point) ? 0 : OUTSIDE);
}

/**
 * At most `count` views, best first: for places ahead and to the sides the views that were taken near the eye, see the
 * place, and saw it from a like direction. A view that is chosen already serves the next place too.
 */
export function chooseViews(views: readonly MappedView[], camera: ViewCameraModel, eye: Eye, count: number): MappedView[] {
  const ranked = PROBE_ANGLES.map((angle) => {
    const c = Math.cos(angle);
    const s = Math.sin(angle);
    const way: Vector = [c * eye.forward[0] + s * eye.right[0], c * eye.forward[1] + s * eye.right[1], c * eye.forward[2] + s * eye.right[2]];
    const places = PROBE_DISTANCES_M.map((d): Vector => [eye.position[0] + d * way[0], eye.position[1] + d * way[1], eye.position[2] + d * way[2]]);
    return views.map((view) => ({ view, cost: places.reduce((sum, place) => sum + costAt(view, camera, eye, place), 0) / places.length })).sort((a, b) => a.cost - b.cost);
  });
  const chosen = new Map<number, { view: MappedView; cost: number }>();
  for (let round = 0; chosen.size < Math.min(count, views.length); ++round)
    for (const list of ranked) {
      const next = list[round];
      if (next && chosen.size < count && !chosen.has(next.view.number)) chosen.set(next.view.number, next);
    }
  const ahead = new Map(ranked[0]?.map(({ view, cost }) => [view.number, cost]));
  return [...chosen.values()].sort((a, b) => (ahead.get(a.view.number) ?? 0) - (ahead.get(b.view.number) ?? 0)).map(({ view }) => view);
}
