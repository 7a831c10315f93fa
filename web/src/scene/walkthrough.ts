// First person through the map: the walker's eye, the meshes that show best what it sees, and the map as the floor.

import { Group, PerspectiveCamera, Vector3 } from 'three';
import type { Backend, ViewList } from '../backend';
import type { LiveMap } from '../live_map';
import { classify, seenFromConfidence } from '../rules';
import { Signal } from '../signal';
import { columnAt } from '../tile_store';
import { readGlb } from '../walk/glb';
import { meshBytes, MeshShelf } from '../walk/mesh_shelf';
import { chooseViews, type MappedView } from '../walk/view_choice';
import { eyeOf, isMoving, rideAt, rideTimes, STANDING, standingAt, step, type Walker, type Wish } from '../walk/walker';
import { DrawableView, showViews } from './view_meshes';

const FIELD_OF_VIEW = 62; // degrees, vertical
const MESHES = 8; // at once
const CHOOSE_EVERY_M = 0.08;
const CHOOSE_EVERY_RAD = 0.06;
const ASK_EVERY_MS = 3000; // for new views, and for corrected poses
const BODY_M = 1.8; // what stands higher is no wall to a walker
const THRESHOLD = 0.3;
const RIDE_STEP_S = 1; // a page that was hidden does not leap
const BELOW_FLOOR_M = 0.13; // the map lies under the meshes' own floor, else the two would flicker

export interface WalkState {
  readonly views: number;
  readonly shown: number;
  readonly missing: number;
  readonly bytes: number;
  readonly rideS: number;
  readonly rideOfS: number;
  readonly riding: boolean;
}

export class Walkthrough {
  readonly group = new Group();
  readonly camera = new PerspectiveCamera(FIELD_OF_VIEW, 1, 0.03, 200);
  readonly changed = new Signal<void>();
  walker: Walker = { position: [0, 0, 1.5], yaw: 0, pitch: 0 };
  wish: Wish = STANDING;
  flies = true;
  solidWalls = false;
  private list: ViewList | null = null;
  private chosen: readonly MappedView[] = [];
  private chosenFor: Walker | null = null;
  private ride = { on: false, seconds: 0, times: [] as number[] };
  private rodeAt = 0; // ms
  private active = false;
  private timer = 0;
  private readonly shelf: MeshShelf<DrawableView>;

  constructor(private readonly live: LiveMap, private readonly backend: Backend, budgetBytes: number, private readonly draw: () => void) {
    this.shelf = new MeshShelf<DrawableView>({
      fetch: (number) => backend.viewMesh(number), make: drawableOf, dispose: (drawable) => drawable.dispose(), changed: () => this.refresh(),
    }, budgetBytes);
    live.begun.on(() => this.begin());
    live.trajectoryChanged.on(() => { if (this.active) this.ride.times = rideTimes(live.path); });
  }

  get state(): WalkState {
    return {
      views: this.list?.views.length ?? 0, shown: this.group.children.length, missing: this.shelf.missing, bytes: this.shelf.bytes,
      rideS: this.ride.seconds, rideOfS: this.ride.times.at(-1) ?? 0, riding: this.ride.on,
    };
  }

  /** Height of the map's floor under the meshes. */
  get floor(): number {
    return (this.live.info?.layers[0]?.zMin ?? 0) - BELOW_FLOOR_M;
  }

  /** Steps into the map where the camera is now; rejects where there are no views. */
  async enter(): Promise<void> {
    await this.ask();
    this.ride.times = rideTimes(this.live.path);
    const pose = this.live.pose?.pose ?? this.live.path.at(-1)?.pose;
    if (pose) this.walker = standingAt(pose);
    else if (this.list?.views[0]) this.standAtView(this.list.views[0]);
    this.active = true;
    this.timer = window.setInterval(() => void this.ask().catch(() => {}), ASK_EVERY_MS); // what is wrong is told by the connection
    this.refresh();
  }

  leave(): void {
    this.active = false;
    this.ride.on = false;
    this.wish = STANDING;
    clearInterval(this.timer);
  }

  rideTo(seconds: number, on = this.ride.on): void {
    const end = this.ride.times.at(-1) ?? 0;
    this.ride = { ...this.ride, on, seconds: Math.min(end, Math.max(0, seconds)) };
    this.walker = rideAt(this.live.path, this.ride.times, this.ride.seconds) ?? this.walker;
    this.refresh();
  }

  /** Starts or stops the ride; at the end it starts over. */
  toggleRide(): void {
    const end = this.ride.times.at(-1) ?? 0;
    this.rodeAt = performance.now();
    this.rideTo(this.ride.seconds >= end - 0.05 ? 0 : this.ride.seconds, !this.ride.on);
  }

