// The camera where it is now: a dot, its field of view on the ground, and a frustum in the solid view.

import { BufferAttribute, BufferGeometry, CanvasTexture, CircleGeometry, Color, DoubleSide, Group, LineBasicMaterial, LineSegments, Mesh, MeshBasicMaterial, SRGBColorSpace } from 'three';
import { worldFromCamera, type Vector } from '../geometry';
import { TrackingState, type PoseValue } from '../gen/flogmap/v1/map_pb';
import type { CameraModel } from '../gen/flogmap/v1/stream_pb';

const REACH_PX = 50; // of the field of view on the flat map
const DOT_PX = 6;
const FAN_OPACITY = 0.16;
const FAN_OPACITY_SOLID = 0.05; // the picture is seen through it

export class CameraMarker {
  readonly group = new Group();
  private readonly colour = new Color('#ff8a1f');
  private readonly fan = new Mesh(new BufferGeometry(), new MeshBasicMaterial({ color: this.colour, transparent: true, opacity: FAN_OPACITY, side: DoubleSide, depthTest: false }));
  private readonly edge = new LineSegments(new BufferGeometry(), new LineBasicMaterial({ color: this.colour, depthTest: false, transparent: true }));
  private readonly rim = new Mesh(new CircleGeometry(1, 32), new MeshBasicMaterial({ color: '#ffffff', depthTest: false, transparent: true }));
  private readonly dot = new Mesh(new CircleGeometry(1, 32), new MeshBasicMaterial({ color: this.colour, depthTest: false, transparent: true }));

  // The live picture at the far end of the frustum, in the solid view.
  private readonly picture = new Mesh(new BufferGeometry(), new MeshBasicMaterial({ side: DoubleSide, transparent: true, opacity: 0.95 }));

  constructor() {
    this.picture.geometry.setAttribute('uv', new BufferAttribute(new Float32Array([0, 0, 1, 0, 1, 1, 0, 0, 1, 1, 0, 1]), 2));
    this.picture.visible = this.picture.frustumCulled = false;
    [this.fan, this.edge, this.rim, this.dot].forEach((part, i) => {
      part.frustumCulled = false;
      part.renderOrder = 30 + i;
    });
    this.group.add(this.fan, this.edge, this.rim, this.dot, this.picture);
    this.group.visible = false;
  }

  setState(state: TrackingState): void {
    this.colour.set(state === TrackingState.LOST ? '#ff3b5c' : state === TrackingState.WEAK ? '#e0a800' : '#ff8a1f');
    for (const part of [this.fan, this.edge, this.dot]) part.material.color.copy(this.colour);
  }

  /** Decodes a picture and frees the one before; rejects if it cannot be read. */
  async load(image: { readonly data: Uint8Array<ArrayBuffer>; readonly mediaType: string }): Promise<void> {
    const bitmap = await createImageBitmap(new Blob([image.data], { type: image.mediaType }));
    const { material } = this.picture;
    (material.map?.image as ImageBitmap | undefined)?.close();
    material.map?.dispose();
    material.map = new CanvasTexture(bitmap);
    material.map.colorSpace = SRGBColorSpace;
    material.map.flipY = false;
    material.needsUpdate = true;
  }

  /** `scale`: CSS pixels per metre at the camera; sizes stay the same on screen while one zooms. */
  place(pose: PoseValue, camera: CameraModel | null, scale: number, solid: boolean): void {
    this.group.visible = true;
    const reach = (solid ? 1.6 : 1) * (REACH_PX / scale);
    this.fan.material.opacity = solid ? FAN_OPACITY_SOLID : FAN_OPACITY;
    this.picture.visible = solid && this.picture.material.map !== null;
    const corners = cornerRays(camera).map(([x, y]): Vector => worldFromCamera(pose, [x * reach, y * reach, reach]));
    const tip: Vector = [pose.x, pose.y, pose.z];
    this.setFan(tip, corners);
    const radius = DOT_PX / scale;
    for (const [part, size] of [[this.rim, radius * 1.35], [this.dot, radius]] as const) {
      part.position.set(pose.x, pose.y, pose.z + 0.01);
      part.scale.setScalar(size);
    }
  }

  private setFan(tip: Vector, corners: readonly Vector[]): void {
    const [a, b, c, d] = corners;
    if (!a || !b || !c || !d) return;
    const triangles = [tip, a, b, tip, b, c, tip, c, d, tip, d, a].flat();
    const lines = [tip, a, tip, b, tip, c, tip, d, a, b, b, c, c, d, d, a].flat();
    setPositions(this.fan.geometry, triangles);
    setPositions(this.edge.geometry, lines);
    setPositions(this.picture.geometry, [a, b, c, a, c, d].flat());
  }
}

/** Directions of the picture's corners at depth 1. */
function cornerRays(camera: CameraModel | null): [number, number][] {
  const f = camera?.focalPx || 1;
  const x0 = camera ? -camera.cxPx / f : -0.8;
  const x1 = camera ? (camera.widthPx - camera.cxPx) / f : 0.8;
  const y0 = camera ? -camera.cyPx / f : -0.5;
  const y1 = camera ? (camera.heightPx - camera.cyPx) / f : 0.5;
  return [[x0, y0], [x1, y0], [x1, y1], [x0, y1]];
}

function setPositions(geometry: BufferGeometry, values: number[]): void {
  const old = geometry.getAttribute('position') as BufferAttribute | undefined;
  if (old && old.array.length === values.length) {
    (old.array as Float32Array).set(values);
    old.needsUpdate = true;
  } else geometry.setAttribute('position', new BufferAttribute(new Float32Array(values), 3));
}
