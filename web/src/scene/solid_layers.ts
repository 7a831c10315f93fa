// Layers at their height: a box for every occupied cell on screen, lit from the side, all in one draw call.

import { BoxGeometry, GLSL3, InstancedBufferAttribute, InstancedBufferGeometry, Mesh, ShaderMaterial } from 'three';
import type { MapInfo } from '../gen/flogmap/v1/map_pb';
import { classify, seenFromConfidence, styleValue } from '../rules';
import { layerSetting, type Settings } from '../settings';
import { BYTES_PER_LAYER, keyText, TILE_SIDE, tileSide, type Tile, type TileKey } from '../tile_store';
import { quarterOf, quartersToDraw } from '../tile_choice';
import { MAX_LAYERS, type MapUniforms } from './map_material';

const VERTEX = /* glsl */ `
in vec4 cell;  // corner x, y; side [m]; layer + value / 2
uniform float uBottoms[${MAX_LAYERS}];
uniform float uTops[${MAX_LAYERS}];
uniform float uClip;
flat out vec4 vAbout;  // layer, value, light
out float vUp;
void main() {
  int layer = int(floor(cell.w));
  float up = position.z + 0.5;
  float bottom = uBottoms[layer];
  float top = max(bottom, min(uTops[layer], uClip));
  vUp = mix(bottom, top, up);
  vec3 at = vec3(cell.xy + (position.xy + 0.5) * cell.z, vUp);
  float light = 0.62 + 0.38 * max(0.0, dot(normal, normalize(vec3(-0.35, -0.55, 0.76))));
  vAbout = vec4(float(layer), fract(cell.w) * 2.0, light, top - bottom);
  vUp = up;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(at, 1.0);
}`;

const FRAGMENT = /* glsl */ `
precision highp float;
uniform sampler2D uRamp; uniform bool uByHeight; uniform vec3 uLayerColours[${MAX_LAYERS}]; uniform float uWeights[${MAX_LAYERS}];
uniform int uPointedAt; uniform vec3 uFree;  // -1: no layer is pointed at
flat in vec4 vAbout; in float vUp;
out vec4 colour;
void main() {
  if (vAbout.w <= 0.0) discard;
  int layer = int(vAbout.x);
  vec3 base = uByHeight ? uLayerColours[layer] : texelFetch(uRamp, ivec2(int(clamp(vAbout.y, 0.0, 1.0) * 255.0), 0), 0).rgb;
  float fade = step(fract((gl_FragCoord.x + 2.0 * gl_FragCoord.y) * 0.37), uWeights[layer]);
  if (fade < 0.5) discard;  // opacity by dots: needs no sorting
  if (uPointedAt >= 0 && layer != uPointedAt) base = mix(base, uFree, 0.85);
  colour = vec4(base * vAbout.z * mix(0.72, 1.0, vUp), 1.0);
}`;

const BUILD_MS = 12; // of a picture
const BUILD_SHARE = 0.5; // of a picture's time where that is long
const MAX_KEPT = 4096; // tiles
const NO_BOXES = new Float32Array(0);

/** What decides which boxes there are; boxes of a tile are built anew when this or its revision changes. */
const choiceOf = ({ style, operators, threshold, layers }: Settings): string => JSON.stringify([style, operators, threshold, layers]);

export class SolidLayers {
  readonly mesh: Mesh<InstancedBufferGeometry, ShaderMaterial>;
  private readonly kept = new Map<string, { readonly rev: bigint; readonly choice: string; readonly quarters: readonly Float32Array[] }>();
  private choice = '';

  constructor(uniforms: MapUniforms) {
    const geometry = new InstancedBufferGeometry();
    const box = new BoxGeometry(1, 1, 1);
    geometry.setIndex(box.index);
    geometry.setAttribute('position', box.getAttribute('position'));
    geometry.setAttribute('normal', box.getAttribute('normal'));
    const own = { uBottoms: { value: [] as number[] }, uTops: { value: [] as number[] }, uClip: { value: 100 } };
    this.mesh = new Mesh(geometry, new ShaderMaterial({ glslVersion: GLSL3, vertexShader: VERTEX, fragmentShader: FRAGMENT, uniforms: { ...uniforms, ...own } }));
    this.mesh.visible = this.mesh.frustumCulled = false;
  }

