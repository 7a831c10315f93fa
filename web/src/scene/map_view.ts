// The map on screen. Holds the viewport, draws at most once per animation frame and only when something changed.

import { Color, Mesh, Scene, WebGLRenderer } from 'three';
import { heading } from '../geometry';
import type { LiveMap } from '../live_map';
import { classColours, cssColour, type Theme } from '../palette';
import type { Settings } from '../settings';
import { Signal, type Store } from '../signal';
import { tilesToDraw, type Tile, type TileKey } from '../tile_store';
import { fit, levelFor, pan, visibleRect, wrapAngle, zoomAt, type Point, type Rect, type Viewport } from '../viewport';
import { CameraMarker } from './camera_marker';
import { GridLines } from './grid_lines';
import { applySettings, groundMaterial, mapUniforms, type MapUniforms } from './map_material';
import { PathLine } from './path_line';
import { TileMeshes, unitQuad } from './tile_meshes';
import { TilePages } from './tile_pages';
import { ViewCamera } from './view_camera';

const FIT_MARGIN_PX = 48;
const EASE_PER_S = 9; // how fast the view follows

export class MapView {
  viewport: Viewport = { x: 0, y: 0, scale: 80, turn: 0, width: 800, height: 600 };
  fps = 0;
  readonly eye = new ViewCamera();
  /** After every picture: overlays move with it. */
  readonly drawn = new Signal<Viewport>();
  /** The part of the world that is shown has changed. */
  readonly moved = new Signal<Viewport>();
  readonly canvas: HTMLCanvasElement;
  shown: readonly Tile[] = [];

  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly uniforms: MapUniforms = mapUniforms();
  private readonly path = new PathLine();
  private readonly marker = new CameraMarker();
  private readonly grid = new GridLines();
  private pages: TilePages | null = null;
  private tiles: TileMeshes | null = null;
  private readonly dirty = new Map<string, Tile>();
  private scheduled = false;
  private stale = { tiles: true, path: true, settings: true };
  private target: Viewport | null = null;
  private lastFrame = 0;
  private touchedByUser = false;
  private theme: Theme = 'dark';

  constructor(private readonly holder: HTMLElement, private readonly live: LiveMap, private readonly settings: Store<Settings>) {
    this.renderer = new WebGLRenderer({ antialias: true, powerPreference: 'high-performance' });
    this.canvas = this.renderer.domElement;
    this.canvas.tabIndex = 0;
    holder.prepend(this.canvas);
    const ground = new Mesh(unitQuad(), groundMaterial(this.uniforms));
    ground.frustumCulled = false;
    ground.renderOrder = -10;
    this.scene.add(ground, this.grid.mesh, this.path.group, this.marker.group);
    new ResizeObserver(() => this.resize()).observe(holder);
    this.resize();
    this.listen();
  }

  /** What stays the same: the marker of the person's own moves. */
  get wasMoved(): boolean {
    return this.touchedByUser;
  }

  setTheme(theme: Theme): void {
    this.theme = theme;
    this.stale.settings = true;
    this.requestDraw();
  }

  requestDraw(): void {
    if (this.scheduled) return;
    this.scheduled = true;
    requestAnimationFrame((now) => this.draw(now));
  }

  /** Moves the view by hand: it stays where the person puts it. */
  moveTo(view: Viewport): void {
    this.touchedByUser = true;
    this.target = null;
    if (this.settings.get().follow !== 'free' && Math.hypot(view.x - this.viewport.x, view.y - this.viewport.y) * view.scale > 1) this.settings.set({ follow: 'free' });
    this.setViewport(view);
  }

  panBy(dx: number, dy: number): void {
    this.moveTo(pan(this.viewport, dx, dy));
  }

  /** Zooms about a pixel; about the camera while the view follows it. */
  zoomBy(factor: number, pixel?: Point): void {
    const middle = { x: this.viewport.width / 2, y: this.viewport.height / 2 };
    const following = this.settings.get().follow !== 'free';
    this.moveTo(zoomAt(this.viewport, factor, following || !pixel ? middle : pixel));
  }

  /** Glides to a view. */
  glideTo(view: Viewport): void {
    this.target = { ...view, width: this.viewport.width, height: this.viewport.height };
    this.requestDraw();
  }

  /** Shows the whole map. */
  fitMap(): void {
    const rect = this.mapRect();
    this.touchedByUser = false;
    if (rect) this.glideTo(fit({ ...this.viewport, turn: 0 }, rect, FIT_MARGIN_PX));
  }

  /** Shows a bookmarked part of the world at once. */
  restore(x: number, y: number, scale: number, turn: number): void {
    this.touchedByUser = true;
    this.setViewport({ ...this.viewport, x, y, scale, turn });
  }

  pick(pixel: Point): Point | undefined {
    return this.eye.pick(this.viewport, pixel);
  }

  project(x: number, y: number, z = 0): Point {
    return this.eye.project(this.viewport, x, y, z);
  }

  private listen(): void {
    this.live.begun.on(() => this.begin());
    this.live.tilesChanged.on(({ applied, removed }) => this.changeTiles(applied, removed));
    this.live.trajectoryChanged.on(() => this.mark('path'));
    this.live.poseChanged.on(() => {
      this.follow();
      this.requestDraw();
    });
    this.settings.changed.on(({ now, before }) => {
      if (now.follow !== before.follow) this.follow();
      this.stale.path = this.stale.settings = this.stale.tiles = true;
      this.requestDraw();
    });
    this.canvas.addEventListener('webglcontextrestored', () => this.begin());
  }

  private mark(what: 'tiles' | 'path'): void {
    this.stale[what] = true;
    this.requestDraw();
  }

