// The canvas that the map is painted on: when, and with how many pixels.

import { WebGLRenderer } from 'three';
import { FramePacer } from './frame_pacer';
import { hasGraphicsCard } from './graphics_card';
import { Sharpness } from './sharpness';

const MAX_RATIO = 2;
const TIMES_KEPT = 1000;
const ratioOfScreen = (): number => Math.min(MAX_RATIO, window.devicePixelRatio);

export class Picture {
  readonly renderer = new WebGLRenderer({ antialias: window.devicePixelRatio < 1.5 && hasGraphicsCard(), powerPreference: 'high-performance' });
  readonly pacer: FramePacer;
  /** When the last pictures were drawn, ms. */
  readonly times: number[] = [];
  private readonly sharpness = new Sharpness(ratioOfScreen());
  private sharpening = 0;

  constructor(private readonly paint: (now: number) => void) {
    const gl = this.renderer.getContext() as WebGL2RenderingContext;
    this.pacer = new FramePacer(gl, (now) => this.draw(now), (ms) => this.sharpness.took(ms, this.renderer.getPixelRatio()));
  }

  get canvas(): HTMLCanvasElement {
    return this.renderer.domElement;
  }

  /** Pixels per CSS pixel once it rests. */
  get fullRatio(): number {
    return ratioOfScreen();
  }

  request(): void {
    this.pacer.request();
  }

  /** A person moves it: rather coarse than late. */
  movedByHand(): void {
    this.sharpness.moved(performance.now());
    this.pacer.hurry = true;
  }

  resize(width: number, height: number): void {
    this.sharpness.setFull(ratioOfScreen());
    this.renderer.setSize(width, height);
  }

  private draw(now: number): void {
    const at = performance.now();
    if (this.times.push(at) > TIMES_KEPT) this.times.shift();
    const ratio = this.sharpness.ratio(at);
    if (ratio !== this.renderer.getPixelRatio()) this.renderer.setPixelRatio(ratio);
    this.pacer.hurry = this.sharpness.isMoving(at);
    this.paint(now);
    const sharpIn = this.sharpness.sharpIn(at);
    clearTimeout(this.sharpening);
    if (sharpIn !== undefined) this.sharpening = window.setTimeout(() => this.request(), sharpIn);
  }
}
