// Lines at round metres over the map: thin every step, stronger every fifth.

import { Color, GLSL3, Mesh, PlaneGeometry, ShaderMaterial } from 'three';
import { roundLength, visibleRect, type Viewport } from '../viewport';

const WANTED_PX = 90; // between two lines, at least 2/5 of it

export class GridLines {
  readonly mesh: Mesh<PlaneGeometry, ShaderMaterial>;

  constructor() {
    const material = new ShaderMaterial({
      glslVersion: GLSL3, transparent: true, depthTest: false, depthWrite: false,
      uniforms: { uStep: { value: 1 }, uPixel: { value: 0.01 }, uInk: { value: new Color() }, uStrength: { value: 0.2 } },
      vertexShader: 'out vec2 vWorld; void main() { vec4 w = modelMatrix * vec4(position, 1.0); vWorld = w.xy; gl_Position = projectionMatrix * viewMatrix * w; }',
      fragmentShader: /* glsl */ `
        precision highp float;
        uniform float uStep; uniform float uPixel; uniform vec3 uInk; uniform float uStrength;
        in vec2 vWorld; out vec4 colour;
        float line(float spacing) {
          vec2 away = abs(mod(vWorld + 0.5 * spacing, spacing) - 0.5 * spacing);
          vec2 width = max(vec2(uPixel), fwidth(vWorld));
          vec2 near = 1.0 - smoothstep(0.35 * width, 0.85 * width, away);
          return max(near.x, near.y);
        }
        void main() {
          colour = vec4(uInk, max(0.45 * line(uStep), line(5.0 * uStep)) * uStrength);
        }`,
    });
    this.mesh = new Mesh(new PlaneGeometry(1, 1), material);
    this.mesh.renderOrder = 10;
    this.mesh.frustumCulled = false;
  }

  setInk(light: boolean): void {
    const { uInk, uStrength } = this.mesh.material.uniforms;
    if (uInk) (uInk.value as Color).setRGB(light ? 1 : 0, light ? 1 : 0, light ? 1 : 0, '');
    if (uStrength) uStrength.value = light ? 0.11 : 0.13;
  }

  update(view: Viewport, solid: boolean, ground: number): void {
    const rect = visibleRect(view);
    const grow = solid ? 4 : 1;
    this.mesh.material.depthTest = solid; // behind what stands on the ground
    this.mesh.position.set(view.x, view.y, ground + 0.003);
    this.mesh.scale.set((rect.xMax - rect.xMin) * grow, (rect.yMax - rect.yMin) * grow, 1);
    const { uStep, uPixel } = this.mesh.material.uniforms;
    if (uStep) uStep.value = gridStep(view);
    if (uPixel) uPixel.value = 1 / view.scale;
  }
}

/** Metres between two thin lines. */
export const gridStep = (view: Viewport): number => roundLength(WANTED_PX / view.scale);
