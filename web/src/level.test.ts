import { describe, expect, it } from 'vitest';
import { create } from '@bufbuild/protobuf';
import { PoseValueSchema } from './gen/flogmap/v1/map_pb';
import type { Vector } from './geometry';
import { anglesOf, between, floorOf, inTriangle, levelByFloor, motionOf, NO_LEVEL, product, sameLevel, transposed, turned, uprighting, type Level, type Sample } from './level';
import { seededRandom } from './seeded_random';

const camera = { focalPx: 400, cxPx: 320, cyPx: 240, baselineM: 0.1 };
const random = seededRandom(5);
const level = (): Level => ({ roll: 40 * (random() - 0.5), pitch: 40 * (random() - 0.5), yaw: 300 * (random() - 0.5), height: random() });
const apply = ({ rotation, shift }: ReturnType<typeof motionOf>, p: Vector): Vector => turned(rotation, p).map((v, i) => v + (shift[i] ?? 0)) as never;

/** Disparities of a plane up p = -distance, seen by a camera with noise and things on the floor. */
function floorSamples(up: Vector, distance: number, noise: number, strange: number): Sample[] {
  const samples: Sample[] = [];
  for (let y = 260; y < 480; y += 6)
    for (let x = 60; x < 600; x += 6) {
      const ray: Vector = [(x - camera.cxPx) / camera.focalPx, (y - camera.cyPx) / camera.focalPx, 1];
      const depth = -distance / (up[0] * ray[0] + up[1] * ray[1] + up[2] * ray[2]);
      if (depth <= 0) continue;
      const d = (camera.focalPx * camera.baselineM) / depth;
      samples.push({ x, y, d: random() < strange ? d + 4 + 10 * random() : Math.round((d + noise * (random() - 0.5)) / 0.38) * 0.38 });
    }
  return samples;
}

describe('levelling by hand', () => {
  it('angles and rotation are one another’s inverse', () => {
    for (let i = 0; i < 50; ++i) {
      const wanted = level();
      expect(sameLevel({ ...anglesOf(motionOf(wanted).rotation), height: wanted.height }, wanted)).toBe(true);
    }
  });

  it('from one level to another and back is nothing', () => {
    for (let i = 0; i < 20; ++i) {
      const [a, b] = [level(), level()];
      const p: Vector = [random(), 3 * random(), -random()];
      expect(apply(between(b, a), apply(between(a, b), p)).map((v, k) => Math.abs(v - (p[k] ?? 0)) < 1e-9)).toEqual([true, true, true]);
      expect(apply(between(NO_LEVEL, a), p)).toEqual(apply(motionOf(a), p));
    }
  });

  it('uprighting takes the vector to the z axis and is a rotation', () => {
    for (const up of [[0, 0, 1], [0.6, 0, 0.8], [0, -0.28, 0.96], [0, 0, -1]] as Vector[]) {
      turned(uprighting(up), up).forEach((v, i) => expect(v).toBeCloseTo(i === 2 ? 1 : 0, 9));
      product(uprighting(up), transposed(uprighting(up))).forEach((row, i) => row.forEach((v, k) => expect(v).toBeCloseTo(i === k ? 1 : 0, 9)));
    }
  });

  it('finds the floor under coarse disparities with things standing on it', () => {
    const up: Vector = [0.06, -0.95, -Math.sqrt(1 - 0.06 ** 2 - 0.95 ** 2)];
    const floor = floorOf(floorSamples(up, 1.2, 0.3, 0.35), camera);
    expect(floor).toBeDefined();
    const cosine = floor ? floor.up[0] * up[0] + floor.up[1] * up[1] + floor.up[2] * up[2] : 0;
    expect((Math.acos(Math.min(1, cosine)) * 180) / Math.PI).toBeLessThan(0.3);
    expect(floor?.distance).toBeCloseTo(1.2, 1);
    expect(floorOf(floorSamples(up, 1.2, 0.3, 0).slice(0, 20), camera)).toBeUndefined();
  });

  it('a picked floor is level and at height 0 afterwards, whatever the level before', () => {
    for (let i = 0; i < 20; ++i) {
      const now = i === 0 ? NO_LEVEL : level();
      const half = 0.3 * (random() - 0.5);
      const pose = create(PoseValueSchema, { x: random(), y: -random(), z: 1 + random(), qx: Math.sin(half), qw: Math.cos(half) });
      const up: Vector = [0.1, Math.sqrt(1 - 0.01 - 0.64), 0.8];
      const then = levelByFloor({ up, distance: 0.9 }, pose, now);
      const move = between(now, then);
      const [s, c] = [Math.sin(2 * half), Math.cos(2 * half)];
      const worldUp: Vector = [up[0], c * up[1] - s * up[2], s * up[1] + c * up[2]];
      turned(move.rotation, worldUp).forEach((v, k) => expect(v).toBeCloseTo(k === 2 ? 1 : 0, 6));
      expect(apply(move, [pose.x, pose.y, pose.z])[2]).toBeCloseTo(0.9, 6);
    }
  });

  it('knows what lies in a triangle, whichever way round', () => {
    const corners = [{ x: 0, y: 0 }, { x: 10, y: 0 }, { x: 0, y: 10 }];
    for (const triangle of [corners, [...corners].reverse()]) {
      expect(inTriangle(2, 2, triangle)).toBe(true);
      expect(inTriangle(8, 8, triangle)).toBe(false);
    }
  });
});
