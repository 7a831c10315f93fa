// The simulated session behind ?mock=1: walks, maps, and says what a server would say, in the server's own messages.

import { create, type MessageInitShape } from '@bufbuild/protobuf';
import { zlibSync } from 'fflate';
import { TileSchema, TrackingState, type MapInfoSchema, type Tile, type TrajectoryPointSchema } from '../gen/flogmap/v1/map_pb';
import { ImageStream, type ServerMessageSchema } from '../gen/flogmap/v1/stream_pb';
import { mapValue, motionValue, planningValue, conflictValue } from '../rules';
import { seededRandom } from '../seeded_random';
import { keyText, TILE_SIDE, type TileKey } from '../tile_store';
import { CELL_SIZE, EvidenceMap, FULL_CONFIDENCE_RAYS, LAYERS, planesOf } from './evidence';
import { shrinkInto } from './overview';
import { BASELINE, columnAzimuth, drawPictures, FOCAL, HEIGHT, MAX_DISPARITY, visibleCorners, WIDTH } from './picture';
import { hitsAlong, ROOM, standAt, type Stand } from './room';

export type Message = NonNullable<MessageInitShape<typeof ServerMessageSchema>['message']>;

const LEVELS = 4;
const MAX_RANGE_M = 4.5;
const MAP_EVERY = 3; // steps
export const STEP_MS = 100;

export class Simulation {
  paused = false;
  trajectory: MessageInitShape<typeof TrajectoryPointSchema>[] = [];
  readonly tiles = new Map<string, Tile>();
  private map = new EvidenceMap(seededRandom(1));
  private planes = new Map<string, { evidence: Uint8Array; change: Uint8Array }>(); // by tile and layer
  private epoch = newEpoch();
  private steps = 0;
  private mapped = 0;

  get rev(): bigint {
    return this.map.rev;
  }

  info(): MessageInitShape<typeof MapInfoSchema> {
    return {
      epoch: this.epoch, rev: this.rev, cellSize: CELL_SIZE, tileSize: TILE_SIDE, levels: LEVELS, minRays: 8,
      layers: LAYERS.map((layer) => ({ ...layer, fullConfidenceRays: FULL_CONFIDENCE_RAYS })),
    };
  }

  welcome(): Message {
    return {
      case: 'welcome',
      value: {
        version: 1, map: this.info(), role: 'control', serverVersion: 'simulated in this page',
        camera: { focalPx: FOCAL, cxPx: WIDTH / 2, cyPx: HEIGHT / 2, baselineM: BASELINE, widthPx: WIDTH, heightPx: HEIGHT },
      },
    };
  }

  reset(): Message {
    this.map = new EvidenceMap(seededRandom(1));
    this.tiles.clear();
    this.planes.clear();
    this.trajectory = [];
    this.epoch = newEpoch();
    this.mapped = 0;
    return { case: 'reset', value: { map: this.info(), reason: 'reset by operator' } };
  }

  /** One tenth of a second of walking; returns pose, path and, for a mapped view, the tiles that changed. */
  step(): { tiles: Tile[]; messages: Message[] } {
    const stand = this.stand();
    const mapped = this.steps++ % MAP_EVERY === 0;
    const timeNs = BigInt(this.steps) * BigInt(STEP_MS) * 1000000n;
    const point = { timeNs, pose: poseOf(stand), state: TrackingState.OK, mapped };
    this.trajectory.push(point);
    const messages: Message[] = [
      { case: 'trajectoryAppend', value: { first: BigInt(this.trajectory.length - 1), points: [point] } },
      { case: 'pose', value: { timeNs, state: TrackingState.OK, pose: point.pose, inliers: 86 + Math.round(20 * Math.sin(this.steps / 9)), ageMs: 31 } },
    ];
    return { tiles: mapped ? this.mapView(stand) : [], messages };
  }

  status(): Message {
    const wave = (middle: number): { medianMs: number; p95Ms: number } => ({ medianMs: middle * (1 + 0.06 * Math.sin(this.steps / 13 + middle)), p95Ms: middle * 1.4 });
    return {
      case: 'status',
      value: {
        sessionState: this.paused ? 'paused' : 'running', framesPerS: this.paused ? 0 : 10, frames: BigInt(this.steps), tracked: BigInt(this.steps),
        mappedViews: BigInt(this.mapped), tiles: BigInt(this.tiles.size), mapBytes: BigInt(this.map.tiles.size * LAYERS.length * 4096 * 8), viewers: 1, alignment: 'given',
        stages: [{ stage: 'read', ...wave(0.4) }, { stage: 'rectify', ...wave(1.6) }, { stage: 'disparity', ...wave(11.2) }, { stage: 'odometry', ...wave(5.8) }, { stage: 'map', ...wave(8.3) }],
        warnings: [],
      },
    };
  }

  column(x: number, y: number): Message {
    const layers = LAYERS.map(({ id }) => {
      const { E, O, N, C } = this.map.cellAt(id, x, y);
      const K = Math.min(1, N / FULL_CONFIDENCE_RAYS);
      return {
        layer: id, empty: E, occupied: O, confidence: K, rays: Math.round(N), change: C, value: mapValue('algebraic', E, O, K),
        planning: planningValue('algebraic', O, K), motion: motionValue('algebraic', E, O, K), conflict: conflictValue(E, O, K),
      };
    });
    return { case: 'cellColumn', value: { x, y, epoch: this.epoch, rev: this.rev, layers } };
  }

