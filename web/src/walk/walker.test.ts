import { create } from '@bufbuild/protobuf';
import { describe, expect, it } from 'vitest';
import { PoseValueSchema } from '../gen/flogmap/v1/map_pb';
import { look, MAX_PITCH, rideAt, rideTimes, STANDING, standingAt, step, WALK_M_PER_S, type Ground, type Walker } from './walker';

const open: Ground = { blocked: () => false, eyeHeight: () => 1.6 };
const start: Walker = { position: [0, 0, 1.6], yaw: Math.PI / 2, pitch: 0.5 };
// Looks along +x, level: right is -y, down is -z.
const lookingEast = { qx: -0.5, qy: 0.5, qz: -0.5, qw: 0.5 };

describe('step', () => {
  it('walks where one looks, level, whatever the pitch', () => {
    const there = step(start, { ...STANDING, ahead: 1 }, 1, false, open);
    expect(there.position[0]).toBeCloseTo(0);
    expect(there.position[1]).toBeCloseTo(WALK_M_PER_S);
    expect(there.position[2]).toBeCloseTo(1.6);
  });

  it('flies up where one looks up', () => {
    expect(step(start, { ...STANDING, ahead: 1 }, 1, true, open).position[2]).toBeGreaterThan(2);
  });

  it('is no faster aslant than ahead', () => {
    const there = step(start, { ...STANDING, ahead: 1, aside: 1 }, 1, false, open);
    expect(Math.hypot(there.position[0], there.position[1])).toBeCloseTo(WALK_M_PER_S);
  });

  it('steps aside to the right', () => {
    expect(step(start, { ...STANDING, aside: 1 }, 1, false, open).position[0]).toBeCloseTo(WALK_M_PER_S);
  });

  it('slides along a wall and may leave one it stands in', () => {
    const wall: Ground = { ...open, blocked: (_, y) => y > 0.5 };
    const aslant = { ...start, yaw: Math.PI / 4 };
    const there = step(aslant, { ...STANDING, ahead: 1 }, 1, false, wall);
    expect(there.position[0]).toBeGreaterThan(0.5);
    expect(there.position[1]).toBe(0);
    expect(step({ ...start, position: [0, 0.6, 1.6] }, { ...STANDING, ahead: -1 }, 0.1, false, wall).position[1]).toBeLessThan(0.6);
  });

  it('settles at the height of the place', () => {
    let walker: Walker = { ...start, position: [0, 0, 3] };
    for (let i = 0; i < 100; ++i) walker = step(walker, STANDING, 0.05, false, open);
    expect(walker.position[2]).toBeCloseTo(1.6, 3);
  });
});

describe('look', () => {
  it('never turns over', () => {
    expect(look(start, 0, 9).pitch).toBe(MAX_PITCH);
    expect(look(start, 7, -9)).toMatchObject({ pitch: -MAX_PITCH });
  });
});

describe('the ride', () => {
  const at = (x: number, seconds: number): { timeNs: bigint; pose: ReturnType<typeof create<typeof PoseValueSchema>> } =>
    ({ timeNs: BigInt(Math.round(seconds * 1e9)), pose: create(PoseValueSchema, { x, y: 0, z: 1, ...lookingEast }) });

  it('stands as the camera stood, without roll', () => {
    expect(standingAt(create(PoseValueSchema, { x: 3, y: 4, z: 1, ...lookingEast }))).toEqual({ position: [3, 4, 1], yaw: 0, pitch: 0 });
  });

  it('goes straight between poses and skips long pauses', () => {
    const path = [at(0, 10), at(1, 10.5), at(2, 60)];
    const times = rideTimes(path);
    expect(times).toEqual([0, 0.5, 1.5]);
    expect(rideAt(path, times, 0.25)?.position[0]).toBeCloseTo(0.5);
    expect(rideAt(path, times, 1)?.position[0]).toBeCloseTo(1.5);
    expect(rideAt(path, times, 99)?.position[0]).toBeCloseTo(2);
    expect(rideAt([], [], 0)).toBeUndefined();
  });
});
