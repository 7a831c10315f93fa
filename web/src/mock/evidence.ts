// A small FLOG map for the simulated room: eqs. (6)-(10), one horizontal ray per azimuth and layer. Not for measuring.

import { TILE_SIDE, keyText, type TileKey } from '../tile_store';

export const CELL_SIZE = 0.05;
export const FULL_CONFIDENCE_RAYS = 420; // N_K
const MAX_RAYS = 3 * FULL_CONFIDENCE_RAYS;
const RAYS_PER_COLUMN = 28; // pixels of the picture that one azimuth stands for
const FT = 40; // f t of the camera, px m
export const LAYERS = [
  { id: 0, name: 'Low', zMin: 0.05, zMax: 0.75 },
  { id: 1, name: 'Middle', zMin: 0.75, zMax: 1.45 },
  { id: 2, name: 'High', zMin: 1.45, zMax: 2.15 },
] as const;

export interface CellState {
  E: number;
  O: number;
  N: number;
  C: number;
}

const COLUMNS = TILE_SIDE * TILE_SIDE;

export class EvidenceTile {
  readonly values = new Float32Array(LAYERS.length * COLUMNS * 4); // E, O, N, C
  rev = 0n;
  constructor(readonly key: TileKey) {}
}

export class EvidenceMap {
  readonly tiles = new Map<string, EvidenceTile>();
  rev = 0n;

  constructor(private readonly random: () => number) {}

  /** Adds what one ray of a layer says: free up to `range`, a surface there unless it is beyond `maxRange`. */
  addRay(layer: number, x: number, y: number, azimuth: number, range: number, maxRange: number): void {
    const hit = range < maxRange;
    const sigma = (0.1 * range * range * Math.SQRT2) / FT;
    const l = Math.min(range, maxRange) + (hit ? sigma * (this.random() + this.random() - 1) : 0);
    const m = Math.max(3 * sigma, CELL_SIZE);
    const dx = Math.cos(azimuth);
    const dy = Math.sin(azimuth);
    let lastI = NaN;
    let lastJ = NaN;
    for (let r = CELL_SIZE / 2; r < l + (hit ? m : -m); r += 0.7 * CELL_SIZE) {
      const i = Math.floor((x + r * dx) / CELL_SIZE);
      const j = Math.floor((y + r * dy) / CELL_SIZE);
      if (i === lastI && j === lastJ) continue;
      [lastI, lastJ] = [i, j];
      const E = r < l - m ? 1 : Math.max(0, (l - r) / m); // (6)
      const O = r < l - m ? 0 : r < l ? 1 - (l - r) / m : Math.max(0, 1 - (r - l) / m); // (7)
      this.fuse(layer, i, j, E, hit ? O : 0);
    }
  }

  /** Starts a view: what changed lately fades. Call `commit` after its rays. */
  readonly touched = new Set<EvidenceTile>();

  commit(): EvidenceTile[] {
    ++this.rev;
    const changed = [...this.touched];
    for (const tile of changed) tile.rev = this.rev;
    this.touched.clear();
    return changed;
  }

  cellAt(layer: number, x: number, y: number): CellState {
    const i = Math.floor(x / CELL_SIZE);
    const j = Math.floor(y / CELL_SIZE);
    const tile = this.tiles.get(keyText({ level: 0, x: Math.floor(i / TILE_SIDE), y: Math.floor(j / TILE_SIDE) }));
    const at = indexOf(layer, i, j);
    const value = (k: number): number => tile?.values[at + k] ?? 0;
    return { E: value(0), O: value(1), N: value(2), C: value(3) };
  }

  private fuse(layer: number, i: number, j: number, E: number, O: number): void { // (8)(9)
    const tile = this.tileOf(i, j);
    const v = tile.values;
    const at = indexOf(layer, i, j);
    const N = Math.min(v[at + 2] ?? 0, MAX_RAYS - RAYS_PER_COLUMN);
    const total = N + RAYS_PER_COLUMN;
    const change = N > FULL_CONFIDENCE_RAYS / 8 ? Math.abs(O - (v[at + 1] ?? 0)) : 0;
    v[at] = (N * (v[at] ?? 0) + RAYS_PER_COLUMN * E) / total;
    v[at + 1] = (N * (v[at + 1] ?? 0) + RAYS_PER_COLUMN * O) / total;
    v[at + 2] = total;
    v[at + 3] = Math.max((v[at + 3] ?? 0) * 0.94, change);
    this.touched.add(tile);
  }

  private lastTile: EvidenceTile | undefined;

  private tileOf(i: number, j: number): EvidenceTile {
    const key = { level: 0, x: Math.floor(i / TILE_SIDE), y: Math.floor(j / TILE_SIDE) };
    if (this.lastTile?.key.x === key.x && this.lastTile.key.y === key.y) return this.lastTile;
    const text = keyText(key);
    let tile = this.tiles.get(text);
    if (!tile) this.tiles.set(text, (tile = new EvidenceTile(key)));
    this.lastTile = tile;
    return tile;
  }
}

const indexOf = (layer: number, i: number, j: number): number =>
  (layer * COLUMNS + (((j % TILE_SIDE) + TILE_SIDE) % TILE_SIDE) * TILE_SIDE + (((i % TILE_SIDE) + TILE_SIDE) % TILE_SIDE)) * 4;

/** E, O and K of a layer of a tile as three planes of bytes, and C as a fourth. */
export function planesOf(tile: EvidenceTile, layer: number): { evidence: Uint8Array; change: Uint8Array } {
  const evidence = new Uint8Array(3 * COLUMNS);
  const change = new Uint8Array(COLUMNS);
  for (let column = 0; column < COLUMNS; ++column) {
    const at = (layer * COLUMNS + column) * 4;
    evidence[column] = Math.round(255 * (tile.values[at] ?? 0));
    evidence[COLUMNS + column] = Math.round(255 * (tile.values[at + 1] ?? 0));
    evidence[2 * COLUMNS + column] = Math.round(255 * Math.min(1, (tile.values[at + 2] ?? 0) / FULL_CONFIDENCE_RAYS)); // (10)
    change[column] = Math.round(255 * (tile.values[at + 3] ?? 0));
  }
  return { evidence, change };
}
