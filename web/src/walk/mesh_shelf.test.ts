import { describe, expect, it } from 'vitest';
import { MeshShelf } from './mesh_shelf';

interface Bench {
  readonly shelf: MeshShelf<string>;
  readonly asked: number[];
  readonly disposed: string[];
  settle(): Promise<void>;
  clock: number;
}

function bench(budget: number, fails: (number: number) => boolean = () => false): Bench {
  const asked: number[] = [];
  const disposed: string[] = [];
  const box = { clock: 0 };
  const shelf = new MeshShelf<string>({
    fetch: (number) => { asked.push(number); return fails(number) ? Promise.reject(new Error('gone')) : Promise.resolve(new ArrayBuffer(number)); },
    make: (file) => Promise.resolve(file.byteLength === 0 ? undefined : { drawable: `mesh ${file.byteLength}`, bytes: 10 }),
    dispose: (drawable) => disposed.push(drawable), changed: () => {},
  }, budget, () => box.clock);
  return { shelf, asked, disposed, settle: () => new Promise((resolve) => { setTimeout(resolve, 5); }), get clock() { return box.clock; }, set clock(value) { box.clock = value; } };
}

describe('MeshShelf', () => {
  it('loads the most wanted first, a few at once, and in the end all', async () => {
    const { shelf, asked, settle } = bench(1000);
    shelf.want([5, 3, 9, 1, 7]);
    expect(asked).toEqual([5, 3, 9]);
    await settle();
    expect(shelf.count).toBe(5);
    expect(shelf.missing).toBe(0);
  });

  it('stays within its budget and never drops what is wanted now', async () => {
    const { shelf, disposed, settle } = bench(30);
    for (let n = 1; n <= 12; n += 3) {
      shelf.want([n, n + 1, n + 2]);
      await settle();
      expect(shelf.bytes).toBeLessThanOrEqual(30);
      expect(shelf.get(n)).toBe(`mesh ${n}`);
    }
    expect(disposed).toHaveLength(9);
  });

  it('tries again later what could not be loaded, and never what has no surface', async () => {
    const box = bench(1000, (number) => number === 4);
    box.shelf.want([4, 0]);
    await box.settle();
    box.shelf.want([4, 0]);
    await box.settle();
    expect(box.asked).toEqual([4, 0]);
    box.clock = 10_000;
    box.shelf.want([4, 0]);
    await box.settle();
    expect(box.asked).toEqual([4, 0, 4]);
  });

  it('forgets another map’s meshes, also those on their way', async () => {
    const { shelf, disposed, settle } = bench(1000);
    shelf.want([1, 2]);
    shelf.clear();
    await settle();
    expect(shelf.count).toBe(0);
    expect(disposed).toEqual(['mesh 1', 'mesh 2']);
  });
});
