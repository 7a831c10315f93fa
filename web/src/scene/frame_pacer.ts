// At most one picture per animation frame; a machine that is slow at it gets a rest after each: the page must stay alive.

const SLOW_MS = 100;
const MAX_REST_MS = 500;

export class FramePacer {
  private scheduled = false;
  private waited = 0; // ms that the last frame had to wait for its turn

  constructor(private readonly draw: (now: number) => void) {}

  request(): void {
    if (this.scheduled) return;
    this.scheduled = true;
    setTimeout(() => {
      const asked = performance.now();
      requestAnimationFrame((now) => {
        this.waited = performance.now() - asked;
        this.scheduled = false;
        this.draw(now);
      });
    }, this.waited > SLOW_MS ? Math.min(MAX_REST_MS, this.waited) : 0);
  }
}
