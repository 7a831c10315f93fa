// Disparities read back from the picture that shows them, within a triangle that somebody pointed out.

import type { ImageEvent } from './decode';
import { inTriangle, type Sample } from './level';
import { rampColour } from './palette';

const FARTHEST_COLOUR = 2500; // squared, of what still counts as a colour of the ramp
const HALF_A_STEP = 0.5 / 255; // colours are rounded down
const WANTED_SAMPLES = 6000;

/** Place on the ramp, 0 to 1, of a colour; undefined for none of the ramp's (no match). */
export function placeOnRamp(r: number, g: number, b: number): number | undefined {
  let best = 0;
  let least = Infinity;
  for (let i = 0; i < 256; ++i) {
    const [ramp_r, ramp_g, ramp_b] = RAMP[i] ?? [0, 0, 0];
    const away = (ramp_r - r) ** 2 + (ramp_g - g) ** 2 + (ramp_b - b) ** 2;
    if (away < least) [least, best] = [away, i];
  }
  return least > FARTHEST_COLOUR ? undefined : best / 255;
}

const RAMP = Array.from({ length: 256 }, (_, i) => rampColour('viridis', i / 255));

/** `corners`: shares of the picture's width and height. Places in pixels of the camera's full size. */
export async function samplesIn(image: ImageEvent, corners: readonly { readonly x: number; readonly y: number }[]): Promise<Sample[]> {
  const bitmap = await createImageBitmap(new Blob([image.data], { type: image.mediaType }));
  const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
  const context = canvas.getContext('2d', { willReadFrequently: true });
  context?.drawImage(bitmap, 0, 0);
  bitmap.close();
  const data = context?.getImageData(0, 0, canvas.width, canvas.height).data;
  if (!data) return [];
  const step = Math.max(1, Math.floor(Math.sqrt((canvas.width * canvas.height) / WANTED_SAMPLES / 4)));
  const samples: Sample[] = [];
  for (let y = 0; y < canvas.height; y += step)
    for (let x = 0; x < canvas.width; x += step) {
      const [u, v] = [(x + 0.5) / canvas.width, (y + 0.5) / canvas.height];
      if (!inTriangle(u, v, corners)) continue;
      const at = 4 * (y * canvas.width + x);
      const place = placeOnRamp(data[at] ?? 0, data[at + 1] ?? 0, data[at + 2] ?? 0);
      if (place === undefined || place === 0) continue; // the ramp's end is what was not matched
      samples.push({ x: u * image.fullSize[0] - 0.5, y: v * image.fullSize[1] - 0.5, d: image.scale[0] + (place + HALF_A_STEP) * (image.scale[1] - image.scale[0]) });
    }
  return samples;
}