  /** One picture's worth of time; true while there is more to come. */
  frame(seconds: number, aspect: number): boolean {
    if (isMoving(this.wish)) this.ride.on = false;
    if (this.ride.on) this.advanceRide();
    else if (isMoving(this.wish)) this.walker = step(this.walker, this.wish, seconds, this.flies, this.ground);
    this.aim(aspect);
    this.choose();
    return this.ride.on || isMoving(this.wish);
  }

  /** CSS pixel of a world point; null behind the eye. */
  project(x: number, y: number, z: number, { width, height }: { readonly width: number; readonly height: number }): { x: number; y: number } | null {
    const p = new Vector3(x, y, z).project(this.camera);
    return p.z > 1 ? null : { x: ((p.x + 1) / 2) * width, y: ((1 - p.y) / 2) * height };
  }

  /** As fast as it was recorded, however seldom pictures are drawn. */
  private advanceRide(): void {
    const end = this.ride.times.at(-1) ?? 0;
    const now = performance.now();
    const seconds = Math.min(RIDE_STEP_S, (now - this.rodeAt) / 1000);
    this.rodeAt = now;
    this.ride.seconds = Math.min(end, this.ride.seconds + seconds);
    this.walker = rideAt(this.live.path, this.ride.times, this.ride.seconds) ?? this.walker;
    if (this.ride.seconds >= end) this.ride.on = false;
    this.changed.emit();
  }

  private aim(aspect: number): void {
    const { position, forward } = eyeOf(this.walker);
    this.camera.aspect = aspect;
    this.camera.up.set(0, 0, 1);
    this.camera.position.set(...position);
    this.camera.lookAt(new Vector3(...position).add(new Vector3(...forward)));
    this.camera.updateProjectionMatrix();
    this.camera.updateMatrixWorld();
  }

  private readonly ground = {
    blocked: (x: number, y: number): boolean => {
      const { info, tiles } = this.live;
      const column = this.solidWalls && info ? columnAt(tiles, x, y, info.cellSize) : undefined;
      return column?.some((evidence, i) => {
        const layer = info?.layers[i];
        return layer !== undefined && layer.zMin < this.floor + BODY_M && classify('visual', 'algebraic', evidence, seenFromConfidence(info?.minRays ?? 8, layer.fullConfidenceRays), THRESHOLD) === 'occupied';
      }) ?? false;
    },
    eyeHeight: (x: number, y: number): number => {
      const away = (view: MappedView): number => Math.hypot(view.position[0] - x, view.position[1] - y);
      const near = this.list?.views.reduce((a, b) => (away(b) < away(a) ? b : a), this.list.views[0] as MappedView);
      return near?.position[2] ?? this.walker.position[2];
    },
  };

  private begin(): void {
    this.shelf.clear();
    this.group.clear();
    this.list = null;
    this.chosen = [];
    this.ride = { on: false, seconds: 0, times: [] };
    if (this.active) void this.ask().catch(() => {});
  }

  private async ask(): Promise<void> {
    const list = await this.backend.views();
    if (list.epoch !== this.live.info?.epoch) return;
    const first = !this.list?.views.length && list.views.length > 0;
    this.list = list;
    if (first && this.active) this.standAtView(list.views[0] as MappedView);
    this.refresh();
  }

  private standAtView(view: MappedView): void {
    const { position: [x, y, z], orientation } = view;
    this.walker = standingAt({ $typeName: 'flogmap.v1.PoseValue', x, y, z, ...orientation });
  }

  /** Chooses anew when the eye has moved on. */
  private choose(): void {
    const before = this.chosenFor;
    const { position, yaw, pitch } = this.walker;
    const still = before && Math.hypot(...position.map((p, i) => p - (before.position[i] ?? 0))) < CHOOSE_EVERY_M && Math.abs(yaw - before.yaw) + Math.abs(pitch - before.pitch) < CHOOSE_EVERY_RAD;
    if (!still) this.chooseNow();
  }

  private chooseNow(): void {
    if (!this.list) return;
    this.chosenFor = this.walker;
    this.chosen = chooseViews(this.list.views, this.list.camera, eyeOf(this.walker), MESHES);
    this.shelf.want(this.chosen.map(({ number }) => number));
    this.show();
  }

  /** What of the chosen has come; until then, whatever was shown before stays by being near enough. */
  private show(): void {
    showViews(this.group, this.chosen.flatMap((view): [MappedView, DrawableView][] => {
      const drawable = this.shelf.get(view.number);
      return drawable ? [[view, drawable]] : [];
    }));
    this.changed.emit();
  }

  private refresh(): void {
    if (this.active) this.chooseNow();
    this.draw();
    this.changed.emit();
  }
}

async function drawableOf(file: ArrayBuffer): Promise<{ drawable: DrawableView; bytes: number } | undefined> {
  const mesh = readGlb(file);
  if (!mesh) return undefined;
  const bitmap = await createImageBitmap(new Blob([mesh.jpeg], { type: 'image/jpeg' }));
  return { drawable: new DrawableView(mesh, bitmap), bytes: meshBytes(mesh, bitmap.width * bitmap.height) };
}
