import { describe, expect, it } from 'vitest';
import { seededRandom } from './seeded_random';
import { BYTES_PER_LAYER, columnAt, keyText, locate, tileRect, TileStore, type Tile } from './tile_store';

const tile = (level: number, x: number, y: number, rev: number, layers = 1): Tile => ({ level, x, y, rev: BigInt(rev), planes: new Uint8Array(layers * BYTES_PER_LAYER) });

describe('tile store', () => {
  it('ends with the newest revision of every tile, in whatever order they come and however often', () => {
    const random = seededRandom(3);
    const all = Array.from({ length: 40 }, (_, i) => tile(0, i % 5, 0, Math.floor(i / 5)));
    for (let round = 0; round < 20; ++round) {
      const store = new TileStore(1e9);
      const mixed = [...all, ...all].sort(() => random() - 0.5);
      for (const one of mixed) store.apply(one);
      for (let x = 0; x < 5; ++x) expect(store.get({ level: 0, x, y: 0 })?.rev).toBe(7n);
      expect(store.count).toBe(5);
      expect(store.bytes).toBe(5 * BYTES_PER_LAYER);
    }
  });

  it('says what must be drawn anew', () => {
    const store = new TileStore(1e9);
    expect(store.apply(tile(0, 0, 0, 2))).toBe(true);
    expect(store.apply(tile(0, 0, 0, 2))).toBe(false);
    expect(store.apply(tile(0, 0, 0, 1))).toBe(false);
    expect(store.apply(tile(0, 0, 0, 3))).toBe(true);
  });

  it('keeps its budget by dropping what was not used for longest, never what is on screen', () => {
    const store = new TileStore(3 * BYTES_PER_LAYER);
    for (let x = 0; x < 5; ++x) store.apply(tile(0, x, 0, 1));
    store.touch([{ level: 0, x: 1, y: 0 }]);
    const dropped = store.evict(new Set([keyText({ level: 0, x: 0, y: 0 })]));
    expect(dropped.map(({ x }) => x)).toEqual([2, 3]);
    expect(store.bytes).toBe(3 * BYTES_PER_LAYER);
    expect(store.get({ level: 0, x: 0, y: 0 })).toBeDefined();
  });

  it('counts bytes rightly through any mix of changes', () => {
    const random = seededRandom(5);
    const store = new TileStore(20 * BYTES_PER_LAYER);
    for (let i = 0; i < 500; ++i) {
      const x = Math.floor(random() * 9);
      if (random() < 0.6) store.apply(tile(0, x, 0, i, 1 + Math.floor(random() * 3)));
      else if (random() < 0.5) store.remove({ level: 0, x, y: 0 });
      else store.evict(new Set());
      expect(store.bytes).toBe(Array.from(store.all()).reduce((sum, one) => sum + one.planes.byteLength, 0));
    }
  });

  it('finds the column of a world point, left and below of the origin too', () => {
    expect(locate(0.001, 0.001, 0, 0.02)).toEqual({ key: { level: 0, x: 0, y: 0 }, column: 0 });
    expect(locate(-0.001, -0.001, 0, 0.02)).toEqual({ key: { level: 0, x: -1, y: -1 }, column: 64 * 64 - 1 });
    expect(locate(1.29, 0.03, 0, 0.02)).toEqual({ key: { level: 0, x: 1, y: 0 }, column: 64 });
    const store = new TileStore(1e9);
    const one = tile(0, -1, 0, 1, 2);
    one.planes.set([10, 20, 30, 40], BYTES_PER_LAYER + 4 * 63);
    store.apply(one);
    expect(columnAt(store, -0.01, 0.01, 0.02)?.[1]).toEqual({ E: 10 / 255, O: 20 / 255, K: 30 / 255, C: 40 / 255 });
    expect(columnAt(store, 5, 5, 0.02)).toBeUndefined();
  });

  it('lays tiles of every level edge to edge', () => {
    expect(tileRect({ level: 0, x: -1, y: 2 }, 0.02)).toEqual({ xMin: -1.28, yMin: 2.56, xMax: 0, yMax: 3.84 });
    expect(tileRect({ level: 1, x: 1, y: 0 }, 0.02)).toEqual({ xMin: 2.56, yMin: 0, xMax: 5.12, yMax: 2.56 });
  });
});
