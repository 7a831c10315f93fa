// Disparities read back from the picture that shows them, within a triangle that somebody pointed out.

import type { ImageEvent } from './decode';
import { placeOnRamp } from './disparity_ramp';
import { inTriangle, type Sample } from './level';

const WANTED_SAMPLES = 6000;

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
      if (place === undefined || place > 1) continue; // beyond the scale
      samples.push({ x: u * image.fullSize[0] - 0.5, y: v * image.fullSize[1] - 0.5, d: image.scale[0] + place * (image.scale[1] - image.scale[0]) });
    }
  return samples;
}
