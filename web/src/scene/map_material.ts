// The colours of the map, computed on the graphics card from evidence, rules and palette. The rules are rules.ts's.

import { Color, DataTexture, GLSL3, LessDepth, NearestFilter, RGBAFormat, ShaderMaterial, UnsignedByteType, type DataArrayTexture } from 'three';
import type { MapInfo } from '../gen/flogmap/v1/map_pb';
import { classColours, layerColour, rampTexels, type Rgb, type Theme } from '../palette';
import { CONFLICT_MARK, OPERATORS, RULES_GLSL, seenFromConfidence, STYLES } from '../rules';
import { layerSetting, type Settings } from '../settings';

export const MAX_LAYERS = 16;

/** One set of uniforms, shared by the materials of all pages and by the ground behind the tiles. */
export interface MapUniforms {
  [name: string]: { value: unknown };
}

const floats = (): number[] => new Array<number>(MAX_LAYERS).fill(0);

export function mapUniforms(): MapUniforms {
  const ramp = new DataTexture(rampTexels('cividis'), 256, 1, RGBAFormat, UnsignedByteType);
  ramp.minFilter = ramp.magFilter = NearestFilter;
  return {
    uThreshold: { value: 0.3 }, uConflictMark: { value: CONFLICT_MARK }, uByHeight: { value: false }, uRamp: { value: ramp },
    uWeights: { value: floats() }, uSeenFrom: { value: floats() }, uLayerColours: { value: Array.from({ length: MAX_LAYERS }, () => new Color()) },
    uUnknown: { value: new Color() }, uFree: { value: new Color() }, uOccupied: { value: new Color() }, uConflict: { value: new Color() },
    uHatch: { value: new Color() }, uPixelRatio: { value: 1 }, uQuiet: { value: 0 }, uPointedAt: { value: -1 },
  };
}

// Values for the shader as they are written to the screen: no conversion on the way.
const put = (uniform: { value: unknown } | undefined, rgb: Rgb): void => {
  (uniform?.value as Color).setRGB(rgb[0] / 255, rgb[1] / 255, rgb[2] / 255, '');
};

export const setUniform = (uniforms: MapUniforms, name: string, value: unknown): void => {
  const uniform = uniforms[name];
  if (uniform) uniform.value = value;
};

/** What the tiles' shader is compiled for: these change by hand only. */
export interface TileRules {
  readonly [define: string]: number;
}

export function tileRules({ style, operators, classes, colourByHeight, markConflict }: Settings, info: MapInfo | null): TileRules {
  return {
    STYLE: STYLES.indexOf(style), OPERATORS: OPERATORS.indexOf(operators), LAYERS: Math.min(MAX_LAYERS, info?.layers.length ?? 0),
    CLASSES: Number(classes), BY_HEIGHT: Number(colourByHeight), MARK_CONFLICT: Number(markConflict),
  };
}

/** Writes the person's choices and the map's constants into the uniforms. */
export function applySettings(uniforms: MapUniforms, settings: Settings, theme: Theme, info: MapInfo | null): void {
  const layers = info?.layers.slice(0, MAX_LAYERS) ?? [];
  setUniform(uniforms, 'uThreshold', settings.threshold);
  setUniform(uniforms, 'uByHeight', settings.colourByHeight);
  const padded = (values: number[]): number[] => [...values, ...floats()].slice(0, MAX_LAYERS);
  setUniform(uniforms, 'uWeights', padded(layers.map(({ id }) => (layerSetting(settings, id).visible ? layerSetting(settings, id).opacity : 0))));
  setUniform(uniforms, 'uSeenFrom', padded(layers.map((layer) => seenFromConfidence(info?.minRays ?? 8, layer.fullConfidenceRays))));
  layers.forEach((_, i) => {
    const colours = uniforms['uLayerColours']?.value as Color[];
    put({ value: colours[i] }, layerColour(i, layers.length, theme));
  });
  applyColours(uniforms, settings, theme);
}

function applyColours(uniforms: MapUniforms, settings: Settings, theme: Theme): void {
  const colours = classColours(settings.palette, theme);
  put(uniforms['uUnknown'], colours.unknown);
  put(uniforms['uFree'], colours.free);
  put(uniforms['uOccupied'], colours.occupied);
  put(uniforms['uConflict'], colours.conflict);
  put(uniforms['uHatch'], hatchColour(colours.unknown, theme));
  const ramp = uniforms['uRamp']?.value as DataTexture;
  ramp.image.data?.set(rampTexels(settings.palette));
  ramp.needsUpdate = true;
}

/** The lines on the unknown: a little lighter on dark, a little darker on light. */
export const hatchColour = (unknown: Rgb, theme: Theme): Rgb =>
  unknown.map((c) => (theme === 'dark' ? c + (255 - c) * 0.1 : c * 0.91)) as unknown as Rgb;

const COMMON = /* glsl */ `
precision highp float;
uniform vec3 uUnknown; uniform vec3 uHatch; uniform float uPixelRatio;
vec3 unknownColour() {  // diagonal lines, one in eight pixels
  float at = mod(gl_FragCoord.x + gl_FragCoord.y, 8.0 * uPixelRatio);
  return at < uPixelRatio ? uHatch : uUnknown;
}
`;