  private begin(): void {
    this.tiles?.dispose();
    this.pages?.dispose();
    if (this.tiles) this.scene.remove(this.tiles.group);
    this.pages = new TilePages(this.renderer, Math.max(1, this.live.info?.layers.length ?? 1));
    this.tiles = new TileMeshes(this.pages, this.uniforms);
    this.scene.add(this.tiles.group);
    this.dirty.clear();
    for (const tile of this.live.tiles.all()) this.dirty.set(`${tile.level}/${tile.x}/${tile.y}`, tile);
    this.marker.group.visible = false;
    this.stale = { tiles: true, path: true, settings: true };
    this.requestDraw();
  }

  private changeTiles(applied: readonly TileKey[], removed: readonly TileKey[]): void {
    for (const key of applied) {
      const tile = this.live.tiles.get(key);
      if (tile) this.dirty.set(`${key.level}/${key.x}/${key.y}`, tile);
    }
    this.release(removed);
    const rect = this.touchedByUser || this.settings.get().follow !== 'free' ? undefined : this.mapRect();
    if (rect) this.glideTo(fit(this.viewport, rect, FIT_MARGIN_PX));
    this.mark('tiles');
  }

  /** Frees what the tiles hold on the graphics card. */
  release(keys: readonly TileKey[]): void {
    for (const key of keys) {
      this.dirty.delete(`${key.level}/${key.x}/${key.y}`);
      this.pages?.release(key);
    }
    this.stale.tiles = true;
  }

  private mapRect(): Rect | undefined {
    return this.live.info ? this.live.tiles.bounds(this.live.info.cellSize) : undefined;
  }

  private follow(): void {
    const { follow } = this.settings.get();
    const pose = this.live.pose?.pose;
    if (follow === 'free' || !pose) return;
    const turn = follow === 'heading' ? wrapAngle(heading(pose) - Math.PI / 2) : 0;
    this.glideTo({ ...this.viewport, scale: this.target?.scale ?? this.viewport.scale, x: pose.x, y: pose.y, turn });
  }

  private setViewport(view: Viewport): void {
    this.viewport = view;
    this.stale.tiles = true;
    this.moved.emit(view);
    this.requestDraw();
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.holder;
    if (width === 0 || height === 0) return;
    this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio));
    this.renderer.setSize(width, height);
    this.path.resize(width, height);
    this.setViewport({ ...this.viewport, width, height });
    if (this.target) this.target = { ...this.target, width, height };
    if (!this.touchedByUser) this.fitMap();
  }

  private draw(now: number): void {
    this.scheduled = false;
    const seconds = Math.min(0.1, (now - this.lastFrame) / 1000);
    if (seconds > 0) this.fps = this.fps * 0.9 + 0.1 / Math.max(seconds, 1e-3);
    this.lastFrame = now;
    this.glide(seconds);
    this.upload();
    this.refresh();
    this.eye.solid = this.settings.get().solid;
    this.eye.update(this.viewport);
    this.grid.update(this.viewport, this.eye.solid);
    this.renderer.render(this.scene, this.eye.camera);
    this.drawn.emit(this.viewport);
  }

  private glide(seconds: number): void {
    if (!this.target) return;
    const t = matchMedia('(prefers-reduced-motion: reduce)').matches ? 1 : 1 - Math.exp(-EASE_PER_S * seconds);
    const { viewport: from, target: to } = this;
    const next = {
      ...from, x: from.x + (to.x - from.x) * t, y: from.y + (to.y - from.y) * t,
      scale: from.scale * (to.scale / from.scale) ** t, turn: wrapAngle(from.turn + wrapAngle(to.turn - from.turn) * t),
    };
    const left = Math.max(Math.hypot(to.x - next.x, to.y - next.y) * next.scale, Math.abs(to.scale / next.scale - 1) * 300, Math.abs(wrapAngle(to.turn - next.turn)) * 300);
    if (left < 0.4) this.target = null;
    this.setViewport(this.target ? next : { ...to, width: from.width, height: from.height });
  }

  private upload(): void {
    if (!this.pages) return;
    for (const tile of this.dirty.values()) this.pages.upload(tile);
    this.dirty.clear();
  }

  private refresh(): void {
    const settings = this.settings.get();
    const { info } = this.live;
    if (this.stale.settings) this.refreshColours(settings);
    if (this.stale.tiles && info && this.tiles) {
      this.shown = tilesToDraw(this.live.tiles, visibleRect(this.viewport), levelFor(this.viewport, info.cellSize, info.levels, this.renderer.getPixelRatio()), info.cellSize);
      this.tiles.show(this.shown, info.cellSize);
    }
    if (this.stale.path) this.path.update(settings.showPath ? this.live.trajectory : [], settings.pathBy);
    this.stale = { tiles: false, path: false, settings: false };
    const pose = this.live.pose;
    if (pose?.pose) {
      this.marker.setState(pose.state);
      this.marker.place(pose.pose, this.live.camera, this.viewport.scale, settings.solid);
    }
  }

  private refreshColours(settings: Settings): void {
    applySettings(this.uniforms, settings, this.theme, this.live.info);
    const pixelRatio = this.uniforms['uPixelRatio'];
    if (pixelRatio) pixelRatio.value = this.renderer.getPixelRatio();
    const colours = classColours(settings.palette, this.theme);
    const [r, g, b] = colours.free;
    this.grid.setInk(0.3 * r + 0.6 * g + 0.1 * b < 128);
    this.grid.mesh.visible = settings.showGrid;
    this.renderer.setClearColor(new Color(cssColour(colours.unknown).replaceAll(' ', ',')));
  }
}
