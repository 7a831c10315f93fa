import { describe, expect, it } from 'vitest';
import { placeOnRamp } from './disparity_ramp';

describe('the ramp of disparities', () => {
  it('is read back to within a step where the server paints it', () => {
    // server/palette.cpp: eighths of viridis, straight lines between them, rounded; a value is painted by its floor of 255ths.
    const stops = [[68, 1, 84], [71, 44, 122], [59, 81, 139], [44, 113, 142], [33, 144, 141], [39, 173, 129], [92, 200, 99], [170, 220, 50], [253, 231, 37]];
    for (let value = 0; value < 255; value += 0.7) {
      const at = (Math.floor(value) / 255) * 8;
      const below = Math.min(7, Math.floor(at));
      const rgb = [0, 1, 2].map((i) => Math.round((stops[below]?.[i] ?? 0) + (at - below) * ((stops[below + 1]?.[i] ?? 0) - (stops[below]?.[i] ?? 0)))) as [number, number, number];
      expect(Math.abs((placeOnRamp(...rgb) ?? NaN) - value / 255)).toBeLessThan(1.5 / 255); // neighbours may share a colour
    }
  });

  it('does not take the dark grey of no match for a disparity', () => {
    expect(placeOnRamp(40, 40, 48)).toBeUndefined();
    expect(placeOnRamp(255, 255, 255)).toBeUndefined();
  });
});
