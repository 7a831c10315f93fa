// At most one picture per animation frame; a machine that is slow at it gets a rest after each: the page must stay alive.

const SLOW_MS = 100;
const MAX_REST_MS = 150;
const FORGETS = 0.7; // of how slow it was, per picture

export class FramePacer {
  /** How long pictures had to wait for their turn lately, ms: how far behind the graphics card is. */
  lateMs = 0;
  private scheduled = false;

  constructor(private readonly draw: (now: number) => void) {}

  request(): void {
    if (this.scheduled) return;
    this.scheduled = true;
    setTimeout(() => {
      const asked = performance.now();
      requestAnimationFrame((now) => {
        this.lateMs = Math.max(performance.now() - asked, FORGETS * this.lateMs);
        this.scheduled = false;
        this.draw(now);
      });
    }, this.lateMs > SLOW_MS ? Math.min(MAX_REST_MS, this.lateMs / 2) : 0);
  }
}
