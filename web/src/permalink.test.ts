import { describe, expect, it } from 'vitest';
import { linkHash, readHash } from './permalink';
import { DEFAULTS, restoreSettings } from './settings';

describe('permalink', () => {
  it('brings back view, layers, style, cell and revision', () => {
    const settings = { ...DEFAULTS, style: 'motion', palette: 'viridis', operators: 'minmax', threshold: 0.42, solid: true, spread: 0.6, clipHeight: 2.5, layers: { 1: { visible: false, opacity: 1 }, 2: { visible: true, opacity: 0.5 } } } as const;
    const hash = linkHash({ epoch: 'k7', rev: 1234n, view: { x: 1.25, y: -3.5, scale: 77.125, turn: 0.5 }, cell: { x: 0.1, y: -0.2 }, pitch: 0.7, settings, layers: [0, 1, 2] });
    expect(readHash(hash)).toEqual({
      epoch: 'k7', rev: 1234n, view: { x: 1.25, y: -3.5, scale: 77.125, turn: 0.5 }, cell: { x: 0.1, y: -0.2 }, pitch: 0.7,
      settings: { style: 'motion', palette: 'viridis', operators: 'minmax', threshold: 0.42, solid: true, spread: 0.6, clipHeight: 2.5, layers: { 0: { visible: true, opacity: 1 }, 1: { visible: false, opacity: 1 }, 2: { visible: true, opacity: 0.5 } } },
    });
  });
  it('leaves out what makes no sense', () => {
    for (const hash of ['', '#', '#v=1,2&s=nonsense&r=x&c=a,b&l=9', '#v=1,2,-5,0', '#v=NaN,1,1,1', '#d=1&a=1,2']) {
      const linked = readHash(hash);
      expect(linked.view).toBeUndefined();
      expect(linked.cell).toBeUndefined();
      expect(linked.rev).toBeUndefined();
      expect(linked.pitch).toBeUndefined();
      expect(linked.settings.style).toBeUndefined();
      expect(linked.settings.layers).toBeUndefined();
    }
  });
});

describe('kept settings', () => {
  it('come back as they were', () => {
    const settings = { ...DEFAULTS, style: 'planning', threshold: 0.6, layers: { 3: { visible: false, opacity: 0.25 } } } as const;
    expect(restoreSettings(JSON.stringify(settings))).toEqual(settings);
  });
  it('fall back wherever they are missing, damaged or of another version', () => {
    expect(restoreSettings(null)).toEqual(DEFAULTS);
    expect(restoreSettings('{nonsense')).toEqual(DEFAULTS);
    expect(restoreSettings('[]')).toEqual(DEFAULTS);
    expect(restoreSettings('{"style":"rainbow","threshold":"high","palette":7,"follow":"me"}')).toEqual(DEFAULTS);
    expect(restoreSettings('{"threshold":99}').threshold).toBe(1);
  });
});
