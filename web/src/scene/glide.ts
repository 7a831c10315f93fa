// A view that glides to where it is wanted; where motion is not liked, it jumps.

import { pixelsApart, towards, type Viewport } from '../viewport';

const EASE_PER_S = 9;
const THERE_PX = 0.4;

export class Glide {
  /** Where it is wanted; null: where it is. */
  target: Viewport | null = null;

  /** The view `seconds` later; undefined if it rests. */
  step(from: Viewport, seconds: number): Viewport | undefined {
    const to = this.target;
    if (!to) return undefined;
    const t = matchMedia('(prefers-reduced-motion: reduce)').matches ? 1 : 1 - Math.exp(-EASE_PER_S * seconds);
    const next = towards(from, to, t);
    if (pixelsApart(next, to) >= THERE_PX) return next;
    this.target = null;
    return { ...to, width: from.width, height: from.height };
  }
}
