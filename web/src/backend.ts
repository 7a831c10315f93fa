// What the page asks the server for outside the stream: steering, routes, files. One implementation per kind of server.

import type { Level } from './level';
import type { MappedView, ViewCameraModel } from './walk/view_choice';

/** The mapped views that have a mesh. */
export interface ViewList {
  readonly epoch: string;
  readonly camera: ViewCameraModel;
  readonly views: readonly MappedView[];
}

export interface PlaybackChange {
  readonly position_s?: number;
  readonly rate?: number;
  readonly paused?: boolean;
}

export interface Route {
  readonly points: readonly { readonly x: number; readonly y: number }[];
  readonly lengthM: number;
  readonly clearanceM: number;
}

/** What goes through the map; height 0: every layer counts. */
export interface Robot {
  readonly radiusM: number;
  readonly heightM: number;
}

/** Cells that a robot can get to: runs of not reached, reached, not ..., row by row from the lowest y. */
export interface Reach {
  readonly x: number; // lower left corner, metres
  readonly y: number;
  readonly cellSize: number;
  readonly width: number;
  readonly height: number;
  readonly runs: readonly number[];
  readonly areaM2: number;
}

export interface Backend {
  pause(): Promise<void>;
  resume(): Promise<void>;
  reset(): Promise<void>;
  changePlayback(change: PlaybackChange): Promise<void>;
  step(): Promise<void>;
  /** How the map is levelled by hand, and why it cannot be now (empty: it can). */
  level(): Promise<{ level: Level; obstacle: string }>;
  setLevel(level: Level): Promise<void>;
  /** From a spot, or from where the camera is now. */
  route(from: Spot | undefined, to: Spot, robot: Robot): Promise<Route>;
  reach(from: Spot | undefined, robot: Robot): Promise<Reach>;
  views(): Promise<ViewList>;
  viewMesh(number: number): Promise<ArrayBuffer>;
  /** Addresses to open or copy; undefined where there is no such server. */
  exportUrl(format: string): string | undefined;
  cellUrl(x: number, y: number): string | undefined;
}

export interface Spot {
  readonly x: number;
  readonly y: number;
}

/** Why the server said no, in its own words. */
export class Refusal extends Error {}

type Fetch = (input: string, init?: RequestInit) => Promise<Response>;

/** The REST interface under `base`, for instance "http://host/api/v1/". */
export function restBackend(base: string, ask: Fetch = (input, init) => fetch(input, init)): Backend {
  const send = async (method: string, path: string, body?: unknown): Promise<unknown> => {
    const init: RequestInit = { method, ...(body === undefined ? {} : { body: JSON.stringify(body), headers: { 'Content-Type': 'application/json' } }) };
    const response = await ask(base + path, init).catch(() => {
      throw new Refusal('the server cannot be reached');
    });
    const answer: unknown = await response.json().catch(() => ({}));
    if (!response.ok) throw new Refusal(wordsOf(answer) ?? `the server answered ${response.status}`);
    return answer;
  };
  const post = async (path: string): Promise<void> => void (await send('POST', path));
  return {
    pause: () => post('session:pause'),
    resume: () => post('session:resume'),
    reset: () => post('session:reset'),
    step: () => post('playback:step'),
    level: async () => levelFrom(await send('GET', 'session')),
    setLevel: async ({ roll, pitch, yaw, height }) => void (await send('POST', 'session:level', { roll_deg: roll, pitch_deg: pitch, yaw_deg: yaw, height_m: height })),
    changePlayback: async (change) => void (await send('PATCH', 'playback', change)),
    route: async (from, to, robot) => routeFrom(await send('POST', 'maps/live/route', { from: startOf(from), to: [to.x, to.y], ...sizeOf(robot) })),
    reach: async (from, robot) => reachFrom(await send('POST', 'maps/live/reachable', { from: startOf(from), ...sizeOf(robot) })),
    views: async () => viewsFrom(await send('GET', 'maps/live/views')),
    viewMesh: async (number) => {
      const response = await ask(`${base}maps/live/views/${number}.glb`);
      if (!response.ok) throw new Refusal(`view ${number} cannot be had: ${response.status}`);
      return response.arrayBuffer();
    },
    exportUrl: (format) => `${base}maps/live/export?format=${format}`,
    cellUrl: (x, y) => `${base}maps/live/cell?x=${x.toFixed(3)}&y=${y.toFixed(3)}`,
  };
}

function wordsOf(problem: unknown): string | undefined {
  const { detail, title } = (problem ?? {}) as { detail?: unknown; title?: unknown };
  return typeof detail === 'string' && detail ? detail : typeof title === 'string' ? title : undefined;
}

function startOf(from: Spot | undefined): number[] | 'camera' {
  return from ? [from.x, from.y] : 'camera';
}

function routeFrom(answer: unknown): Route {
  const { points, path, length_m, clearance_m } = answer as Record<string, unknown>;
  const list = (Array.isArray(points) ? points : Array.isArray(path) ? path : []) as unknown[];
  return {
    points: list.map((p) => (Array.isArray(p) ? { x: Number(p[0]), y: Number(p[1]) } : { x: Number((p as Spot).x), y: Number((p as Spot).y) })),
    lengthM: Number(length_m ?? 0),
    clearanceM: Number(clearance_m ?? 0),
  };
}

function levelFrom(answer: unknown): { level: Level; obstacle: string } {
  const { level } = answer as { level: { roll_deg: number; pitch_deg: number; yaw_deg: number; height_m: number; obstacle: string | null } };
  return { level: { roll: level.roll_deg, pitch: level.pitch_deg, yaw: level.yaw_deg, height: level.height_m }, obstacle: level.obstacle ?? '' };
}

function viewsFrom(answer: unknown): ViewList {
  const { epoch, camera, views } = answer as { epoch: string; camera: Record<string, number>; views: { number: number; time_ns: string; position: [number, number, number]; orientation_xyzw: [number, number, number, number] }[] };
  const of = (name: string): number => camera[name] ?? 0;
  return {
    epoch, camera: { focalPx: of('focal_px'), cxPx: of('cx_px'), cyPx: of('cy_px'), widthPx: of('width_px'), heightPx: of('height_px') },
    views: views.map(({ number, time_ns, position, orientation_xyzw: [qx, qy, qz, qw] }) => ({ number, timeNs: BigInt(time_ns), position, orientation: { qx, qy, qz, qw } })),
  };
}

const sizeOf = ({ radiusM, heightM }: Robot): Record<string, number> => ({ robot_radius_m: radiusM, robot_height_m: heightM });

function reachFrom(answer: unknown): Reach {
  const { origin, cell_size, width, height, runs, area_m2 } = answer as { origin: [number, number]; cell_size: number; width: number; height: number; runs: number[]; area_m2: number };
  return { x: origin[0], y: origin[1], cellSize: cell_size, width, height, runs, areaM2: area_m2 };
}