  /** False if there was no time for the boxes of all tiles: some are as they were, or still missing. */
  show(tiles: readonly Tile[], level: number, info: MapInfo, settings: Settings, pictureMs: number): boolean {
    this.choice = choiceOf(settings);
    const until = performance.now() + Math.max(BUILD_MS, BUILD_SHARE * pictureMs);
    const due = tiles.filter((tile) => !this.isCurrent(tile)).sort((a, b) => this.builtRev(a) - this.builtRev(b));
    let built = 0;
    while (built < due.length && (built === 0 || performance.now() < until)) this.build(due[built++] as Tile, info, settings);
    this.fill(tiles.flatMap((tile) => quartersToDraw(tile, level, (key) => this.has(key)).map((quarter) => this.kept.get(keyText(tile))?.quarters[quarter] ?? NO_BOXES)));
    const { uBottoms, uTops, uClip } = this.mesh.material.uniforms;
    const heights = layerHeights(info, settings.spread);
    if (uBottoms) uBottoms.value = pad(heights.map(({ bottom }) => bottom));
    if (uTops) uTops.value = pad(heights.map(({ top }) => top));
    if (uClip) uClip.value = settings.clipHeight;
    return built === due.length;
  }

  /** Its boxes are there, if perhaps not the newest. */
  has(key: TileKey): boolean {
    return this.kept.has(keyText(key));
  }

  /** Another map begins. */
  clear(): void {
    this.kept.clear();
  }

  private isCurrent(tile: Tile): boolean {
    const kept = this.kept.get(keyText(tile));
    return kept?.rev === tile.rev && kept.choice === this.choice;
  }

  /** Of the boxes that are there; -1: none are. */
  private builtRev(tile: Tile): number {
    return Number(this.kept.get(keyText(tile))?.rev ?? -1n);
  }

  private build(tile: Tile, info: MapInfo, settings: Settings): void {
    const key = keyText(tile);
    this.kept.delete(key); // to the end: the longest unchanged goes first
    this.kept.set(key, { rev: tile.rev, choice: this.choice, quarters: occupiedBoxes(tile, info, settings) });
    if (this.kept.size > MAX_KEPT) this.kept.delete(this.kept.keys().next().value ?? '');
  }

  private fill(parts: readonly Float32Array[]): void {
    const { geometry } = this.mesh;
    const length = parts.reduce((sum, part) => sum + part.length, 0);
    const old = geometry.getAttribute('cell') as InstancedBufferAttribute | undefined;
    let values = old?.array as Float32Array | undefined;
    if (!values || values.length < length) {
      values = new Float32Array(Math.max(4096, 2 * length));
      geometry.dispose();
      geometry.setAttribute('cell', new InstancedBufferAttribute(values, 4));
    }
    let at = 0;
    for (const part of parts) {
      values.set(part, at);
      at += part.length;
    }
    geometry.getAttribute('cell').needsUpdate = true;
    geometry.instanceCount = length / 4;
    this.mesh.visible = length > 0;
  }
}

const pad = (values: number[]): number[] => [...values, ...new Array<number>(MAX_LAYERS).fill(0)].slice(0, MAX_LAYERS);

/** Where each layer begins and ends when layers are spread apart by `spread` metres. */
export function layerHeights(info: MapInfo, spread: number): { bottom: number; top: number }[] {
  return info.layers.map((layer, i) => ({ bottom: layer.zMin + i * spread, top: layer.zMax + i * spread }));
}

/** Of the boxes of each quarter of a tile (quarterOf): corner x, y, side and layer + value / 2; value below 1 so that the layer survives. */
export function occupiedBoxes(tile: Tile, info: MapInfo, settings: Settings): Float32Array[] {
  const side = tileSide(tile.level, info.cellSize);
  const cell = side / TILE_SIDE;
  const quarters: number[][] = [[], [], [], []];
  info.layers.slice(0, MAX_LAYERS).forEach((layer, index) => {
    if (!layerSetting(settings, layer.id).visible) return;
    const seenFrom = seenFromConfidence(info.minRays, layer.fullConfidenceRays);
    for (let column = 0; column < TILE_SIDE * TILE_SIDE; ++column) {
      const at = index * BYTES_PER_LAYER + 4 * column;
      if (tile.planes[at + 2] === 0) continue; // nobody looked
      const evidence = { E: byte(tile, at), O: byte(tile, at + 1), K: byte(tile, at + 2), C: byte(tile, at + 3) };
      if (classify(settings.style, settings.operators, evidence, seenFrom, settings.threshold) !== 'occupied') continue;
      const value = Math.min(0.998, styleValue(settings.style, settings.operators, evidence));
      const [x, y] = [column % TILE_SIDE, Math.floor(column / TILE_SIDE)];
      quarters[quarterOf(x, y)]?.push(tile.x * side + x * cell, tile.y * side + y * cell, cell, index + value / 2);
    }
  });
  return quarters.map((boxes) => new Float32Array(boxes));
}

const byte = (tile: Tile, at: number): number => (tile.planes[at] ?? 0) / 255;
