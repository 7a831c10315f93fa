// Values to colours, once for the shader (as a lookup texture), the legend and the tests. All colours are sRGB.

export type Rgb = readonly [number, number, number]; // each 0..255

export const PALETTES = ['cividis', 'viridis', 'grey', 'contrast'] as const;
export type PaletteName = (typeof PALETTES)[number];
export type Theme = 'dark' | 'light';

export const PALETTE_TITLES: Record<PaletteName, string> = {
  cividis: 'Cividis',
  viridis: 'Viridis',
  grey: 'Paper grey',
  contrast: 'High contrast',
};

/** How the four kinds of cell look; unknown and conflict are hatched as well. */
export interface ClassColours {
  readonly unknown: Rgb;
  readonly free: Rgb;
  readonly occupied: Rgb;
  readonly conflict: Rgb;
}

// Evenly spaced stops from value 0 to value 1. Cividis and viridis: the published maps of Nuñez et al. (2018) and
// van der Walt and Smith (2015), without their darkest end, so that free stands out from unknown. Grey: 255 (1 - M), as the paper prints its maps.
const STOPS: Record<PaletteName, readonly string[]> = {
  cividis: ['123570', '3b496c', '575d6d', '707173', '8a8678', 'a59c74', 'c3b369', 'e1cc55', 'fee838'],
  viridis: ['482475', '414487', '355f8d', '2a788e', '21918c', '22a884', '44bf70', '7ad151', 'bddf26', 'fde725'],
  grey: ['ffffff', '000000'],
  contrast: ['ffffff', '000000'],
};

const UNKNOWN: Record<Theme, Record<PaletteName, string>> = {
  dark: { cividis: '15171b', viridis: '15171b', grey: '40454d', contrast: '424242' },
  light: { cividis: 'd3d7dd', viridis: 'd3d7dd', grey: 'b4b9c1', contrast: '9a9a9a' },
};
const CONFLICT: Record<PaletteName, string> = { cividis: 'ff5d8f', viridis: 'ff6b5e', grey: 'e0408a', contrast: 'ff2d6f' };

// Layers by height, lowest first; interpolated when there are more.
const LAYER_STOPS: Record<Theme, readonly string[]> = {
  dark: ['38a9f0', 'f2c14e', 'f06a9b'],
  light: ['0a6fc2', 'b97800', 'b01a5c'],
};

export const rgbFromHex = (hex: string): Rgb => [0, 2, 4].map((at) => parseInt(hex.slice(at, at + 2), 16)) as unknown as Rgb;
export const cssColour = (rgb: Rgb): string => `rgb(${rgb.map((c) => Math.round(c)).join(' ')})`;
export const mixColours = (a: Rgb, b: Rgb, t: number): Rgb =>
  [0, 1, 2].map((i) => (a[i] ?? 0) + ((b[i] ?? 0) - (a[i] ?? 0)) * t) as unknown as Rgb;

function alongStops(stops: readonly string[], t: number): Rgb {
  const at = Math.min(1, Math.max(0, t)) * (stops.length - 1);
  const low = Math.min(stops.length - 1, Math.floor(at));
  const high = Math.min(stops.length - 1, low + 1);
  return mixColours(rgbFromHex(stops[low] ?? '000000'), rgbFromHex(stops[high] ?? '000000'), at - low);
}

/** Colour of a value in [0, 1]. */
export const rampColour = (palette: PaletteName, value: number): Rgb => alongStops(STOPS[palette], value);

/** The ramp as 256 RGBA texels, index = round(255 value). */
export function rampTexels(palette: PaletteName): Uint8Array {
  const texels = new Uint8Array(256 * 4);
  for (let i = 0; i < 256; ++i) texels.set([...rampColour(palette, i / 255).map(Math.round), 255], i * 4);
  return texels;
}

export function classColours(palette: PaletteName, theme: Theme): ClassColours {
  return {
    unknown: rgbFromHex(UNKNOWN[theme][palette]),
    free: rampColour(palette, 0),
    occupied: rampColour(palette, 1),
    conflict: rgbFromHex(CONFLICT[palette]),
  };
}

/** Colour of layer `index` of `count`, counted from the lowest. */
export function layerColour(index: number, count: number, theme: Theme): Rgb {
  return alongStops(LAYER_STOPS[theme], count > 1 ? index / (count - 1) : 0.5);
}
