// The way the camera went: a line with a dark casing, coloured by time or by how well it was tracked.

import { BufferAttribute, BufferGeometry, Color, GLSL3, Group, InstancedBufferGeometry, InstancedInterleavedBuffer, InterleavedBufferAttribute, Mesh, Points, PointsMaterial, ShaderMaterial, Vector2 } from 'three';
import { TrackingState } from '../gen/flogmap/v1/map_pb';
import type { Path } from '../path';
import { CORNER, drawnPath, drawnViews } from '../path_thinning';
import { unitQuad } from './tile_meshes';

const OLD = new Color('#8b6cff');
const NEW = new Color('#ff8a1f');
export const STATE_COLOURS: Record<TrackingState, Color> = {
  [TrackingState.INITIALISING]: new Color('#9aa4b2'),
  [TrackingState.OK]: new Color('#ff8a1f'),
  [TrackingState.WEAK]: new Color('#ffd23f'),
  [TrackingState.LOST]: new Color('#ff3b5c'),
};
const CORNERS_APART_PX = 1.5;
const DOTS_APART_PX = 14;
const DOT_M = 0.02; // nothing is drawn closer together

// A straight piece is a rectangle around it; what is further from the piece than half its width is not painted: round ends.
const VERTEX = /* glsl */ `
in vec4 start; in float state; in vec4 end;  // x, y, z, seconds
uniform vec2 uScreen; uniform float uHalf; uniform float uFrom; uniform float uSeconds; uniform bool uByState; uniform vec3 uStates[8]; uniform vec3 uOld; uniform vec3 uNew;
out vec2 vFrom; flat out vec2 vAlong; out vec3 vInk;
vec3 ink(float seconds) { return uByState ? uStates[int(state)] : mix(uOld, uNew, clamp((seconds - uFrom) / uSeconds, 0.0, 1.0)); }
void main() {
  const float NEAR = 0.02;
  vec4 a = projectionMatrix * modelViewMatrix * vec4(start.xyz, 1.0);
  vec4 b = projectionMatrix * modelViewMatrix * vec4(end.xyz, 1.0);
  gl_Position = vec4(2.0, 2.0, 2.0, 1.0);  // nowhere
  if (state < 0.0 || max(a.w, b.w) < NEAR) return;
  if (a.w < NEAR) a = mix(a, b, (NEAR - a.w) / (b.w - a.w));  // the part before the eye
  if (b.w < NEAR) b = mix(b, a, (NEAR - b.w) / (a.w - b.w));
  vec2 from = a.xy / a.w * 0.5 * uScreen;
  vec2 to = b.xy / b.w * 0.5 * uScreen;
  vec2 ahead = distance(from, to) > 1e-4 ? normalize(to - from) : vec2(1.0, 0.0);
  vec2 reach = (uHalf + 1.0) * (position.xy * 2.0 - 1.0);
  vec2 at = (position.x < 0.5 ? from : to) + reach.x * ahead + reach.y * vec2(-ahead.y, ahead.x);
  vFrom = at - from;
  vAlong = to - from;
  vInk = ink(position.x < 0.5 ? start.w : end.w);
  gl_Position = vec4(at / (0.5 * uScreen), 0.0, 1.0);
}`;

const FRAGMENT = /* glsl */ `
precision highp float;
uniform float uHalf; uniform vec4 uCasing;
in vec2 vFrom; flat in vec2 vAlong; in vec3 vInk;
out vec4 colour;
void main() {
  float along = clamp(dot(vFrom, vAlong) / max(dot(vAlong, vAlong), 1e-9), 0.0, 1.0);
  float cover = clamp(uHalf + 0.5 - distance(vFrom, along * vAlong), 0.0, 1.0);
  if (cover <= 0.0) discard;
  colour = vec4(mix(vInk, uCasing.rgb, uCasing.a), cover);
}`;

type Line = Mesh<InstancedBufferGeometry, ShaderMaterial>;
const srgb = (colour: Color): Color => new Color().copyLinearToSRGB(colour); // written to the screen as it is

