// window.__flog: what end-to-end tests look at. Read only.

import type { Page } from './page';
import { keyText } from './tile_store';
import type { WalkState } from './scene/walkthrough';

export interface TestHook {
  readonly rev: number;
  readonly epoch: string;
  readonly state: string;
  readonly fps: number;
  readonly trajectoryLength: number;
  readonly shownTiles: number;
  readonly walk: WalkState & { readonly position: readonly number[]; readonly yaw: number };
  /** When pictures of the map were drawn lately, ms. */
  readonly pictures: readonly number[];
  tiles(): number;
  /** Of tiles in memory, and of their textures on the graphics card. */
  readonly tileBytes: number;
  readonly textureBytes: number;
  /** Time of the newest pose, s. */
  readonly poseS: number;
  /** What the left picture was taken with. */
  readonly camera: { readonly focalPx: number; readonly cxPx: number; readonly cyPx: number; readonly widthPx: number; readonly heightPx: number } | null;
  /** Where the path begins and ends. */
  readonly path: readonly (readonly number[])[];
  keys(): string[];
  /** Of every tile held. */
  revisions(): [key: string, rev: number][];
  /** E, O, K, C per cell and layer as held, or null. */
  tile(level: number, x: number, y: number): { rev: number; planes: number[] } | null;
  /** CSS pixel of a world point on the canvas. */
  project(x: number, y: number, z?: number): { x: number; y: number };
  /** The same in the walkthrough; null behind the eye. */
  projectWalk(x: number, y: number, z: number): { x: number; y: number } | null;
}

export function installTestHook(page: Page): void {
  const { live, connection, view } = page;
  const hook: TestHook = {
    get rev() { return Number(live.rev); },
    get epoch() { return live.info?.epoch ?? ''; },
    get state() { return connection.state.phase; },
    get fps() { return view.fps; },
    get trajectoryLength() { return live.path.length; },
    get shownTiles() { return view.tiles.shown.length; },
    get walk() { return { ...page.walk.state, position: page.walk.walker.position, yaw: page.walk.walker.yaw }; },
    get pictures() { return view.picture.times; },
    tiles: () => live.tiles.count,
    get tileBytes() { return live.tiles.bytes; },
    get textureBytes() { return view.tiles.textureBytes; },
    get poseS() { return Number(live.pose?.timeNs ?? 0n) / 1e9; },
    get camera() { return live.camera; },
    get path() { return [live.path.at(0), live.path.at(-1)].map((point) => (point?.pose ? [point.pose.x, point.pose.y, point.pose.z] : [])); },
    keys: () => Array.from(live.tiles.all(), keyText),
    revisions: () => Array.from(live.tiles.all(), (tile) => [keyText(tile), Number(tile.rev)]),
    tile: (level, x, y) => {
      const tile = live.tiles.get({ level, x, y });
      return tile ? { rev: Number(tile.rev), planes: Array.from(tile.planes) } : null;
    },
    project: (x, y, z) => view.project(x, y, z),
    projectWalk: (x, y, z) => page.walk.project(x, y, z, view.viewport),
  };
  Object.assign(window, { __flog: hook });
}
