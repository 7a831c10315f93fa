// Textured meshes of mapped views, drawn so that the better view wins where two show the same surface.

import { BufferAttribute, BufferGeometry, GLSL3, Group, LinearFilter, LinearMipmapLinearFilter, Mesh, Quaternion, ShaderMaterial, SRGBColorSpace, Texture, Vector3 } from 'three';
import type { ViewMesh } from '../walk/glb';
import type { MappedView } from '../walk/view_choice';

// What is of rank r is drawn as if it were this much further away per rank: it fills what better views leave open.
const BEHIND_PER_RANK = 0.012;

const VERTEX = /* glsl */ `
in vec2 corner;
uniform float uBehind;
out vec2 vCorner;
void main() {  // moved along the line of sight: the same place on screen, only deeper
  vCorner = corner;
  vec4 seen = modelViewMatrix * vec4(position, 1.0);
  gl_Position = projectionMatrix * vec4(seen.xyz * uBehind, 1.0);
}`;

const FRAGMENT = /* glsl */ `
precision highp float;
uniform sampler2D uPicture;
in vec2 vCorner;
out vec4 colour;
void main() { colour = linearToOutputTexel(vec4(texture(uPicture, vCorner).rgb, 1.0)); }`;

export class DrawableView {
  readonly mesh: Mesh<BufferGeometry, ShaderMaterial>;

  constructor(view: ViewMesh, private readonly bitmap: ImageBitmap) {
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(view.positions, 3));
    geometry.setAttribute('corner', new BufferAttribute(view.texture, 2, true));
    geometry.setIndex(new BufferAttribute(view.indices, 1));
    const picture = new Texture(bitmap);
    Object.assign(picture, { colorSpace: SRGBColorSpace, flipY: false, minFilter: LinearMipmapLinearFilter, magFilter: LinearFilter, generateMipmaps: true, anisotropy: 4, needsUpdate: true });
    this.mesh = new Mesh(geometry, new ShaderMaterial({ glslVersion: GLSL3, vertexShader: VERTEX, fragmentShader: FRAGMENT, uniforms: { uPicture: { value: picture }, uBehind: { value: 1 } } }));
    this.mesh.frustumCulled = false;
  }

  place({ position, orientation: { qx, qy, qz, qw } }: MappedView, rank: number): void {
    this.mesh.position.copy(new Vector3(...position));
    this.mesh.quaternion.copy(new Quaternion(qx, qy, qz, qw));
    this.mesh.renderOrder = rank; // best first: what is behind it need not be painted
    const behind = this.mesh.material.uniforms['uBehind'];
    if (behind) behind.value = 1 + BEHIND_PER_RANK * rank;
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    (this.mesh.material.uniforms['uPicture']?.value as Texture).dispose();
    this.mesh.material.dispose();
    this.bitmap.close();
  }
}

/** Shows exactly these, best first. */
export function showViews(group: Group, drawables: readonly (readonly [MappedView, DrawableView])[]): void {
  group.clear();
  drawables.forEach(([view, drawable], rank) => {
    drawable.place(view, rank);
    group.add(drawable.mesh);
  });
}
