// Everything in the scene that is made of tiles: their textures, the flat picture, floors of spread layers, boxes.

import { Group, type WebGLRenderer } from 'three';
import type { MapInfo } from '../gen/flogmap/v1/map_pb';
import type { LiveMap } from '../live_map';
import type { Settings } from '../settings';
import { keyText, tilesToDraw, type Tile, type TileKey } from '../tile_store';
import { levelFor, visibleRect, type Rect, type Viewport } from '../viewport';
import type { MapUniforms } from './map_material';
import { layerHeights, SolidLayers } from './solid_layers';
import { TileMeshes } from './tile_meshes';
import { TilePages } from './tile_pages';

export class TileScene {
  readonly group = new Group();
  /** What is on screen, coarse tiles first. */
  shown: readonly Tile[] = [];
  private pages: TilePages | null = null;
  private flat: TileMeshes | null = null;
  private floors: TileMeshes[] = []; // of the layers above the lowest, when they are spread apart
  private readonly solid: SolidLayers;
  private readonly dirty = new Map<string, Tile>();

  constructor(private readonly renderer: WebGLRenderer, private readonly live: LiveMap, private readonly uniforms: MapUniforms) {
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
    const pages = new TilePages(this.renderer, Math.max(1, layers.length));
    this.pages = pages;
    this.flat = new TileMeshes(pages, this.uniforms);
    this.floors = layers.map((_, layer) => new TileMeshes(pages, this.uniforms, layer));
    this.group.add(this.flat.group, ...this.floors.map(({ group }) => group));
    this.dirty.clear();
    for (const tile of this.live.tiles.all()) this.dirty.set(keyText(tile), tile);
  }

  get textureBytes(): number {
    return this.pages?.bytes ?? 0;
  }

  change(applied: readonly TileKey[]): void {
    for (const key of applied) {
      const tile = this.live.tiles.get(key);
      if (tile) this.dirty.set(keyText(key), tile);
    }
  }

  /** Frees what tiles hold on the graphics card. */
  release(keys: readonly TileKey[]): void {
    for (const key of keys) {
      this.dirty.delete(keyText(key));
      this.pages?.release(key);
    }
  }

  /** Brings changed tiles to the graphics card, and only those. */
  upload(): void {
    for (const tile of this.dirty.values()) this.pages?.upload(tile);
    this.dirty.clear();
  }

  /** Chooses what is to be seen from where one looks. */
  show(view: Viewport, info: MapInfo, settings: Settings, floor = settings.solid ? (info.layers[0]?.zMin ?? 0) : 0): void {
    const level = levelFor(view, info.cellSize, info.levels, this.renderer.getPixelRatio());
    const rect = visibleRect(view);
    const more = settings.solid ? Math.max(rect.xMax - rect.xMin, rect.yMax - rect.yMin) : 0; // a slanted eye sees further
    this.shown = tilesToDraw(this.live.tiles, grown(rect, more), level, info.cellSize);
    this.flat?.show(this.shown, info.cellSize);
    this.flat?.setHeight(floor);
    this.showFloors(info, settings);
    if (settings.solid) this.solid.show(this.shown, info, settings);
    else this.solid.mesh.visible = false;
  }

  private showFloors(info: MapInfo, settings: Settings): void {
    const heights = layerHeights(info, settings.spread);
    this.floors.forEach((floor, layer) => {
      const bottom = heights[layer]?.bottom ?? 0;
      const visible = settings.solid && settings.spread > 0 && layer > 0 && bottom < settings.clipHeight;
      floor.setHeight(bottom);
      floor.show(visible ? this.shown : [], info.cellSize);
    });
  }
}

const grown = (rect: Rect, by: number): Rect => ({ xMin: rect.xMin - by, yMin: rect.yMin - by, xMax: rect.xMax + by, yMax: rect.yMax + by });
