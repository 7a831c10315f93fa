// The map on screen. Holds the viewport, draws at most once per animation frame and only when something changed.

import { Color, Mesh, Scene, type WebGLRenderer } from 'three';
import { heading } from '../geometry';
import { ImageStream } from '../gen/flogmap/v1/stream_pb';
import type { Reach } from '../backend';
import type { Motion } from '../level';
import type { LiveMap } from '../live_map';
import { classColours, cssColour, type Theme } from '../palette';
import type { Settings } from '../settings';
import { Signal, type Store } from '../signal';
import type { TileKey } from '../tile_store';
import { fit, pan, wrapAngle, zoomAt, type Point, type Viewport } from '../viewport';
import { CameraMarker } from './camera_marker';
import { Glide } from './glide';
import { GridLines } from './grid_lines';
import { applySettings, groundMaterial, mapUniforms, setUniform, tileRules, type MapUniforms } from './map_material';
import { PathLine } from './path_line';
import { Picture } from './picture';
import { place } from './place_group';
import { ReachLayer } from './reach_layer';
import { unitQuad } from './tile_meshes';
import { TileScene } from './tile_scene';
import { ViewCamera } from './view_camera';
import type { Walkthrough } from './walkthrough';

const FIT_MARGIN_PX = 48;
const WALK_SCALE = 40; // CSS pixels per metre that the floor of a walkthrough is chosen for

export class MapView {
  viewport: Viewport = { x: 0, y: 0, scale: 80, turn: 0, width: 800, height: 600 };
  fps = 0;
  readonly eye = new ViewCamera();
  /** After every picture: overlays move with it. */
  readonly drawn = new Signal<Viewport>();
  /** The part of the world that is shown has changed. */
  readonly moved = new Signal<Viewport>();
  readonly tiles: TileScene;

  readonly picture = new Picture((now) => this.draw(now));
  private readonly renderer: WebGLRenderer = this.picture.renderer;
  private readonly scene = new Scene();
  private readonly uniforms: MapUniforms = mapUniforms();
  private readonly path = new PathLine();
  private readonly marker = new CameraMarker();
  private readonly grid = new GridLines();
  private readonly reach = new ReachLayer();
  private readonly ground = new Mesh(unitQuad(), groundMaterial(this.uniforms));
  private walkthrough: Walkthrough | null = null;
  private held = false;
  private stale = { tiles: true, path: true, settings: true };
  private readonly glide = new Glide();
  private lastFrame = 0;
  private touchedByUser = false;
  private theme: Theme = 'dark';

  constructor(private readonly holder: HTMLElement, private readonly live: LiveMap, private readonly settings: Store<Settings>) {
    this.canvas.tabIndex = 0;
    holder.prepend(this.canvas);
    this.tiles = new TileScene(this.picture, live, this.uniforms, tileRules(settings.get(), live.info));
    this.ground.frustumCulled = false;
    this.ground.renderOrder = 1; // after all that hides it
    this.scene.add(this.ground, this.tiles.group, this.reach.mesh, this.grid.mesh, this.path.group, this.marker.group);
    new ResizeObserver(() => this.resize()).observe(holder);
    this.resize();
    this.listen();
  }

  get canvas(): HTMLCanvasElement {
    return this.picture.canvas;
  }

  setTheme(theme: Theme): void {
    this.theme = theme;
    this.stale.settings = true;
    this.requestDraw();
  }

  requestDraw(): void {
    this.picture.request();
  }

  /** Looks through a walker's eye instead of down on the map; null: back to the map. */
  walk(walkthrough: Walkthrough | null): void {
    if (this.walkthrough) this.scene.remove(this.walkthrough.group);
    if (walkthrough) this.scene.add(walkthrough.group);
    this.walkthrough = walkthrough;
    this.ground.visible = this.path.group.visible = !walkthrough;
    this.marker.group.visible = false; // until the camera is placed
    this.stale = { tiles: true, path: true, settings: true };
    this.requestDraw();
  }

  /** Tries out another level: moves the tiles, or path and camera, by this; undefined puts them back. */
  tilt(tiles: Motion | 'as it is' | undefined, path: Motion | undefined): void {
    if (tiles !== 'as it is') place(this.tiles.group, tiles);
    place(this.path.group, path);
    place(this.marker.group, path);
    this.requestDraw();
  }

  showReach(reach: Reach | undefined): void {
    this.reach.show(reach);
    this.requestDraw();
  }

  /** While held, the picture stays as it is though the map goes on; letting go catches up. */
  hold(held: boolean): void {
    this.held = held;
    this.tiles.hold(held);
    this.stale.tiles = this.stale.path = true;
    this.requestDraw();
  }

  /** Moves the view by hand: it stays where the person puts it. */
  moveTo(view: Viewport): void {
    this.picture.movedByHand();
    this.touchedByUser = true;
    this.glide.target = null;
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
    this.glide.target = { ...view, width: this.viewport.width, height: this.viewport.height };
    this.requestDraw();
  }

  /** Shows the whole map. */
  fitMap(): void {
    const rect = this.live.bounds;
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
    this.live.imageChanged.on((stream) => this.takePicture(stream));
    this.canvas.addEventListener('webglcontextrestored', () => this.begin());
  }

  private mark(what: 'tiles' | 'path'): void {
    this.stale[what] = true;
    this.requestDraw();
  }

