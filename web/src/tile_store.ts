// The page's copy of the map: the newest revision of each tile wins. Pure; no drawing, no network.

import type { Rect } from './viewport';

export const TILE_SIDE = 64; // columns
export const BYTES_PER_LAYER = TILE_SIDE * TILE_SIDE * 4;

export interface TileKey {
  readonly level: number;
  readonly x: number;
  readonly y: number;
}

export interface Tile extends TileKey {
  readonly rev: bigint;
  /** One plane after another in the order of the map's layers, each 64 x 64 x (E, O, K, C), row 0 at the lowest y. */
  readonly planes: Uint8Array;
}

export const keyText = ({ level, x, y }: TileKey): string => `${level}/${x}/${y}`;

/** Side of a tile of a level, metres. */
export const tileSide = (level: number, cellSize: number): number => TILE_SIDE * 2 ** level * cellSize;

export function tileRect(key: TileKey, cellSize: number): Rect {
  const side = tileSide(key.level, cellSize);
  return { xMin: key.x * side, yMin: key.y * side, xMax: (key.x + 1) * side, yMax: (key.y + 1) * side };
}

export const overlaps = (a: Rect, b: Rect): boolean => a.xMin < b.xMax && b.xMin < a.xMax && a.yMin < b.yMax && b.yMin < a.yMax;

export class TileStore {
  private readonly tiles = new Map<string, Tile>(); // oldest use first
  private heldBytes = 0;

  constructor(private budget: number) {}

  get count(): number {
    return this.tiles.size;
  }

  get bytes(): number {
    return this.heldBytes;
  }

  setBudget(bytes: number): void {
    this.budget = bytes;
  }

  get(key: TileKey): Tile | undefined {
    return this.tiles.get(keyText(key));
  }

  all(): IterableIterator<Tile> {
    return this.tiles.values();
  }

  /** True if the tile must be drawn anew; a revision that is already here, or an older one, changes nothing. */
  apply(tile: Tile): boolean {
    const key = keyText(tile);
    const old = this.tiles.get(key);
    if (old && old.rev >= tile.rev) return false;
    this.tiles.delete(key);
    this.tiles.set(key, tile);
    this.heldBytes += tile.planes.byteLength - (old?.planes.byteLength ?? 0);
    return true;
  }

  remove(key: TileKey): boolean {
    const old = this.tiles.get(keyText(key));
    if (!old) return false;
    this.heldBytes -= old.planes.byteLength;
    return this.tiles.delete(keyText(key));
  }

  clear(): void {
    this.tiles.clear();
    this.heldBytes = 0;
  }

  /** Marks tiles as used now, so that they are the last to be evicted. */
  touch(tiles: Iterable<TileKey>): void {
    for (const key of tiles) {
      const text = keyText(key);
      const tile = this.tiles.get(text);
      if (!tile) continue;
      this.tiles.delete(text);
      this.tiles.set(text, tile);
    }
  }

  /** Drops the least recently used tiles that are not in `keep` until the budget holds; returns what was dropped. */
  evict(keep: ReadonlySet<string>): TileKey[] {
    const dropped: TileKey[] = [];
    for (const [text, tile] of this.tiles) {
      if (this.heldBytes <= this.budget) break;
      if (keep.has(text)) continue;
      this.remove(tile);
      dropped.push({ level: tile.level, x: tile.x, y: tile.y });
    }
    return dropped;
  }

  /** Smallest rectangle around all tiles of level 0, or around all tiles if none of level 0 is held. */
  bounds(cellSize: number): Rect | undefined {
    let box: Rect | undefined;
    const finest = Math.min(...Array.from(this.tiles.values(), (tile) => tile.level));
    for (const tile of this.tiles.values()) {
      if (tile.level !== finest) continue;
      const r = tileRect(tile, cellSize);
      box = box
        ? { xMin: Math.min(box.xMin, r.xMin), yMin: Math.min(box.yMin, r.yMin), xMax: Math.max(box.xMax, r.xMax), yMax: Math.max(box.yMax, r.yMax) }
        : r;
    }
    return box;
  }
}

/** Where a world point lies: its tile of `level` and the index of its column within, row-major. */
export function locate(x: number, y: number, level: number, cellSize: number): { key: TileKey; column: number } {
  const cell = cellSize * 2 ** level;
  const i = Math.floor(x / cell);
  const j = Math.floor(y / cell);
  const key = { level, x: Math.floor(i / TILE_SIDE), y: Math.floor(j / TILE_SIDE) };
  return { key, column: (j - key.y * TILE_SIDE) * TILE_SIDE + (i - key.x * TILE_SIDE) };
}

/** The tile of the finest level that holds a world point. */
export const tileAt = (store: TileStore, x: number, y: number, cellSize: number): Tile | undefined => store.get(locate(x, y, 0, cellSize).key);

/** E, O, K, C in [0, 1] of every layer at a world point; undefined where no tile is held. */
export function columnAt(store: TileStore, x: number, y: number, cellSize: number): { E: number; O: number; K: number; C: number }[] | undefined {
  const { key, column } = locate(x, y, 0, cellSize);
  const planes = store.get(key)?.planes;
  if (!planes) return undefined;
  const byte = (at: number): number => (planes[at] ?? 0) / 255;
  return Array.from({ length: planes.byteLength / BYTES_PER_LAYER }, (_, layer) => {
    const at = layer * BYTES_PER_LAYER + column * 4;
    return { E: byte(at), O: byte(at + 1), K: byte(at + 2), C: byte(at + 3) };
  });
}
