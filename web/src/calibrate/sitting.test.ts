import { describe, expect, it } from 'vitest';
import { headline, shareDone, verdictRows, type Sitting } from './sitting';

const side = (count: number) => ({ corners: [], areas: new Array<number>(9).fill(count) });
const start: Sitting = {
  phase: 'looking', frame: 0, width_px: 640, height_px: 480, left: side(0), right: side(0), kept: false, pairs: 0,
  pairs_wanted: 15, tilted: [false, false, false, false], advice: '', enough: false, progress: 0, verdict: null,
  problem: '', file: 'calib.yaml',
};
const verdict = { grade: 'good', rms_px: 0.123, epipolar_p95_px: 0.2, baseline_m: 0.0601, baseline_sigma_m: 0.0001, field_of_view_rad: Math.PI / 2, pairs: 20, advice: [] } as const;

describe('a calibration sitting', () => {
  it('is done when every area, every tilt and enough pairs are there, and not before', () => {
    expect(shareDone(start)).toBe(0);
    const all = { ...start, left: side(4), right: side(4), tilted: [true, true, true, true], pairs: 40 };
    expect(shareDone(all)).toBe(1);
    expect(shareDone({ ...all, tilted: [true, true, true, false] })).toBeLessThan(1);
  });

  it('says what to do, what goes wrong, and how far it is', () => {
    expect(headline(start)).toContain('Waiting');
    expect(headline({ ...start, advice: 'Hold it still' })).toBe('Hold it still');
    expect(headline({ ...start, phase: 'calibrating', pairs: 17, progress: 0.5 })).toBe('Calibrating from 17 pairs: 50 %');
    expect(headline({ ...start, problem: 'disk full' })).toContain('disk full');
    expect(headline({ ...start, phase: 'ended', verdict })).toBe('Calibrated');
  });

  it('reads its verdict in people\'s units', () => {
    expect(Object.fromEntries(verdictRows(verdict))).toMatchObject({ Baseline: '60.1 ± 0.1 mm', 'Field of view': '90°' });
  });
});
