// What of a path is worth drawing: nothing that lies closer together than a pixel, nothing that a newer stretch covers.
// So a camera that walks the same rooms for hours costs as much to draw as one that walked them once. Pure.

import type { Path } from './path';

/** Numbers per corner: x, y, z [m], seconds since the start, tracking state. A state of -1: no line leads on from here. */
export const CORNER = 5;
const MAX_CORNERS = 8192;
const NEAREST_M = 0.01;

/** Corners of the line from point `first` on, oldest first, at least about `spacing` metres apart. */
export function drawnPath(path: Path, spacing: number, first = 0): Float32Array {
  for (let apart = Math.max(NEAREST_M, spacing); ; apart *= 2) {
    const corners = cornersOf(path, apart, first);
    if (corners) return corners;
  }
}

/** Undefined if there are too many. */
function cornersOf(path: Path, spacing: number, first: number): Float32Array | undefined {
  const covered = new Covered(spacing);
  const found: number[] = []; // newest first
  const put = (i: number, state: number): unknown => found.push(path.place(i, 0), path.place(i, 1), path.place(i, 2), path.seconds(i), state);
  let next = -1; // the corner that the line leads to
  let nextIsThere = false;
  for (let i = path.length - 1; i >= first; --i) {
    if (next >= 0 && path.hasPose(i) && i > first && canSkip(path, i, next, spacing)) continue;
    const drawn = next >= 0 && path.hasPose(i) && covered.add(path, i, next);
    if (drawn && !nextIsThere) put(next, -1);
    if (drawn) put(i, path.state(i));
    next = path.hasPose(i) ? i : -1;
    nextIsThere = drawn;
    if (found.length > MAX_CORNERS * CORNER) return undefined;
  }
  return reversed(found);
}

/** Nothing ends or changes at i, and it is close to the next corner. */
const canSkip = (path: Path, i: number, next: number, spacing: number): boolean =>
  path.hasPose(i - 1) && path.state(i) === path.state(next) && distance(path, i, next) < spacing;

function reversed(corners: readonly number[]): Float32Array {
  const turned = new Float32Array(corners.length);
  for (let i = 0; i < corners.length; i += CORNER) for (let k = 0; k < CORNER; ++k) turned[corners.length - CORNER - i + k] = corners[i + k] ?? 0;
  return turned;
}

const distance = (path: Path, i: number, j: number): number =>
  Math.hypot(path.place(i, 0) - path.place(j, 0), path.place(i, 1) - path.place(j, 1), path.place(i, 2) - path.place(j, 2));

/** Cells that newer stretches went through. */
class Covered {
  private readonly cells = new Set<number>();

  constructor(private readonly side: number) {}

  /** The stretch from point i to the newer j; false if all of it was covered already. */
  add(path: Path, i: number, j: number): boolean {
    const steps = Math.max(1, Math.ceil(distance(path, i, j) / this.side));
    const before = this.cells.size;
    for (let k = 0; k <= steps; ++k) this.cells.add(this.cell(path, i, j, k / steps));
    return this.cells.size > before;
  }

  private cell(path: Path, i: number, j: number, t: number): number {
    const at = (axis: 0 | 1 | 2): number => Math.floor((path.place(i, axis) + t * (path.place(j, axis) - path.place(i, axis))) / this.side);
    return ((at(0) + 2 ** 20) * 2 ** 21 + at(1) + 2 ** 20) * 2 ** 11 + at(2) + 2 ** 10;
  }
}

/** Places of mapped views from point `first` on, x, y, z each, at least `spacing` metres from one another along the path and where they were before. */
export function drawnViews(path: Path, spacing: number, first = 0): Float32Array {
  const taken = new Set<string>();
  const places: number[] = [];
  for (let i = path.length - 1; i >= first; --i) {
    if (!path.mapped(i) || !path.hasPose(i)) continue;
    const [x, y, z] = [path.place(i, 0), path.place(i, 1), path.place(i, 2)];
    const cell = `${Math.round(x / spacing)} ${Math.round(y / spacing)} ${Math.round(z / spacing)}`;
    if (taken.has(cell)) continue;
    taken.add(cell);
    places.push(x, y, z);
  }
  return new Float32Array(places);
}
