// Which of the tiles held are drawn: never a hole where something is known, never a picture that waits for the last tile. Pure.

import { overlaps, TILE_SIDE, tileRect, type Tile, type TileKey, type TileStore } from './tile_store';
import type { Rect } from './viewport';

type IsThere = (key: TileKey) => boolean;

/**
 * The tiles to draw where `rect` is on screen: those of `level`; where one is not yet ready to be drawn, finer tiles that
 * stand in for it; and under them coarser ones. Fine first: what they cover need not be painted.
 */
export function tilesToDraw(store: TileStore, rect: Rect, level: number, cellSize: number, isReady: IsThere = (key) => store.get(key) !== undefined): Tile[] {
  const drawn: Tile[] = [];
  for (const tile of store.all()) {
    if (!overlaps(tileRect(tile, cellSize), rect)) continue;
    if (tile.level >= level || !isReady(ancestor(tile, level))) drawn.push(tile);
  }
  return drawn.sort((a, b) => a.level - b.level || a.y - b.y || a.x - b.x);
}

const ancestor = ({ level: own, x, y }: TileKey, level: number): TileKey => ({ level, x: x >> (level - own), y: y >> (level - own) });

/** Quarter of a tile that a column lies in: 0 lower left, 1 lower right, 2 upper left, 3 upper right. */
export const quarterOf = (x: number, y: number): number => Number(x >= TILE_SIDE / 2) + 2 * Number(y >= TILE_SIDE / 2);

/** What stands up has no under: a tile coarser than wanted is drawn only in the quarters whose finer tile is not there. */
export function quartersToDraw(tile: TileKey, level: number, isThere: IsThere): number[] {
  const child = (quarter: number): TileKey => ({ level: tile.level - 1, x: 2 * tile.x + (quarter % 2), y: 2 * tile.y + (quarter >> 1) });
  return [0, 1, 2, 3].filter((quarter) => tile.level <= level || !isThere(child(quarter)));
}
