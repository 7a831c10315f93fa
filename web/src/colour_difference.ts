// How different two colours look, also to colour-blind eyes: the measure behind palette.test.ts.

import type { Rgb } from './palette';

export const VISIONS = ['normal', 'protanopia', 'deuteranopia', 'tritanopia'] as const;
export type Vision = (typeof VISIONS)[number];

// Machado, Oliveira and Fernandes (2009), severity 1, on linear RGB.
const SIMULATION: Record<Exclude<Vision, 'normal'>, readonly number[]> = {
  protanopia: [0.152286, 1.052583, -0.204868, 0.114503, 0.786281, 0.099216, -0.003882, -0.048116, 1.051998],
  deuteranopia: [0.367322, 0.860646, -0.227968, 0.280085, 0.672501, 0.047413, -0.01182, 0.04294, 0.968881],
  tritanopia: [1.255528, -0.076749, -0.178779, -0.078411, 0.930809, 0.147602, 0.004733, 0.691367, 0.3039],
};
const XYZ_FROM_RGB = [0.4124564, 0.3575761, 0.1804375, 0.2126729, 0.7151522, 0.072175, 0.0193339, 0.119192, 0.9503041];
const WHITE = [0.95047, 1, 1.08883];

type Triple = [number, number, number];

const multiply = (m: readonly number[], v: readonly number[]): Triple =>
  [0, 3, 6].map((row) => [0, 1, 2].reduce((sum, i) => sum + (m[row + i] ?? 0) * (v[i] ?? 0), 0)) as Triple;

const linear = (channel: number): number => {
  const c = channel / 255;
  return c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4;
};

/** CIE L*a*b* (D65) of a colour as a kind of eye sees it. */
export function labSeen(rgb: Rgb, vision: Vision): Triple {
  const light = rgb.map(linear);
  const seen = vision === 'normal' ? light : multiply(SIMULATION[vision], light).map((c) => Math.min(1, Math.max(0, c)));
  const f = (t: number): number => (t > 216 / 24389 ? Math.cbrt(t) : ((24389 / 27) * t + 16) / 116);
  const [x, y, z] = multiply(XYZ_FROM_RGB, seen).map((value, i) => f(value / (WHITE[i] ?? 1))) as Triple;
  return [116 * y - 16, 500 * (x - y), 200 * (y - z)];
}

const degrees = Math.PI / 180;
const hue = (a: number, b: number): number => (a === 0 && b === 0 ? 0 : (Math.atan2(b, a) / degrees + 360) % 360);

/** CIEDE2000 (Sharma, Wu and Dalal 2005) between two L*a*b* colours. */
export function ciede2000(first: Triple, second: Triple): number {
  const [L1, a1, b1] = first;
  const [L2, a2, b2] = second;
  const chroma7 = ((Math.hypot(a1, b1) + Math.hypot(a2, b2)) / 2) ** 7;
  const g = 1 + 0.5 * (1 - Math.sqrt(chroma7 / (chroma7 + 25 ** 7)));
  const C1 = Math.hypot(g * a1, b1);
  const C2 = Math.hypot(g * a2, b2);
  const h1 = hue(g * a1, b1);
  const h2 = hue(g * a2, b2);
  const grey = C1 * C2 === 0;
  const turn = grey ? 0 : ((h2 - h1 + 540) % 360) - 180;
  const dH = 2 * Math.sqrt(C1 * C2) * Math.sin((turn / 2) * degrees);
  const L = (L1 + L2) / 2;
  const C = (C1 + C2) / 2;
  const h = grey ? h1 + h2 : (h1 + turn / 2 + 360) % 360;
  const T = 1 - 0.17 * Math.cos((h - 30) * degrees) + 0.24 * Math.cos(2 * h * degrees)
    + 0.32 * Math.cos((3 * h + 6) * degrees) - 0.2 * Math.cos((4 * h - 63) * degrees);
  const lightness = (L2 - L1) / (1 + (0.015 * (L - 50) ** 2) / Math.sqrt(20 + (L - 50) ** 2));
  const saturation = (C2 - C1) / (1 + 0.045 * C);
  const tone = dH / (1 + 0.015 * C * T);
  const rotation = -2 * Math.sqrt(C ** 7 / (C ** 7 + 25 ** 7)) * Math.sin(60 * Math.exp(-(((h - 275) / 25) ** 2)) * degrees);
  return Math.sqrt(lightness ** 2 + saturation ** 2 + tone ** 2 + rotation * saturation * tone);
}

/** CIEDE2000 between two colours as a kind of eye sees them. */
export const differenceSeen = (a: Rgb, b: Rgb, vision: Vision): number => ciede2000(labSeen(a, vision), labSeen(b, vision));
