// Everything in the scene that is made of tiles: their textures, the flat picture, floors of spread layers, boxes.

import { Group } from 'three';
import type { MapInfo } from '../gen/flogmap/v1/map_pb';
import type { LiveMap } from '../live_map';
import type { Settings } from '../settings';
import { tilesToDraw } from '../tile_choice';
import { keyText, type Tile, type TileKey } from '../tile_store';
import { levelFor, visibleRect, type Rect, type Viewport } from '../viewport';
import { setUniform, type MapUniforms, type TileRules } from './map_material';
import type { Picture } from './picture';
import { layerHeights, SolidLayers } from './solid_layers';
import { TileMeshes } from './tile_meshes';
import { TilePages } from './tile_pages';

const UPLOAD_MS = 8; // of a picture
const UPLOAD_SHARE = 0.25; // of a picture's time where that is long: else a slow machine would never have all tiles
const UPLOAD_BYTES = 4 * 2 ** 20; // of a frame: the card works on after the call is back

export class TileScene {
  readonly group = new Group();
  /** What is on screen, fine tiles first. */
  shown: readonly Tile[] = [];
  private pages: TilePages | null = null;
  private flat: TileMeshes | null = null;
  private floors: TileMeshes[] = []; // of the layers above the lowest, when they are spread apart
  private readonly solid: SolidLayers;
  private readonly dirty = new Map<string, Tile>();
  private later: Map<string, Tile> | null = null; // what changed while the picture is held; null: it is not

  constructor(private readonly picture: Picture, private readonly live: LiveMap, private readonly uniforms: MapUniforms, private rules: TileRules) {
    this.solid = new SolidLayers(uniforms);
    this.group.add(this.solid.mesh);
  }

  /** Starts over with what the store holds: after another map began, or the graphics card lost its memory. */
  begin(): void {
    for (const meshes of [this.flat, ...this.floors]) {
      if (meshes) this.group.remove(meshes.group);
      meshes?.dispose();
    }
    this.pages?.dispose();
    const layers = this.live.info?.layers ?? [];
    const pages = new TilePages(this.picture.renderer, Math.max(1, layers.length));
    this.pages = pages;
    this.flat = new TileMeshes(pages, this.uniforms, this.rules);
    this.floors = layers.map((_, layer) => new TileMeshes(pages, this.uniforms, this.rules, layer));
    this.group.add(this.flat.group, ...this.floors.map(({ group }) => group));
    this.solid.clear();
    this.dirty.clear();
    this.later?.clear();
    for (const tile of this.live.tiles.all()) this.dirty.set(keyText(tile), tile);
  }

  /** By which rules tiles are painted. */
  setRules(rules: TileRules): void {
    this.rules = rules;
    for (const meshes of [this.flat, ...this.floors]) meshes?.setRules(rules);
  }

  /** Lets one layer, by its place in the map's list, stand out among those at their height; -1: none. */
  pointAt(layer: number): void {
    setUniform(this.uniforms, 'uPointedAt', layer);
  }

  get textureBytes(): number {
    return this.pages?.bytes ?? 0;
  }

  change(applied: readonly TileKey[]): void {
    const changed = this.later ?? this.dirty;
    for (const key of applied) {
      const tile = this.live.tiles.get(key);
      if (tile) changed.set(keyText(key), tile);
    }
  }

  /** While held, tiles are shown as they are now; letting go takes over what changed meanwhile. */
  hold(held: boolean): void {
    for (const [key, tile] of this.later ?? []) this.dirty.set(key, tile);
    this.later = held ? new Map() : null;
  }

  /** Frees what tiles hold on the graphics card. */
  release(keys: readonly TileKey[]): void {
    for (const key of keys) {
      this.dirty.delete(keyText(key));
      this.later?.delete(keyText(key));
      this.pages?.release(key);
    }
  }

  /** Brings tiles to the graphics card, and no more of them than a frame has time for: changed ones on screen, then
   *  those that the card never had. What changes out of sight waits until it is seen. False if some are left. */
  private upload(): boolean {
    const until = performance.now() + Math.max(UPLOAD_MS, UPLOAD_SHARE * this.picture.pacer.tookMs);
    let bytes = 0;
    for (const [key, tile] of this.due()) {
      if (bytes > UPLOAD_BYTES || performance.now() > until) return false;
      this.pages?.upload(tile);
      this.dirty.delete(key);
      bytes += tile.planes.byteLength;
    }
    return true;
  }

  private *due(): Iterable<[string, Tile]> {
    const shown = new Set(this.shown.map(keyText));
    for (const entry of this.dirty) if (shown.has(entry[0])) yield entry; // longest changed first
    for (const entry of this.dirty) if (!this.pages?.slotOf(entry[1])) yield entry;
  }

  /** Chooses what is to be seen from where one looks. False if it could not yet bring all of it to the graphics card. */
  show(view: Viewport, info: MapInfo, settings: Settings, floor = settings.solid ? (info.layers[0]?.zMin ?? 0) : 0): boolean {
    const level = levelFor(view, info.cellSize, info.levels, this.picture.fullRatio);
    const rect = visibleRect(view);
    const more = settings.solid ? Math.max(rect.xMax - rect.xMin, rect.yMax - rect.yMin) : 0; // a slanted eye sees further
    const seen = grown(rect, more);
    this.shown = tilesToDraw(this.live.tiles, seen, level, info.cellSize, (key) => this.pages?.slotOf(key) !== undefined);
    const brought = this.upload();
    this.flat?.show(this.shown, level, info.cellSize);
    this.flat?.setHeight(floor);
    this.showFloors(level, info, settings);
    const built = !settings.solid || this.solid.show(tilesToDraw(this.live.tiles, seen, level, info.cellSize, (key) => this.solid.has(key)), level, info, settings, this.picture.pacer.tookMs);
    if (!settings.solid) this.solid.mesh.visible = false;
    return brought && built;
  }

  private showFloors(level: number, info: MapInfo, settings: Settings): void {
    const heights = layerHeights(info, settings.spread);
    this.floors.forEach((floor, layer) => {
      const bottom = heights[layer]?.bottom ?? 0;
      const visible = settings.solid && settings.spread > 0 && layer > 0 && bottom < settings.clipHeight;
      floor.setHeight(bottom);
      floor.show(visible ? this.shown : [], level, info.cellSize);
    });
  }
}

const grown = (rect: Rect, by: number): Rect => ({ xMin: rect.xMin - by, yMin: rect.yMin - by, xMax: rect.xMax + by, yMax: rect.yMax + by });
