// All that the page knows of the running map: takes the stream's events over and tells who draws what has changed.

import type { ImageEvent, StreamEvent } from './decode';
import type { MapInfo, TrajectoryPoint } from './gen/flogmap/v1/map_pb';
import type { CameraModel, CellColumn, Features, ImageStream, Playback, Pose, Status } from './gen/flogmap/v1/stream_pb';
import { Path } from './path';
import { Signal } from './signal';
import { TileStore, type TileKey } from './tile_store';
import type { Rect } from './viewport';
import type { Light } from './warnings';

export interface Notice {
  readonly tone: 'info' | 'warning';
  readonly text: string;
}

export class LiveMap {
  info: MapInfo | null = null;
  camera: CameraModel | null = null;
  role = 'view';
  serverVersion = '';
  rev = 0n;
  pose: Pose | null = null;
  readonly path = new Path();
  status: Status | null = null;
  playback: Playback | null = null;
  features: Features | null = null;
  column: CellColumn | null = null;
  /** How light the pictures are, looked at once a second. */
  readonly lights = new Map<ImageStream, Light>();
  readonly images = new Map<ImageStream, ImageEvent & { readonly receivedAt: number }>();

  /** Another map begins: everything that was drawn is void. */
  readonly begun = new Signal<MapInfo>();
  readonly tilesChanged = new Signal<{ readonly applied: readonly TileKey[]; readonly removed: readonly TileKey[] }>();
  readonly trajectoryChanged = new Signal<{ readonly from: number }>();
  readonly poseChanged = new Signal<Pose>();
  readonly imageChanged = new Signal<ImageStream>();
  readonly featuresChanged = new Signal<Features>();
  readonly statusChanged = new Signal<Status>();
  readonly playbackChanged = new Signal<Playback>();
  readonly columnChanged = new Signal<CellColumn>();
  readonly noticed = new Signal<Notice>();

  constructor(readonly tiles: TileStore) {}

  /** What the map covers, metres; nothing before there is a tile. */
  get bounds(): Rect | undefined {
    return this.info ? this.tiles.bounds(this.info.cellSize) : undefined;
  }

  take(event: StreamEvent): void {
    if (event.kind === 'tiles') this.takeTiles(event);
    else if (event.kind === 'image') {
      this.images.set(event.stream, { ...event, receivedAt: performance.now() });
      this.imageChanged.emit(event.stream);
    } else if (event.kind === 'message') this.takeMessage(event.message);
  }

  private takeTiles(event: Extract<StreamEvent, { kind: 'tiles' }>): void {
    const applied = event.tiles.filter((tile) => this.tiles.apply(tile));
    const removed = event.removed.filter((key) => this.tiles.remove(key));
    if (event.rev > this.rev) this.rev = event.rev;
    this.tilesChanged.emit({ applied, removed });
  }

  private takeMessage(message: Extract<StreamEvent, { kind: 'message' }>['message']): void {
    switch (message.case) {
      case 'welcome':
        this.camera = message.value.camera ?? null;
        this.role = message.value.role;
        this.serverVersion = message.value.serverVersion;
        if (message.value.map && message.value.map.epoch !== this.info?.epoch) this.begin(message.value.map);
        break;
      case 'reset':
        if (message.value.map) this.begin(message.value.map);
        if (message.value.reason) this.noticed.emit({ tone: 'info', text: `A new map begins: ${message.value.reason}.` });
        break;
      case 'pose': this.poseChanged.emit((this.pose = message.value)); break;
      case 'trajectoryAppend': this.putPath(Number(message.value.first), message.value.points); break;
      case 'trajectoryRewrite':
        this.putPath(0, message.value.points);
        if (message.value.reason) this.noticed.emit({ tone: 'info', text: `The path was corrected: ${message.value.reason}.` });
        break;
      case 'features': this.featuresChanged.emit((this.features = message.value)); break;
      case 'status': this.statusChanged.emit((this.status = message.value)); break;
      case 'playback': this.playbackChanged.emit((this.playback = message.value)); break;
      case 'cellColumn': this.columnChanged.emit((this.column = message.value)); break;
      case 'problem': this.noticed.emit({ tone: 'warning', text: message.value.detail || message.value.code }); break;
    }
  }

  private begin(info: MapInfo): void {
    this.info = info;
    this.rev = info.rev;
    this.tiles.clear();
    this.path.put(0, []);
    this.pose = this.column = this.features = null;
    this.begun.emit(info);
    this.trajectoryChanged.emit({ from: 0 });
  }

  /** Points that are here already are overwritten; a gap (never sent by a sound server) is refused. */
  private putPath(first: number, points: readonly TrajectoryPoint[]): void {
    if (first > this.path.length) return;
    this.path.put(first, points);
    this.trajectoryChanged.emit({ from: first });
  }
}