export class PathLine {
  readonly group = new Group();
  private path: Path | undefined;
  private first = 0; // point of the path that the line begins at
  private scale = 0; // CSS pixels per metre that the corners were chosen for
  private cost = 0; // ms, of the last update
  private drawnAt = 0;
  private readonly uniforms = {
    uScreen: { value: new Vector2(1, 1) }, uFrom: { value: 0 }, uSeconds: { value: 1 }, uByState: { value: false }, uOld: { value: srgb(OLD) }, uNew: { value: srgb(NEW) },
    uStates: { value: Array.from({ length: 8 }, (_, state) => srgb(STATE_COLOURS[state as TrackingState] ?? NEW)) },
  };
  private readonly lines: [Line, Line] = [this.line(2.25, [0.07, 0.08, 0.1, 1]), this.line(1.25, [0, 0, 0, 0])];
  private readonly dots = new Points(new BufferGeometry(), new PointsMaterial({ size: 3.5, sizeAttenuation: false, color: '#ffffff', depthTest: false, transparent: true, opacity: 0.8 }));

  constructor() {
    this.lines.forEach((line, i) => {
      line.frustumCulled = false;
      line.renderOrder = 20 + i;
    });
    this.dots.frustumCulled = false;
    this.dots.renderOrder = 22;
    this.group.add(...this.lines, this.dots);
  }

  /** The newest `minutes` of the path (0: all). Undefined: no path is to be seen. */
  update(path: Path | undefined, by: 'time' | 'state', minutes: number): void {
    const start = performance.now();
    this.path = path;
    this.uniforms.uByState.value = by === 'state';
    this.first = path?.firstOfLast(minutes) ?? 0;
    this.uniforms.uFrom.value = path?.seconds(this.first) ?? 0;
    this.uniforms.uSeconds.value = Math.max(1e-3, (path?.seconds(path.length - 1) ?? 0) - this.uniforms.uFrom.value);
    this.choose();
    this.cost = performance.now() - start;
    this.drawnAt = start;
  }

  /** A long path is not built anew with every pose: at most a tenth of the time goes into it. */
  restsUntil(): number {
    return this.drawnAt + 10 * this.cost;
  }

  /** `scale`: CSS pixels per metre. Corners and the dots of mapped views keep their distance on the screen. */
  setScale(scale: number): void {
    const octave = 2 ** Math.floor(Math.log2(scale));
    if (octave === this.scale) return;
    this.scale = octave;
    this.choose();
  }

  /** Line width needs to know the screen. */
  resize(width: number, height: number): void {
    this.uniforms.uScreen.value.set(width, height);
  }

  private line(half: number, casing: readonly number[]): Line {
    const uniforms = { ...this.uniforms, uHalf: { value: half }, uCasing: { value: casing } };
    return new Mesh(unitQuad(), new ShaderMaterial({ glslVersion: GLSL3, vertexShader: VERTEX, fragmentShader: FRAGMENT, uniforms, transparent: true, depthTest: false, depthWrite: false }));
  }

  private choose(): void {
    const corners = this.path && this.scale > 0 ? drawnPath(this.path, CORNERS_APART_PX / this.scale, this.first) : new Float32Array(0);
    this.group.visible = corners.length > CORNER;
    if (!this.group.visible || !this.path) return;
    const buffer = new InstancedInterleavedBuffer(corners, CORNER);
    for (const { geometry } of this.lines) {
      geometry.dispose();
      geometry.setAttribute('start', new InterleavedBufferAttribute(buffer, 4, 0));
      geometry.setAttribute('state', new InterleavedBufferAttribute(buffer, 1, 4));
      geometry.setAttribute('end', new InterleavedBufferAttribute(buffer, 4, CORNER));
      geometry.instanceCount = corners.length / CORNER - 1;
    }
    this.dots.geometry.dispose();
    this.dots.geometry = new BufferGeometry();
    this.dots.geometry.setAttribute('position', new BufferAttribute(drawnViews(this.path, Math.max(DOT_M, DOTS_APART_PX / this.scale), this.first), 3));
  }
}