const FRAGMENT = /* glsl */ `
precision highp sampler2DArray;
${COMMON}
${RULES_GLSL}
uniform sampler2DArray uPlanes;
uniform sampler2D uRamp;
uniform int uOnly;  // with ONE_LAYER: this one
uniform float uWeights[${MAX_LAYERS}];
uniform float uSeenFrom[${MAX_LAYERS}];
uniform vec3 uLayerColours[${MAX_LAYERS}];
uniform vec3 uFree; uniform vec3 uOccupied; uniform vec3 uConflict;
uniform float uThreshold; uniform float uConflictMark; uniform float uQuiet;
in vec2 vCell;
flat in float vSlot;
out vec4 colour;

vec3 conflictHatch(vec3 under) {  // a lattice, so that it cannot be taken for the unknown
  float a = mod(gl_FragCoord.x - gl_FragCoord.y, 6.0 * uPixelRatio);
  float b = mod(gl_FragCoord.x + gl_FragCoord.y, 6.0 * uPixelRatio);
  return a < 1.5 * uPixelRatio || b < 1.5 * uPixelRatio ? uConflict : under;
}

void main() {
  ivec2 cell = clamp(ivec2(vCell), ivec2(0), ivec2(63));
  int slice = int(vSlot + 0.5) * LAYERS;
  float best = -1.0;
  float conflict = 0.0;
  bool seen = false;
  bool obstacle = false;
  int from = -1;
  for (int k = 0; k < LAYERS; ++k) {
    bool chosen = uWeights[k] > 0.0;
#if ONE_LAYER
    chosen = chosen && k == uOnly;
#endif
    if (!chosen) continue;
    vec4 evidence = texelFetch(uPlanes, ivec3(cell, slice + k), 0);
    bool here = evidence.b >= uSeenFrom[k];
    seen = seen || here;
    float value = uWeights[k] * styleValue(evidence);
    if (value > best) { best = value; from = k; }
#if CLASSES
    obstacle = obstacle || ((here || STYLE == 2) && uWeights[k] * classValue(evidence) >= uThreshold);
#endif
    conflict = max(conflict, conflictValue(evidence));
  }
#if ONE_LAYER
  if (!seen) discard;
#endif
  bool covers = seen || (STYLE == 2 && from >= 0);
#if BY_HEIGHT
  vec3 high = from >= 0 ? uLayerColours[max(from, 0)] : uOccupied;
#else
  vec3 high = uOccupied;
#endif
#if CLASSES
  vec3 shown = obstacle ? high : uFree;
#elif BY_HEIGHT
  vec3 shown = mix(uFree, high, clamp(best, 0.0, 1.0));
#else
  vec3 shown = texelFetch(uRamp, ivec2(int(clamp(best, 0.0, 1.0) * 255.0 + 0.5), 0), 0).rgb;
#endif
  if (!covers) shown = unknownColour();
#if STYLE == 2
  else if (!seen && mod(gl_FragCoord.x + gl_FragCoord.y, 8.0 * uPixelRatio) < uPixelRatio) shown = mix(shown, uUnknown, 0.55);
#endif
#if MARK_CONFLICT
  if (conflict >= uConflictMark) shown = conflictHatch(shown);
#endif
  float grey = dot(shown, vec3(0.3, 0.59, 0.11));
  shown = mix(shown, vec3(0.75 * grey), 0.7 * uQuiet);
  colour = vec4(shown, ONE_LAYER == 1 ? 0.55 : 1.0);
}
`;

const VERTEX = /* glsl */ `
in vec4 tile;  // lower left corner x, y; side [m]; slot, + (1 + quarter) / 8 if only this quarter is to be seen
uniform float uHeight;
out vec2 vCell;
flat out float vSlot;
void main() {  // coarser tiles lie a little lower, so that finer ones cover them
  int quarter = int(fract(tile.w) * 8.0 + 0.5) - 1;
  vec2 part = quarter < 0 ? position.xy : 0.5 * (position.xy + vec2(quarter & 1, quarter >> 1));
  vCell = part * 64.0;
  vSlot = floor(tile.w);
  gl_Position = projectionMatrix * modelViewMatrix * vec4(tile.xy + part * tile.z, uHeight - 1e-4 * tile.z, 1.0);
}
`;

/** Paints the tiles of one page; of `oneLayer` (uOnly) translucent. Finer tiles are drawn first: what is behind is not painted. */
export function tileMaterial(uniforms: MapUniforms, page: DataArrayTexture, rules: TileRules, oneLayer: boolean): ShaderMaterial {
  return new ShaderMaterial({
    glslVersion: GLSL3, vertexShader: VERTEX, fragmentShader: FRAGMENT, uniforms: { ...uniforms, uPlanes: { value: page } },
    defines: { ...rules, ONE_LAYER: Number(oneLayer) }, transparent: oneLayer, depthFunc: LessDepth,
  });
}

/** Paints what no tile covers: unknown, over the whole screen, after them. */
export function groundMaterial(uniforms: MapUniforms): ShaderMaterial {
  return new ShaderMaterial({
    glslVersion: GLSL3, depthWrite: false, uniforms,
    vertexShader: 'void main() { gl_Position = vec4(position.xy * 2.0 - 1.0, 0.999, 1.0); }',
    fragmentShader: `${COMMON} out vec4 colour; void main() { colour = vec4(unknownColour(), 1.0); }`,
  });
}
