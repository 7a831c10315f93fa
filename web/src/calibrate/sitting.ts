// What the server tells about a calibration that is being made, and the words for it. Pure.

export interface Side {
  readonly corners: readonly (readonly [number, number])[];
  /** Corners kept in each of three by three areas of the picture, row by row from the upper left. */
  readonly areas: readonly number[];
}

export interface Verdict {
  readonly grade: 'good' | 'usable' | 'redo';
  readonly rms_px: number;
  readonly epipolar_p95_px: number;
  readonly baseline_m: number;
  readonly baseline_sigma_m: number;
  readonly field_of_view_rad: number;
  readonly pairs: number;
  readonly advice: readonly string[];
}

export interface Sitting {
  readonly phase: 'looking' | 'calibrating' | 'ended';
  readonly frame: number;
  readonly width_px: number;
  readonly height_px: number;
  readonly left: Side;
  readonly right: Side;
  readonly kept: boolean;
  readonly pairs: number;
  readonly pairs_wanted: number;
  readonly tilted: readonly boolean[];
  readonly advice: string;
  readonly enough: boolean;
  readonly progress: number;
  readonly verdict: Verdict | null;
  readonly problem: string;
  readonly file: string;
}

/** Share of all that is wanted which is there: pairs, areas of both pictures, tilts; 0 to 1. */
export function shareDone(sitting: Sitting): number {
  const areas = [...sitting.left.areas, ...sitting.right.areas].map((count) => count > 0);
  const wanted = [...areas, ...sitting.tilted];
  const met = wanted.filter(Boolean).length + Math.min(sitting.pairs, sitting.pairs_wanted);
  return met / (wanted.length + sitting.pairs_wanted);
}

/** The one sentence that is shown large. */
export function headline(sitting: Sitting): string {
  if (sitting.phase === 'calibrating') return `Calibrating from ${sitting.pairs} pairs: ${Math.round(100 * sitting.progress)} %`;
  if (sitting.problem) return `Not calibrated: ${sitting.problem}`;
  if (sitting.phase === 'ended') return sitting.verdict ? 'Calibrated' : 'The recording has ended';
  return sitting.advice || 'Waiting for the first pictures';
}

export function verdictRows(verdict: Verdict): readonly (readonly [string, string])[] {
  return [
    ['Verdict', verdict.grade],
    ['Corners off by', `${verdict.rms_px.toFixed(2)} px (rms)`],
    ['Rows differ by', `${verdict.epipolar_p95_px.toFixed(2)} px (95 % of corners)`],
    ['Baseline', `${(1000 * verdict.baseline_m).toFixed(1)} ± ${(1000 * verdict.baseline_sigma_m).toFixed(1)} mm`],
    ['Field of view', `${((180 / Math.PI) * verdict.field_of_view_rad).toFixed(0)}°`],
    ['Pairs', String(verdict.pairs)],
  ];
}
