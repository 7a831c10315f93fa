// The way the camera went: a line with a dark or light casing, coloured by time or by how well it was tracked.

import { BufferAttribute, BufferGeometry, Color, Group, Points, PointsMaterial } from 'three';
import { Line2 } from 'three/examples/jsm/lines/Line2.js';
import { LineGeometry } from 'three/examples/jsm/lines/LineGeometry.js';
import { LineMaterial } from 'three/examples/jsm/lines/LineMaterial.js';
import { TrackingState, type TrajectoryPoint } from '../gen/flogmap/v1/map_pb';

const OLD = new Color('#8b6cff');
const NEW = new Color('#ff8a1f');
export const STATE_COLOURS: Record<TrackingState, Color> = {
  [TrackingState.INITIALISING]: new Color('#9aa4b2'),
  [TrackingState.OK]: new Color('#ff8a1f'),
  [TrackingState.WEAK]: new Color('#ffd23f'),
  [TrackingState.LOST]: new Color('#ff3b5c'),
};
const DOTS_APART_PX = 14;
const MAX_POINTS = 20000; // of the line; longer paths are thinned

export class PathLine {
  readonly group = new Group();
  private points: readonly TrajectoryPoint[] = [];
  private spacing = 0.1; // metres
  private cost = 0; // ms, of the last update
  private drawnAt = 0;
  private readonly casing = new LineMaterial({ color: '#000000', linewidth: 4.5, transparent: true, opacity: 0.45, depthTest: false });
  private readonly ink = new LineMaterial({ vertexColors: true, linewidth: 2.5, transparent: true, depthTest: false });
  private readonly lines: [Line2, Line2] = [new Line2(new LineGeometry(), this.casing), new Line2(new LineGeometry(), this.ink)];
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

  update(points: readonly TrajectoryPoint[], by: 'time' | 'state'): void {
    const start = performance.now();
    const step = Math.max(1, Math.ceil(points.length / MAX_POINTS));
    const shown = points.filter((point, i) => point.pose && (i % step === 0 || i === points.length - 1));
    this.group.visible = shown.length > 1;
    if (shown.length < 2) return;
    const positions = shown.flatMap(({ pose }) => (pose ? [pose.x, pose.y, pose.z] : []));
    const between = new Color();
    const colours = shown.flatMap((point, i) => (by === 'state' ? STATE_COLOURS[point.state] : between.lerpColors(OLD, NEW, i / (shown.length - 1))).toArray());
    for (const line of this.lines) {
      line.geometry.dispose();
      line.geometry = new LineGeometry();
      line.geometry.setPositions(positions);
      line.geometry.setColors(colours);
    }
    this.points = points;
    this.updateDots();
    this.cost = performance.now() - start;
    this.drawnAt = start;
  }

  /** A long path is not built anew with every pose: at most a tenth of the time goes into it. */
  restsUntil(): number {
    return this.drawnAt + 10 * this.cost;
  }

  /** `scale`: CSS pixels per metre. Dots of mapped views keep their distance, so that the line stays readable. */
  setScale(scale: number): void {
    const spacing = 2 ** Math.ceil(Math.log2(DOTS_APART_PX / scale));
    if (spacing === this.spacing) return;
    this.spacing = spacing;
    this.updateDots();
  }

  /** Line width needs to know the screen; `solid` puts the path at its true height among things. */
  resize(width: number, height: number): void {
    this.casing.resolution.set(width, height);
    this.ink.resolution.set(width, height);
  }

  setCasing(colour: string): void {
    this.casing.color.set(colour);
  }

  private updateDots(): void {
    const positions: number[] = [];
    let last: { x: number; y: number } | undefined;
    for (const { mapped, pose } of this.points) {
      if (!mapped || !pose || (last && Math.hypot(pose.x - last.x, pose.y - last.y) < this.spacing)) continue;
      positions.push(pose.x, pose.y, pose.z);
      last = pose;
    }
    this.dots.geometry.dispose();
    this.dots.geometry = new BufferGeometry();
    this.dots.geometry.setAttribute('position', new BufferAttribute(new Float32Array(positions), 3));
  }
}
