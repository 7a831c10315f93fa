// At most one picture per animation frame, and none before the graphics card has finished the last: what is drawn is what
// was asked for now, and not what was a second ago. A slow machine gets a rest between pictures that nobody waits for.

const SLOW_MS = 50;
const MAX_REST_MS = 150;
const FORGETS = 0.7; // of how late it was, per picture
const ASK_MS = 4; // how often the card is asked whether it is done
const GIVE_UP_MS = 2000; // a card that never answers is not waited for

export class FramePacer {
  /** How long pictures had to wait for their turn lately, ms: how far behind the graphics card is. */
  lateMs = 0;
  /** From the start of the last picture until the card was done with it. */
  tookMs = 0;
  /** Someone moves the picture: no rests. */
  hurry = false;
  private scheduled = false;
  private drawing: { readonly fence: WebGLSync; readonly since: number } | null = null;

  constructor(private readonly gl: WebGL2RenderingContext, private readonly draw: (now: number) => void, private readonly done: (tookMs: number) => void) {}

  request(): void {
    if (this.scheduled) return;
    this.scheduled = true;
    const asked = performance.now();
    const rest = this.tookMs > SLOW_MS && !this.hurry ? Math.min(MAX_REST_MS, this.tookMs) : 0;
    if (rest > 0) setTimeout(() => this.wait(asked + rest), rest);
    else this.wait(asked);
  }

  private wait(asked: number): void {
    requestAnimationFrame((now) => {
      if (this.drawing) return this.wait(asked);
      this.lateMs = Math.max(performance.now() - asked, FORGETS * this.lateMs);
      this.scheduled = false;
      const since = performance.now();
      this.draw(now);
      const fence = this.gl.fenceSync(this.gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
      this.gl.flush();
      this.drawing = fence && { fence, since };
      if (fence) setTimeout(() => this.ask(), ASK_MS);
    });
  }

  private ask(): void {
    if (!this.drawing) return;
    const { fence, since } = this.drawing;
    const took = performance.now() - since;
    const busy = this.gl.getSyncParameter(fence, this.gl.SYNC_STATUS) === this.gl.UNSIGNALED;
    if (busy && took < GIVE_UP_MS) return void setTimeout(() => this.ask(), ASK_MS);
    this.gl.deleteSync(fence);
    this.drawing = null;
    this.tookMs = took;
    this.done(took);
  }
}
