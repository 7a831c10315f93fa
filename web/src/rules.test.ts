import { readFileSync } from 'node:fs';
import { describe, expect, it } from 'vitest';
import { classify, conflictValue, mapValue, motionValue, planningValue, seenFromConfidence, STYLES, styleValue, type Operators } from './rules';

// E, O, K, then M by minmax, algebraic, lukasiewicz: the table of FLOG.md section 5.
const TABLE: [string, number, number, number, number, number, number][] = [
  ['unknown', 0, 0, 0, 0, 0, 0],
  ['free', 1, 0, 1, 0, 0, 0],
  ['occupied', 0, 1, 1, 1, 1, 1],
  ['occupied, little known', 0, 1, 0.2, 0.2, 0.2, 0.2],
  ['half', 0.5, 0.5, 1, 0.5, 0.5625, 1],
  ['mostly free', 0.8, 0.2, 1, 0.2, 0.3024, 0.4],
  ['mostly occupied', 0.2, 0.8, 1, 0.8, 0.8064, 1],
  ['shadow', 0, 0.5, 1, 0.5, 0.5, 0.5],
];

describe('map value', () => {
  it.each(TABLE)('of a cell that is %s', (_name, E, O, K, minmax, algebraic, lukasiewicz) => {
    expect(mapValue('minmax', E, O, K)).toBeCloseTo(minmax, 6);
    expect(mapValue('algebraic', E, O, K)).toBeCloseTo(algebraic, 6);
    expect(mapValue('lukasiewicz', E, O, K)).toBeCloseTo(lukasiewicz, 6);
  });
});

interface Golden {
  operators: Operators; E: number; O: number; K: number; M: number; M_p: number; M_m: number; conflict: number;
}

describe('golden values', () => {
  const golden = JSON.parse(readFileSync(new URL('../../tests/golden/map_values.json', import.meta.url), 'utf8')) as Golden[];
  it('are the same here and in the program', () => {
    expect(golden.length).toBeGreaterThan(100);
    for (const { operators, E, O, K, M, M_p, M_m, conflict } of golden) {
      const where = `${operators} E ${E} O ${O} K ${K}`;
      expect(Math.abs(mapValue(operators, E, O, K) - M), `M, ${where}`).toBeLessThan(1e-5);
      expect(Math.abs(planningValue(operators, O, K) - M_p), `M_p, ${where}`).toBeLessThan(1e-5);
      expect(Math.abs(motionValue(operators, E, O, K) - M_m), `M_m, ${where}`).toBeLessThan(1e-5);
      expect(Math.abs(conflictValue(E, O, K) - conflict), `conflict, ${where}`).toBeLessThan(1e-5);
    }
  });
});

describe('the safe maps', () => {
  it('take the unknown for free when planning and for occupied when moving', () => {
    for (const operators of ['algebraic', 'minmax', 'lukasiewicz'] as const) {
      expect(planningValue(operators, 0, 0)).toBe(0);
      expect(motionValue(operators, 0, 0, 0)).toBe(1);
      expect(planningValue(operators, 0, 1)).toBe(0);
      expect(motionValue(operators, 1, 0, 1)).toBe(0);
      expect(planningValue(operators, 1, 1)).toBe(1);
      expect(motionValue(operators, 0, 1, 1)).toBe(1);
    }
  });
  it('keep a robot out of free space that is hardly known', () => {
    expect(motionValue('algebraic', 1, 0, 0.2)).toBeCloseTo(0.96, 6);
    expect(motionValue('minmax', 1, 0, 0.2)).toBeCloseTo(0.8, 6);
    expect(motionValue('lukasiewicz', 1, 0, 0.2)).toBeCloseTo(1, 6);
  });
});

describe('every style', () => {
  it('stays in [0, 1] over the whole cube of evidence', () => {
    const steps = [0, 0.1, 0.25, 0.5, 0.75, 0.9, 1];
    for (const style of STYLES)
      for (const operators of ['algebraic', 'minmax', 'lukasiewicz'] as const)
        for (const E of steps) for (const O of steps.filter((o) => E + o <= 1)) for (const K of steps) {
          const value = styleValue(style, operators, { E, O, K, C: K });
          expect(value).toBeGreaterThanOrEqual(0);
          expect(value).toBeLessThanOrEqual(1 + 1e-12);
        }
  });
  it('calls conflict what is as empty as occupied, and nothing else', () => {
    expect(conflictValue(0.5, 0.5, 1)).toBe(1);
    expect(conflictValue(1, 0, 1)).toBe(0);
    expect(conflictValue(0.5, 0.5, 0)).toBe(0);
  });
});

describe('classes', () => {
  const seenFrom = seenFromConfidence(8, 823);
  it('need rays, and then K does not decide what is an obstacle', () => {
    expect(classify('visual', 'algebraic', { E: 0, O: 1, K: 0, C: 0 }, seenFrom, 0.3)).toBe('unknown');
    expect(classify('visual', 'algebraic', { E: 0, O: 1, K: 3 / 255, C: 0 }, seenFrom, 0.3)).toBe('occupied');
    expect(classify('visual', 'algebraic', { E: 1, O: 0, K: 3 / 255, C: 0 }, seenFrom, 0.3)).toBe('free');
  });
  it('never call a cell seen that no ray has met', () => {
    expect(seenFromConfidence(8, 1e9)).toBeGreaterThan(0);
    expect(seenFromConfidence(0, 100)).toBeGreaterThan(0);
  });
});
