// One camera's picture with the corners found in it and the areas where the board has been.
import { h } from '../ui/dom';
import type { Side } from './sitting';

const AREAS_PER_SIDE = 3;

export class CameraView {
  readonly element: HTMLElement;
  private readonly canvas = h('canvas', { width: 640, height: 480, role: 'img' });
  private picture: ImageBitmap | null = null;

  constructor(readonly side: 'left' | 'right') {
    this.canvas.setAttribute('aria-label', `${side} camera, with the corners found`);
    this.element = h('figure', { class: 'camera' }, h('figcaption', {}, side === 'left' ? 'Left camera' : 'Right camera'), this.canvas);
  }

  /** Takes the newest picture; the one before stays where it cannot be had. */
  async fetch(): Promise<void> {
    const response = await fetch(`./api/v1/calibrate/${this.side}`);
    if (!response.ok) return;
    const next = await createImageBitmap(await response.blob());
    this.picture?.close();
    this.picture = next;
  }

  draw(side: Side): void {
    const { picture, canvas } = this;
    const context = canvas.getContext('2d');
    if (!picture || !context) return;
    if (canvas.width !== picture.width || canvas.height !== picture.height) {
      canvas.width = picture.width;
      canvas.height = picture.height;
    }
    context.drawImage(picture, 0, 0);
    this.drawAreas(context, side.areas);
    this.drawCorners(context, side.corners);
  }

  /** Areas where the board has not been yet are dashed, the others tinted. */
  private drawAreas(context: CanvasRenderingContext2D, areas: readonly number[]): void {
    const width = this.canvas.width / AREAS_PER_SIDE, height = this.canvas.height / AREAS_PER_SIDE;
    const line = Math.max(1, this.canvas.width / 400);
    areas.forEach((count, i) => {
      const x = (i % AREAS_PER_SIDE) * width, y = Math.floor(i / AREAS_PER_SIDE) * height;
      context.fillStyle = 'rgb(70 211 154 / 0.16)';
      if (count > 0) context.fillRect(x, y, width, height);
      context.lineWidth = line;
      context.setLineDash(count > 0 ? [] : [6 * line, 6 * line]);
      context.strokeStyle = count > 0 ? 'rgb(70 211 154 / 0.5)' : 'rgb(242 189 75 / 0.9)';
      context.strokeRect(x + line, y + line, width - 2 * line, height - 2 * line);
    });
    context.setLineDash([]);
  }

  private drawCorners(context: CanvasRenderingContext2D, corners: readonly (readonly [number, number])[]): void {
    const radius = Math.max(2, this.canvas.width / 200);
    context.fillStyle = '#ff6b78';
    for (const [x, y] of corners) {
      context.beginPath();
      context.arc(x + 0.5, y + 0.5, radius, 0, 2 * Math.PI);
      context.fill();
    }
  }
}
