// From the evidence of a cell to a map value. FLOG.md section 5, eqs. (11)(12); the twin of mapping/flog/map_value.hpp.
// The shader runs the same rules from RULES_GLSL below: change both or neither.

export const OPERATORS = ['algebraic', 'minmax', 'lukasiewicz'] as const;
export type Operators = (typeof OPERATORS)[number];

export const STYLES = ['visual', 'planning', 'motion', 'empty', 'confidence', 'conflict', 'changed'] as const;
export type Style = (typeof STYLES)[number];

/** Memberships of one cell of one layer, each in [0, 1]: empty, occupied, confidence, changed lately. */
export interface Evidence {
  readonly E: number;
  readonly O: number;
  readonly K: number;
  readonly C: number;
}

export const DEFAULT_THRESHOLD = 0.3; // on M: an obstacle from here on
export const CONFLICT_MARK = 0.9; // conflict from here on is marked on the map

export function fuzzyAnd(operators: Operators, a: number, b: number): number {
  if (operators === 'minmax') return Math.min(a, b);
  if (operators === 'lukasiewicz') return Math.max(0, a + b - 1);
  return a * b;
}

export function fuzzyOr(operators: Operators, a: number, b: number): number {
  if (operators === 'minmax') return Math.max(a, b);
  if (operators === 'lukasiewicz') return Math.min(1, a + b);
  return a + b - a * b;
}

export const fuzzyNot = (a: number): number => 1 - a;

/** M_k: unknown and free are 0. K stands outside the complement. Eq. (11). */
export function mapValue(operators: Operators, E: number, O: number, K: number): number {
  const I = fuzzyAnd(operators, fuzzyNot(E), fuzzyNot(O));
  const free = fuzzyAnd(operators, E, fuzzyNot(O));
  return fuzzyAnd(operators, fuzzyNot(fuzzyOr(operators, free, I)), K);
}

/** Safe for planning: unknown counts as free. */
export const planningValue = (operators: Operators, O: number, K: number): number => fuzzyAnd(operators, O, K);

/** Safe for motion: unknown counts as occupied. Confidence is folded into E and O first. */
export function motionValue(operators: Operators, E: number, O: number, K: number): number {
  const Eh = E * K;
  const Oh = O * K;
  const Ih = fuzzyAnd(operators, fuzzyNot(Eh), fuzzyNot(Oh));
  return fuzzyNot(fuzzyAnd(operators, fuzzyAnd(operators, Eh, fuzzyNot(Oh)), fuzzyNot(Ih)));
}

/** How much the evidence contradicts itself. */
export const conflictValue = (E: number, O: number, K: number): number => 2 * Math.min(E, O) * K;

/** What a style shows for one cell of one layer, in [0, 1]. */
export function styleValue(style: Style, operators: Operators, cell: Evidence): number {
  const { E, O, K, C } = cell;
  switch (style) {
    case 'visual': return mapValue(operators, E, O, K);
    case 'planning': return planningValue(operators, O, K);
    case 'motion': return motionValue(operators, E, O, K);
    case 'empty': return E;
    case 'confidence': return K;
    case 'conflict': return conflictValue(E, O, K);
    case 'changed': return C;
  }
}

export type CellClass = 'unknown' | 'free' | 'occupied';

/**
 * The class for "Classes" on the map. A cell counts as seen from `seenFrom` on (K of `min_rays` rays); K does not decide
 * what is an obstacle in the visual map. Planning takes the unknown for free, motion takes it for occupied.
 */
export function classify(style: Style, operators: Operators, cell: Evidence, seenFrom: number, threshold: number): CellClass {
  if (cell.K < seenFrom) return 'unknown';
  const K = style === 'visual' || style === 'planning' ? 1 : cell.K;
  return styleValue(style, operators, { ...cell, K }) >= threshold ? 'occupied' : 'free';
}

/** K from which on a cell counts as seen, as far as 8 bits can tell: half a step below min_rays / N_K, and never 0. */
export function seenFromConfidence(minRays: number, fullConfidenceRays: number): number {
  const exact = fullConfidenceRays > 0 ? Math.min(1, minRays / fullConfidenceRays) : 0;
  return Math.max(0.5 / 255, exact - 0.5 / 255);
}

/** Chosen by STYLE and OPERATORS, indices into the lists above: a shader without branches is several times as quick. */
export const RULES_GLSL = /* glsl */ `
float fuzzyAnd(float a, float b) {
#if OPERATORS == 1
  return min(a, b);
#elif OPERATORS == 2
  return max(0.0, a + b - 1.0);
#else
  return a * b;
#endif
}
float fuzzyOr(float a, float b) {
#if OPERATORS == 1
  return max(a, b);
#elif OPERATORS == 2
  return min(1.0, a + b);
#else
  return a + b - a * b;
#endif
}
float mapValue(float E, float O, float K) {
  float I = fuzzyAnd(1.0 - E, 1.0 - O);
  return fuzzyAnd(1.0 - fuzzyOr(fuzzyAnd(E, 1.0 - O), I), K);
}
float motionValue(float E, float O, float K) {
  float Eh = E * K;
  float Oh = O * K;
  float Ih = fuzzyAnd(1.0 - Eh, 1.0 - Oh);
  return 1.0 - fuzzyAnd(fuzzyAnd(Eh, 1.0 - Oh), 1.0 - Ih);
}
float conflictValue(vec4 c) { return 2.0 * min(c.r, c.g) * c.b; }
float styleValue(vec4 c) {  // c: E, O, K, C
#if STYLE == 0
  return mapValue(c.r, c.g, c.b);
#elif STYLE == 1
  return fuzzyAnd(c.g, c.b);
#elif STYLE == 2
  return motionValue(c.r, c.g, c.b);
#elif STYLE == 3
  return c.r;
#elif STYLE == 4
  return c.b;
#elif STYLE == 5
  return conflictValue(c);
#else
  return c.a;
#endif
}
float classValue(vec4 c) {  // what the threshold is compared with: K does not decide in the first two styles
#if STYLE < 2
  c.b = 1.0;
#endif
  return styleValue(c);
}
`;
