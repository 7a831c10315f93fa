// How many pixels are drawn per CSS pixel: all the screen has, but fewer on a slow machine while the view is moving.

import type { WebGLRenderer } from 'three';

const MOST = 2;
const SLOW_MS = 60; // for a picture: from here on it is drawn coarsely while it moves
const COARSE = 0.5; // of the pixels of a side
const RESTS_MS = 700; // without a move: sharp again

/** Without a graphics card the processor draws, some hundred times as slowly. */
export function drawnByProcessor(): boolean {
  const gl = document.createElement('canvas').getContext('webgl2');
  const about = gl?.getExtension('WEBGL_debug_renderer_info');
  const name = gl && about ? String(gl.getParameter(about.UNMASKED_RENDERER_WEBGL)) : '';
  gl?.getExtension('WEBGL_lose_context')?.loseContext();
  return /swiftshader|llvmpipe|software|basic render/i.test(name);
}

export class Sharpness {
  private coarse = false;
  private timer = 0;

  /** `changed`: the picture must be drawn anew. */
  constructor(private readonly renderer: WebGLRenderer, private readonly changed: () => void) {}

  /** Pixels that a CSS pixel should have. */
  get wanted(): number {
    return Math.min(MOST, window.devicePixelRatio) * (this.coarse ? COARSE : 1);
  }

  /** The view moves; pictures took so long lately. */
  moved(lateMs: number): void {
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => this.set(false), RESTS_MS);
    if (lateMs > SLOW_MS) this.set(true);
  }

  private set(coarse: boolean): void {
    if (coarse === this.coarse) return;
    this.coarse = coarse;
    this.renderer.setPixelRatio(this.wanted);
    this.changed();
  }
}
