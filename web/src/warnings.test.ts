import { create } from '@bufbuild/protobuf';
import { describe, expect, it } from 'vitest';
import { PoseValueSchema } from './gen/flogmap/v1/map_pb';
import { lightOf, lightWarnings, speedWarnings } from './warnings';

const picture = (grey: (i: number) => number): Uint8ClampedArray => Uint8ClampedArray.from({ length: 4 * 256 }, (_, i) => (i % 4 === 3 ? 255 : grey(i >> 2)));
const good = lightOf(picture((i) => 60 + (i % 100)));

describe('warnings', () => {
  it('finds mean and spread', () => {
    expect(lightOf(picture(() => 40))).toEqual({ mean: 40, spread: 0 });
    expect(lightOf(picture((i) => (i % 2) * 100))).toEqual({ mean: 50, spread: 50 });
  });

  it('names the lens that is covered', () => {
    const covered = lightOf(picture(() => 3));
    expect(lightWarnings(covered, good)[0]).toContain('left lens covered');
    expect(lightWarnings(good, covered)[0]).toContain('right lens covered');
    expect(lightWarnings(covered, covered)[0]).toContain('Both');
    expect(lightWarnings(good, undefined)).toEqual([]);
  });

  it('tells dark from bright', () => {
    expect(lightWarnings(lightOf(picture((i) => (i % 2) * 30)), undefined)[0]).toContain('Too dark');
    expect(lightWarnings(lightOf(picture((i) => 255 - (i % 2) * 15)), undefined)[0]).toContain('Too bright');
  });

  it('tells moving and turning too fast, and says nothing of gaps', () => {
    const at = (seconds: number, x: number, yaw = 0): { timeNs: bigint; pose: ReturnType<typeof create<typeof PoseValueSchema>> } =>
      ({ timeNs: BigInt(Math.round(seconds * 1e9)), pose: create(PoseValueSchema, { x, qz: Math.sin(yaw / 2), qw: Math.cos(yaw / 2) }) });
    expect(speedWarnings([at(0, 0), at(0.1, 0.1)])).toEqual([]);
    expect(speedWarnings([at(0, 0), at(0.1, 0.4)])[0]).toContain('Moving too fast');
    expect(speedWarnings([at(0, 0), at(0.1, 0, 0.3)])[0]).toContain('Turning too fast');
    expect(speedWarnings([at(0, 0), at(10, 5)])).toEqual([]);
    expect(speedWarnings([])).toEqual([]);
  });
});
