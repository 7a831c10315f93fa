// Hands on the map: drag, wheel, pinch, twist, click and hover, by mouse, pen or fingers.

import { turnAt, zoomAt, type Point } from '../viewport';
import type { MapView } from './map_view';

const CLICK_SLOP_PX = 5;
const WHEEL_ZOOM = 0.0016;

export interface GestureListener {
  clicked(world: Point, event: PointerEvent): void;
  /** Undefined when the pointer leaves. */
  hovered(world: Point | undefined): void;
}

export class Gestures {
  private readonly pointers = new Map<number, Point>();
  private pressed: Point | null = null; // still a click, not yet a drag
  private turning = false;

  constructor(private readonly view: MapView, private readonly listener: GestureListener) {
    const { canvas } = view;
    canvas.addEventListener('pointerdown', (event) => this.down(event));
    canvas.addEventListener('pointermove', (event) => this.move(event));
    canvas.addEventListener('pointerup', (event) => this.up(event));
    canvas.addEventListener('pointercancel', (event) => this.pointers.delete(event.pointerId));
    canvas.addEventListener('pointerleave', () => listener.hovered(undefined));
    canvas.addEventListener('contextmenu', (event) => event.preventDefault());
    canvas.addEventListener('wheel', (event) => this.wheel(event), { passive: false });
    canvas.addEventListener('dblclick', (event) => this.view.zoomBy(2, this.local(event)));
  }

  private local(event: MouseEvent): Point {
    const box = this.view.canvas.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  }

  private down(event: PointerEvent): void {
    this.view.canvas.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, this.local(event));
    this.pressed = this.pointers.size === 1 && event.button === 0 ? this.local(event) : null;
    this.turning = event.button === 2 || event.button === 1 || event.shiftKey;
  }

  private move(event: PointerEvent): void {
    const now = this.local(event);
    const before = this.pointers.get(event.pointerId);
    if (!before) return this.listener.hovered(this.view.pick(now));
    if (this.pressed && Math.hypot(now.x - this.pressed.x, now.y - this.pressed.y) < CLICK_SLOP_PX) return;
    this.pressed = null;
    if (this.pointers.size === 2) this.pinch(event.pointerId, before, now);
    else if (this.turning) this.turn(now.x - before.x, now.y - before.y);
    else this.drag(before, now);
    this.pointers.set(event.pointerId, now);
  }

  private up(event: PointerEvent): void {
    this.pointers.delete(event.pointerId);
    if (!this.pressed) return;
    const world = this.view.pick(this.pressed);
    this.pressed = null;
    if (world) this.listener.clicked(world, event);
  }

  private drag(before: Point, now: Point): void {
    const a = this.view.pick(before);
    const b = this.view.pick(now);
    const { viewport } = this.view;
    if (a && b) this.view.moveTo({ ...viewport, x: viewport.x + a.x - b.x, y: viewport.y + a.y - b.y });
  }

  private turn(dx: number, dy: number): void {
    const { viewport, eye } = this.view;
    if (eye.solid) eye.tiltTo(eye.pitch - dy * 0.006);
    const middle = { x: viewport.width / 2, y: viewport.height / 2 };
    this.view.moveTo(turnAt(viewport, dx * 0.006, middle));
  }

  private pinch(id: number, before: Point, now: Point): void {
    const other = [...this.pointers].find(([key]) => key !== id)?.[1];
    if (!other) return;
    const from = { x: before.x - other.x, y: before.y - other.y };
    const to = { x: now.x - other.x, y: now.y - other.y };
    const middle = { x: (now.x + other.x) / 2, y: (now.y + other.y) / 2 };
    const twist = Math.atan2(to.y, to.x) - Math.atan2(from.y, from.x);
    const stretched = zoomAt(this.view.viewport, Math.hypot(to.x, to.y) / Math.max(1, Math.hypot(from.x, from.y)), middle);
    this.view.moveTo(turnAt(stretched, Math.atan2(Math.sin(twist), Math.cos(twist)), middle));
    this.view.panBy((now.x - before.x) / 2, (now.y - before.y) / 2);
  }

  private wheel(event: WheelEvent): void {
    event.preventDefault();
    const step = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? event.deltaY * 16 : event.deltaY;
    const faster = event.ctrlKey ? 4 : 1; // a pinch on a touch pad comes as a wheel with Ctrl
    this.view.zoomBy(Math.exp(-step * WHEEL_ZOOM * faster), this.local(event));
  }
}