  private begin(): void {
    this.tiles.begin();
    this.marker.group.visible = false;
    this.stale = { tiles: true, path: true, settings: true };
    this.requestDraw();
  }

  /** The live picture for the frustum. */
  private takePicture(stream: ImageStream): void {
    const image = stream === ImageStream.LEFT && this.settings.get().solid ? this.live.images.get(stream) : undefined;
    if (image) void this.marker.load(image).then(() => this.requestDraw(), () => {}); // unreadable: told by the camera panel
  }

  private changeTiles(applied: readonly TileKey[], removed: readonly TileKey[]): void {
    this.tiles.change(applied);
    this.release(removed);
    const rect = this.held || this.touchedByUser || this.settings.get().follow !== 'free' ? undefined : this.live.bounds;
    if (rect) this.glideTo(fit(this.viewport, rect, FIT_MARGIN_PX));
    if (!this.held) this.mark('tiles'); // a new overview tile must not hide what stands in for it
  }

  /** Frees what the tiles hold on the graphics card. */
  release(keys: readonly TileKey[]): void {
    this.tiles.release(keys);
    this.stale.tiles = true;
  }

  private follow(): void {
    const { follow } = this.settings.get();
    const pose = this.live.pose?.pose;
    if (follow === 'free' || !pose || this.held) return;
    const turn = follow === 'heading' ? wrapAngle(heading(pose) - Math.PI / 2) : 0;
    this.glideTo({ ...this.viewport, scale: this.glide.target?.scale ?? this.viewport.scale, x: pose.x, y: pose.y, turn });
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
    this.picture.resize(width, height);
    this.path.resize(width, height);
    this.setViewport({ ...this.viewport, width, height });
    if (this.glide.target) this.glide.target = { ...this.glide.target, width, height };
    if (!this.touchedByUser) this.fitMap();
  }

  private draw(now: number): void {
    const seconds = Math.min(0.1, (now - this.lastFrame) / 1000);
    if (seconds > 0) this.fps = this.fps * 0.9 + 0.1 / Math.max(seconds, 1e-3);
    this.lastFrame = now;
    const moved = this.glide.step(this.viewport, seconds);
    if (moved) this.setViewport(moved);
    if (this.walkthrough) return this.drawWalk(this.walkthrough, seconds);
    this.refresh();
    this.eye.solid = this.settings.get().solid;
    this.eye.aim = (this.settings.get().spread * Math.max(0, (this.live.info?.layers.length ?? 1) - 1)) / 2;
    this.eye.update(this.viewport);
    this.grid.update(this.viewport, this.eye.solid, this.eye.solid ? (this.live.info?.layers[0]?.zMin ?? 0) : 0);
    this.renderer.render(this.scene, this.eye.camera);
    this.drawn.emit(this.viewport);
  }

  private drawWalk(walk: Walkthrough, seconds: number): void {
    const more = walk.frame(seconds, this.viewport.width / this.viewport.height);
    const [x, y] = walk.walker.position;
    const settings = this.settings.get();
    if (this.stale.settings) this.refreshColours(settings);
    setUniform(this.uniforms, 'uQuiet', 1); // the floor keeps in the background
    setUniform(this.uniforms, 'uPixelRatio', this.renderer.getPixelRatio());
    this.grid.mesh.visible = false;
    const brought = !this.live.info || this.tiles.show({ ...this.viewport, x, y, turn: 0, scale: WALK_SCALE }, this.live.info, { ...settings, solid: false }, walk.floor);
    this.stale.settings = false;
    this.renderer.render(this.scene, walk.camera);
    this.drawn.emit(this.viewport);
    if (more || !brought) this.requestDraw();
  }

  private refresh(): void {
    const settings = this.settings.get();
    const { info } = this.live;
    if (this.stale.settings) this.refreshColours(settings);
    setUniform(this.uniforms, 'uQuiet', 0);
    setUniform(this.uniforms, 'uPixelRatio', this.renderer.getPixelRatio());
    const brought = !this.stale.tiles || !info || this.tiles.show(this.viewport, info, settings);
    if (!brought) this.requestDraw();
    const pathDue = this.stale.settings || performance.now() >= this.path.restsUntil();
    if (this.stale.path && pathDue && !this.held) this.path.update(settings.showPath ? this.live.path : undefined, settings.pathBy, settings.pathMinutes);
    const pathLater = this.stale.path && !pathDue;
    this.path.setScale(this.viewport.scale);
    this.stale = { tiles: !brought, path: pathLater, settings: false };
    if (pathLater) setTimeout(() => this.requestDraw(), Math.max(16, this.path.restsUntil() - performance.now()));
    const pose = this.live.pose;
    if (pose?.pose && !this.held) {
      this.marker.setState(pose.state);
      this.marker.place(pose.pose, this.live.camera, this.viewport.scale, settings.solid);
    }
  }

  private refreshColours(settings: Settings): void {
    applySettings(this.uniforms, settings, this.theme, this.live.info);
    this.tiles.setRules(tileRules(settings, this.live.info));
    const colours = classColours(settings.palette, this.theme);
    const [r, g, b] = colours.free;
    this.grid.setInk(0.3 * r + 0.6 * g + 0.1 * b < 128);
    this.grid.mesh.visible = settings.showGrid;
    this.renderer.setClearColor(new Color(cssColour(colours.unknown).replaceAll(' ', ',')));
  }
}
