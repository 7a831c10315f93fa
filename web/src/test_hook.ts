// window.__flog: what end-to-end tests look at. Read only.

import type { Page } from './page';

export interface TestHook {
  readonly rev: number;
  readonly epoch: string;
  readonly state: string;
  readonly fps: number;
  readonly trajectoryLength: number;
  readonly shownTiles: number;
  tiles(): number;
  keys(): string[];
  /** E, O, K, C per cell and layer as held, or null. */
  tile(level: number, x: number, y: number): { rev: number; planes: number[] } | null;
  /** CSS pixel of a world point on the canvas. */
  project(x: number, y: number, z?: number): { x: number; y: number };
}

export function installTestHook(page: Page): void {
  const { live, connection, view } = page;
  const hook: TestHook = {
    get rev() { return Number(live.rev); },
    get epoch() { return live.info?.epoch ?? ''; },
    get state() { return connection.state.phase; },
    get fps() { return view.fps; },
    get trajectoryLength() { return live.trajectory.length; },
    get shownTiles() { return view.shown.length; },
    tiles: () => live.tiles.count,
    keys: () => Array.from(live.tiles.all(), (tile) => `${tile.level}/${tile.x}/${tile.y}`),
    tile: (level, x, y) => {
      const tile = live.tiles.get({ level, x, y });
      return tile ? { rev: Number(tile.rev), planes: Array.from(tile.planes) } : null;
    },
    project: (x, y, z) => view.project(x, y, z),
  };
  Object.assign(window, { __flog: hook });
}