  features(): Message {
    const { current, key } = visibleCorners(this.stand(), standAt(this.seconds() - 0.5));
    const inlier = Array.from({ length: current.length / 2 }, (_, i) => (i * 7) % 11 !== 0);
    return { case: 'features', value: { timeNs: 0n, currentPx: current, keyPx: key, inlier, unmatchedPx: [] } };
  }

  /** Left picture and disparity as the server would send them. */
  async pictures(): Promise<Message[]> {
    const left = new OffscreenCanvas(WIDTH, HEIGHT);
    const disparity = new OffscreenCanvas(WIDTH, HEIGHT);
    const leftContext = left.getContext('2d');
    const disparityContext = disparity.getContext('2d');
    if (!leftContext || !disparityContext) return [];
    drawPictures(this.stand(), leftContext, disparityContext);
    const timeNs = BigInt(this.steps) * BigInt(STEP_MS) * 1000000n;
    const encode = async (canvas: OffscreenCanvas, stream: ImageStream, scaleMax: number): Promise<Message> => {
      const blob = await canvas.convertToBlob({ type: 'image/jpeg', quality: 0.8 });
      const data = new Uint8Array(await blob.arrayBuffer());
      return { case: 'imageFrame', value: { stream, timeNs, mediaType: 'image/jpeg', data, scaleMin: 0, scaleMax, width: WIDTH, height: HEIGHT, fullWidth: WIDTH, fullHeight: HEIGHT } };
    };
    return [await encode(left, ImageStream.LEFT, 0), await encode(disparity, ImageStream.DISPARITY, MAX_DISPARITY)];
  }

  private seconds(): number {
    return (this.steps * STEP_MS) / 1000;
  }

  private stand(): Stand {
    return standAt(this.seconds());
  }

  private mapView(stand: Stand): Tile[] {
    for (const layer of LAYERS) {
      const middle = (layer.zMin + layer.zMax) / 2;
      const boxes = ROOM.filter((b) => b.z0 < layer.zMax - 0.02 && b.z1 > Math.min(middle, layer.zMin + 0.1));
      for (let column = 0; column < WIDTH; column += 2) {
        const azimuth = columnAzimuth(stand, column);
        const range = hitsAlong(boxes, stand.x, stand.y, azimuth)[0]?.near ?? Infinity;
        this.map.addRay(layer.id, stand.x, stand.y, azimuth, range, MAX_RANGE_M);
      }
    }
    ++this.mapped;
    return this.encode(this.map.commit().map((tile) => tile.key));
  }

  /** Tiles of level 0 and the overview tiles above them, as messages. */
  private encode(keys: readonly TileKey[]): Tile[] {
    const changed = new Map<string, TileKey>();
    for (const key of keys) {
      const tile = this.map.tiles.get(keyText(key));
      if (tile) LAYERS.forEach((layer) => this.planes.set(`${keyText(key)}:${layer.id}`, planesOf(tile, layer.id)));
      changed.set(keyText(key), key);
    }
    let level: readonly TileKey[] = keys;
    for (let i = 1; i < LEVELS; ++i) level = this.shrink(level, changed);
    return [...changed.values()].map((key) => this.encodeTile(key));
  }

  private shrink(children: readonly TileKey[], changed: Map<string, TileKey>): TileKey[] {
    const parents = new Map<string, TileKey>();
    for (const child of children) {
      const parent = { level: child.level + 1, x: child.x >> 1, y: child.y >> 1 };
      parents.set(keyText(parent), parent);
      changed.set(keyText(parent), parent);
      for (const { id } of LAYERS) {
        const name = `${keyText(parent)}:${id}`;
        const planes = this.planes.get(name) ?? { evidence: new Uint8Array(3 * 4096), change: new Uint8Array(4096) };
        const from = this.planes.get(`${keyText(child)}:${id}`);
        if (from) shrinkInto(planes.evidence, from.evidence, (child.x & 1) === 1, (child.y & 1) === 1);
        this.planes.set(name, planes);
      }
    }
    return [...parents.values()];
  }

  private encodeTile(key: TileKey): Tile {
    const layers = LAYERS.map(({ id }) => {
      const planes = this.planes.get(`${keyText(key)}:${id}`);
      return {
        layer: id, planes: { case: 'evidence' as const, value: zlibSync(planes?.evidence ?? new Uint8Array(3 * 4096), { level: 1 }) },
        change: zlibSync(planes?.change ?? new Uint8Array(4096), { level: 1 }),
      };
    });
    const tile = create(TileSchema, { key: { ...key }, rev: this.rev, layers });
    this.tiles.set(keyText(key), tile);
    return tile;
  }
}

const newEpoch = (): string => `mock-${Math.random().toString(36).slice(2, 10)}`;

/** world_from_camera: x right, y down, z along the heading. */
export function poseOf({ x, y, z, heading }: Stand): { x: number; y: number; z: number; qx: number; qy: number; qz: number; qw: number } {
  const half = (heading - Math.PI / 2) / 2; // turn about the world's z after tipping the optical axis to +y
  const tip = -Math.PI / 4; // half of -90 degrees about x
  const [c, s, ct, st] = [Math.cos(half), Math.sin(half), Math.cos(tip), Math.sin(tip)];
  return { x, y, z, qx: c * st, qy: s * st, qz: s * ct, qw: c * ct };
}
