// How many pixels the picture is drawn with: as many as the screen has; fewer while it is moved by hand on a machine that
// is slow at drawing; all of them again as soon as it rests. Pure.

const AIM_MS = 25; // for a picture while it moves
const REST_MS = 180; // without a movement, until it is sharp again; longer where pictures take long:
const REST_PICTURES = 3; // of the last one's time, since movements come no more often than pictures
const LONGEST_REST_MS = 800;
const LEAST = 0.5; // per CSS pixel
const LEARNS = 0.4; // of a new picture's time

export class Sharpness {
  private movedAt = -Infinity;
  private sharpMs = 0; // for a sharp picture, lately
  private restMs = REST_MS;
  private coarse = 0; // pixels per CSS pixel of this movement; 0: as sharp as it can be

  /** `full`: pixels per CSS pixel of the screen. */
  constructor(private full: number) {}

  setFull(ratio: number): void {
    this.full = ratio;
  }

  moved(now: number): void {
    if (!this.isMoving(now)) this.coarse = this.chosen();
    this.movedAt = now;
  }

  isMoving(now: number): boolean {
    return now - this.movedAt < this.restMs;
  }

  ratio(now: number): number {
    return this.isMoving(now) && this.coarse > 0 ? this.coarse : this.full;
  }

  /** Milliseconds until it is to be drawn sharp; nothing if it is. */
  sharpIn(now: number): number | undefined {
    return this.ratio(now) < this.full ? this.movedAt + this.restMs - now : undefined;
  }

  /** A picture with `ratio` pixels per CSS pixel took so long. */
  took(ms: number, ratio: number): void {
    this.restMs = Math.min(LONGEST_REST_MS, Math.max(REST_MS, REST_PICTURES * ms));
    if (ratio < this.full) return;
    this.sharpMs = this.sharpMs > 0 ? this.sharpMs + LEARNS * (ms - this.sharpMs) : ms;
  }

  /** The time goes mostly with the number of pixels. In quarters: a buffer of another size costs time too. */
  private chosen(): number {
    if (this.sharpMs <= AIM_MS) return 0;
    const wanted = this.full * Math.sqrt(AIM_MS / this.sharpMs);
    return Math.min(this.full, Math.max(LEAST, Math.floor(wanted * 4) / 4));
  }
}
