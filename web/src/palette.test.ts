import { describe, expect, it } from 'vitest';
import { ciede2000, differenceSeen, labSeen, VISIONS } from './colour_difference';
import { classColours, layerColour, PALETTES, rampColour, rampTexels, type Rgb } from './palette';

describe('CIEDE2000', () => {
  it('agrees with the published test pairs', () => { // Sharma, Wu and Dalal (2005), table 1
    expect(ciede2000([50, 2.6772, -79.7751], [50, 0, -82.7485])).toBeCloseTo(2.0425, 3);
    expect(ciede2000([50, -1.3802, -84.2814], [50, 0, -82.7485])).toBeCloseTo(1.0, 3);
    expect(ciede2000([50, 2.5, 0], [73, 25, -18])).toBeCloseTo(27.1492, 3);
    expect(ciede2000([60.2574, -34.0099, 36.2677], [60.4626, -34.1751, 39.4387])).toBeCloseTo(1.2644, 3);
    expect(ciede2000([2.0776, 0.0795, -1.135], [0.9033, -0.0636, -0.5514])).toBeCloseTo(0.9082, 3);
  });
  it('is zero between equals', () => expect(differenceSeen([10, 200, 90], [10, 200, 90], 'protanopia')).toBe(0));
});

describe('the classes of every palette, in both themes and to every eye', () => {
  for (const palette of PALETTES)
    for (const theme of ['dark', 'light'] as const)
      for (const vision of VISIONS)
        it(`${palette}, ${theme}, ${vision}`, () => {
          const colours = Object.entries(classColours(palette, theme)) as [string, Rgb][];
          for (const [i, [name, a]] of colours.entries())
            for (const [other, b] of colours.slice(i + 1))
              expect(differenceSeen(a, b, vision), `${name} and ${other}`).toBeGreaterThanOrEqual(15);
        });
});

describe('layers by height', () => {
  it('differ for every eye while there are three', () => {
    for (const theme of ['dark', 'light'] as const)
      for (const vision of VISIONS)
        for (const [a, b] of [[0, 1], [1, 2], [0, 2]] as const)
          expect(differenceSeen(layerColour(a, 3, theme), layerColour(b, 3, theme), vision), `${theme} ${vision} ${a} ${b}`).toBeGreaterThanOrEqual(15);
  });
});

describe('ramps', () => {
  it('only ever get lighter or darker, so that more looks like more', () => {
    for (const palette of PALETTES) {
      const lightness = Array.from({ length: 64 }, (_, i) => labSeen(rampColour(palette, i / 63), 'normal')[0]);
      const direction = Math.sign((lightness.at(-1) ?? 0) - (lightness[0] ?? 0));
      for (let i = 1; i < lightness.length; ++i) expect(((lightness[i] ?? 0) - (lightness[i - 1] ?? 0)) * direction).toBeGreaterThan(0);
    }
  });
  it('print the paper grey as 255 (1 - M)', () => {
    const texels = rampTexels('grey');
    for (let i = 0; i < 256; ++i) expect(texels[4 * i]).toBe(255 - i);
  });
});
