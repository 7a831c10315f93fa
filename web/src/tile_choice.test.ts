import { describe, expect, it } from 'vitest';
import { seededRandom } from './seeded_random';
import { quarterOf, quartersToDraw, tilesToDraw } from './tile_choice';
import { keyText, TILE_SIDE, TileStore, type Tile, type TileKey } from './tile_store';

const tile = (level: number, x: number, y: number): Tile => ({ level, x, y, rev: 1n, planes: new Uint8Array(0) });
const storeOf = (tiles: readonly Tile[]): TileStore => {
  const store = new TileStore(1e9);
  for (const one of tiles) store.apply(one);
  return store;
};
const everything = { xMin: -100, yMin: -100, xMax: 100, yMax: 100 };

describe('the choice of tiles', () => {
  const store = storeOf([tile(0, 0, 0), tile(0, 1, 0), tile(1, 0, 0), tile(0, 2, 0), tile(2, 0, 0)]);

  it('draws the wanted level, and finer tiles where it is missing, coarse ones below', () => {
    expect(tilesToDraw(store, everything, 1, 0.02).map(keyText)).toEqual(['0/2/0', '1/0/0', '2/0/0']);
    expect(tilesToDraw(store, { xMin: 50, yMin: 50, xMax: 60, yMax: 60 }, 1, 0.02)).toEqual([]);
  });

  it('keeps finer tiles until the wanted one can be drawn', () => {
    expect(tilesToDraw(store, everything, 1, 0.02, () => false).map(keyText)).toEqual(['0/0/0', '0/1/0', '0/2/0', '1/0/0', '2/0/0']);
  });
});

describe('boxes of tiles of several levels', () => {
  it('leave no hole while finer tiles come one by one, and never stand in one another', () => {
    const random = seededRandom(11);
    const TOP = 3;
    for (let round = 0; round < 200; ++round) {
      const held = [tile(TOP, 0, 0)]; // the coarsest comes first; of the finer ones some are there
      for (let level = 0; level < TOP; ++level) for (let i = 0; i < 4 ** (TOP - level); ++i) if (random() < 0.5) held.push(tile(level, i % 2 ** (TOP - level), Math.floor(i / 2 ** (TOP - level))));
      const store = storeOf(held);
      const drawn = tilesToDraw(store, everything, 0, 0.02);
      const isThere = (key: TileKey): boolean => store.get(key) !== undefined;
      for (let at = 0; at < 64; ++at) expect(drawn.filter((one) => covers(one, at % 8, at >> 3, isThere)).length).toBeGreaterThanOrEqual(1);
      const finest = held.filter(({ level }) => level === 0);
      for (const { x, y } of finest) expect(drawn.filter((one) => covers(one, x, y, isThere) && one.level < 2).length).toBe(1);
    }
  });

  /** Whether boxes of `one` stand where the tile x, y of level 0 lies. */
  function covers(one: TileKey, x: number, y: number, isThere: (key: TileKey) => boolean): boolean {
    const side = 2 ** one.level;
    if (Math.floor(x / side) !== one.x || Math.floor(y / side) !== one.y) return false;
    const column = (c: number, corner: number): number => ((c - corner * side) * TILE_SIDE) / side;
    return quartersToDraw(one, 0, isThere).includes(quarterOf(column(x, one.x), column(y, one.y)));
  }
});
