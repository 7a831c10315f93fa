// The colours of the disparity picture, as the server paints them: viridis (van der Walt and Smith 2015) at eighths of its
// range, whole. The map's own viridis lacks the dark end, and would read depths wrong.

import { cssColour, type Rgb } from './palette';

const STOPS: readonly Rgb[] = [[68, 1, 84], [71, 44, 122], [59, 81, 139], [44, 113, 142], [33, 144, 141], [39, 173, 129], [92, 200, 99], [170, 220, 50], [253, 231, 37]];
const FARTHEST_COLOUR = 1200; // squared, of what still counts as a colour of the ramp

function colourAt(t: number): Rgb {
  const at = t * (STOPS.length - 1);
  const below = Math.min(Math.floor(at), STOPS.length - 2);
  const [a, b] = [STOPS[below] ?? [0, 0, 0], STOPS[below + 1] ?? [0, 0, 0]];
  return [0, 1, 2].map((i) => Math.round((a[i] ?? 0) + (at - below) * ((b[i] ?? 0) - (a[i] ?? 0)))) as unknown as Rgb;
}

const RAMP = Array.from({ length: 256 }, (_, i) => colourAt(i / 255));

/** For a scale beside the picture. */
export const RAMP_GRADIENT = `linear-gradient(90deg, ${STOPS.map(cssColour).join(', ')})`;

/** Place on the ramp, 0 to 1, of a colour; undefined for none of the ramp's (no match). Colours stand for what lies above them: half a step is added. */
export function placeOnRamp(r: number, g: number, b: number): number | undefined {
  let best = 0;
  let least = Infinity;
  for (let i = 0; i < 256; ++i) {
    const [ramp_r, ramp_g, ramp_b] = RAMP[i] ?? [0, 0, 0];
    const away = (ramp_r - r) ** 2 + (ramp_g - g) ** 2 + (ramp_b - b) ** 2;
    if (away < least) [least, best] = [away, i];
  }
  return least > FARTHEST_COLOUR ? undefined : (best + 0.5) / 255;
}
