// The eye: from straight above for the flat map, from a distance and an angle for the solid one.

import { OrthographicCamera, PerspectiveCamera, Vector3, type Camera } from 'three';
import type { Point, Viewport } from '../viewport';
import { screenFromWorld, worldFromScreen } from '../viewport';

const FIELD_OF_VIEW = 35; // degrees, vertical
const MAX_PITCH = (82 * Math.PI) / 180;

export class ViewCamera {
  pitch = 0.95; // of the solid view, from the vertical, radians
  solid = false;
  /** Height that the solid view looks at, metres: the middle of layers that are spread apart. */
  aim = 0;
  private readonly flat = new OrthographicCamera(-1, 1, 1, -1, -200, 200);
  private readonly deep = new PerspectiveCamera(FIELD_OF_VIEW, 1, 0.05, 2000);

  get camera(): Camera {
    return this.solid ? this.deep : this.flat;
  }

  tiltTo(pitch: number): void {
    this.pitch = Math.min(MAX_PITCH, Math.max(0, pitch));
  }

  update(view: Viewport): void {
    if (this.solid) this.updateDeep(view);
    else this.updateFlat(view);
  }

  /** CSS pixel of a world point. */
  project(view: Viewport, x: number, y: number, z: number): Point {
    if (!this.solid) return screenFromWorld(view, { x, y });
    const p = new Vector3(x, y, z).project(this.deep);
    if (p.z > 1) return { x: -1e5, y: -1e5 }; // behind the eye
    return { x: ((p.x + 1) / 2) * view.width, y: ((1 - p.y) / 2) * view.height };
  }

  /** World point on the ground under a CSS pixel; undefined above the horizon. */
  pick(view: Viewport, pixel: Point): Point | undefined {
    if (!this.solid) return worldFromScreen(view, pixel);
    const far = new Vector3((2 * pixel.x) / view.width - 1, 1 - (2 * pixel.y) / view.height, 0.5).unproject(this.deep);
    const eye = this.deep.position;
    const down = eye.z - far.z;
    if (down <= 1e-6) return undefined;
    const t = eye.z / down;
    return { x: eye.x + t * (far.x - eye.x), y: eye.y + t * (far.y - eye.y) };
  }

  private updateFlat(view: Viewport): void {
    const halfX = view.width / 2 / view.scale;
    const halfY = view.height / 2 / view.scale;
    Object.assign(this.flat, { left: -halfX, right: halfX, top: halfY, bottom: -halfY });
    this.flat.position.set(view.x, view.y, 0);
    this.flat.rotation.set(0, 0, view.turn);
    this.flat.updateProjectionMatrix();
    this.flat.updateMatrixWorld();
  }

  private updateDeep(view: Viewport): void {
    const distance = view.height / 2 / view.scale / Math.tan((FIELD_OF_VIEW / 2) * (Math.PI / 180));
    this.deep.aspect = view.width / view.height;
    this.deep.near = Math.max(0.02, distance / 200);
    this.deep.far = distance * 12 + 50;
    const back = distance * Math.sin(this.pitch);
    this.deep.position.set(view.x + back * Math.sin(view.turn), view.y - back * Math.cos(view.turn), this.aim + distance * Math.cos(this.pitch));
    this.deep.up.set(-Math.sin(view.turn), Math.cos(view.turn), 0);
    if (this.pitch > 0.01) this.deep.up.set(0, 0, 1);
    this.deep.lookAt(view.x, view.y, this.aim);
    this.deep.updateProjectionMatrix();
    this.deep.updateMatrixWorld();
  }
}
