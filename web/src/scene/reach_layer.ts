// Where the robot can get to, as a veil over the map: green lines, so that it is not told by colour alone.

import { DataTexture, GLSL3, Mesh, NearestFilter, PlaneGeometry, RedFormat, ShaderMaterial, UnsignedByteType } from 'three';
import type { Reach } from '../backend';

const FRAGMENT = /* glsl */ `
precision highp float;
uniform sampler2D uReached;
in vec2 vAt;
out vec4 colour;
void main() {
  if (texture(uReached, vAt).r < 0.5) discard;
  bool line = mod(gl_FragCoord.x - gl_FragCoord.y, 9.0) < 2.5;
  colour = vec4(0.2, 0.86, 0.62, line ? 0.55 : 0.2);
}`;

/** One byte a cell, 255 where reached, row 0 at the lowest y. */
export function reachTexels({ width, height, runs }: Pick<Reach, 'width' | 'height' | 'runs'>): Uint8Array<ArrayBuffer> {
  const texels = new Uint8Array(width * height);
  let at = 0;
  runs.forEach((length, i) => {
    if (i % 2 === 1) texels.fill(255, at, at + length);
    at += length;
  });
  return texels;
}

export class ReachLayer {
  readonly mesh: Mesh<PlaneGeometry, ShaderMaterial>;

  constructor() {
    const vertexShader = 'out vec2 vAt; void main() { vAt = uv; gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }';
    this.mesh = new Mesh(new PlaneGeometry(1, 1), new ShaderMaterial({ glslVersion: GLSL3, vertexShader, fragmentShader: FRAGMENT, uniforms: { uReached: { value: null } }, transparent: true, depthTest: false, depthWrite: false }));
    this.mesh.renderOrder = 12;
    this.mesh.frustumCulled = this.mesh.visible = false;
  }

  show(reach: Reach | undefined): void {
    const uniform = this.mesh.material.uniforms['uReached'];
    (uniform?.value as DataTexture | null)?.dispose();
    if (uniform) uniform.value = null;
    this.mesh.visible = reach !== undefined;
    if (!reach || !uniform) return;
    const texture = new DataTexture(reachTexels(reach), reach.width, reach.height, RedFormat, UnsignedByteType);
    Object.assign(texture, { minFilter: NearestFilter, magFilter: NearestFilter, unpackAlignment: 1, needsUpdate: true });
    uniform.value = texture;
    const size = { x: reach.width * reach.cellSize, y: reach.height * reach.cellSize };
    this.mesh.position.set(reach.x + size.x / 2, reach.y + size.y / 2, 0.004);
    this.mesh.scale.set(size.x, size.y, 1);
  }
}
