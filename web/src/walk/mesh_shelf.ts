// Loads meshes of views, the most wanted first, and keeps them within a budget of bytes.

import type { ViewMesh } from './glb';

export interface Loaded<T> {
  readonly number: number;
  readonly bytes: number;
  readonly drawable: T;
}

export interface ShelfParts<T> {
  fetch(number: number): Promise<ArrayBuffer>;
  /** Makes what is drawn of a file; undefined for a view without a surface. */
  make(file: ArrayBuffer): Promise<{ drawable: T; bytes: number } | undefined>;
  dispose(drawable: T): void;
  changed(): void;
}

const AT_ONCE = 3;
const TRIES_APART_MS = 4000;

/** Bytes of a mesh and its picture on the graphics card. */
export const meshBytes = (mesh: ViewMesh, pixels: number): number => mesh.positions.byteLength + mesh.texture.byteLength + mesh.indices.byteLength + 4 * pixels;

export class MeshShelf<T> {
  private readonly held = new Map<number, Loaded<T>>(); // least recently wanted first
  private readonly loading = new Set<number>();
  private readonly failed = new Map<number, number>(); // when to try again
  private wanted: readonly number[] = [];
  private total = 0;
  private generation = 0;

  constructor(private readonly parts: ShelfParts<T>, private readonly budget: number, private readonly now: () => number = () => performance.now()) {}

  get bytes(): number {
    return this.total;
  }

  get count(): number {
    return this.held.size;
  }

  /** Wanted, but still on its way. */
  get missing(): number {
    return this.wanted.filter((number) => !this.held.has(number) && (this.failed.get(number) ?? 0) === 0).length;
  }

  get(number: number): T | undefined {
    return this.held.get(number)?.drawable;
  }

  /** Says what is to be seen now, best first, and begins to load what is not there. */
  want(numbers: readonly number[]): void {
    this.wanted = numbers;
    for (const number of [...numbers].reverse()) {
      const here = this.held.get(number);
      if (!here) continue;
      this.held.delete(number);
      this.held.set(number, here);
    }
    this.loadMore();
  }

  /** Throws everything away: another map. */
  clear(): void {
    ++this.generation;
    for (const { drawable } of this.held.values()) this.parts.dispose(drawable);
    this.held.clear();
    this.loading.clear();
    this.failed.clear();
    this.wanted = [];
    this.total = 0;
  }

  private loadMore(): void {
    for (const number of this.wanted) {
      if (this.loading.size >= AT_ONCE) return;
      if (!this.held.has(number) && !this.loading.has(number) && (this.failed.get(number) ?? 0) <= this.now()) void this.load(number);
    }
  }

  private async load(number: number): Promise<void> {
    const { generation } = this;
    this.loading.add(number);
    try {
      const made = await this.parts.make(await this.parts.fetch(number));
      if (generation !== this.generation) return made && this.parts.dispose(made.drawable);
      if (made) this.keep({ number, ...made });
      else this.failed.set(number, Infinity); // nothing to see there
    } catch {
      if (generation === this.generation) this.failed.set(number, this.now() + TRIES_APART_MS);
    }
    if (generation !== this.generation) return;
    this.loading.delete(number);
    this.parts.changed();
    this.loadMore();
  }

  private keep(loaded: Loaded<T>): void {
    this.held.set(loaded.number, loaded);
    this.total += loaded.bytes;
    for (const [number, { bytes, drawable }] of this.held) {
      if (this.total <= this.budget || this.wanted.includes(number)) continue;
      this.held.delete(number);
      this.total -= bytes;
      this.parts.dispose(drawable);
    }
  }
}
