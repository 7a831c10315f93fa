import { create } from '@bufbuild/protobuf';
import { describe, expect, it } from 'vitest';
import { PoseValueSchema, TrackingState, TrajectoryPointSchema, type TrajectoryPoint } from './gen/flogmap/v1/map_pb';
import { Path } from './path';
import { CORNER, drawnPath, drawnViews } from './path_thinning';

const point = (seconds: number, x: number, y = 0, about: Partial<Pick<TrajectoryPoint, 'state' | 'mapped'>> = {}): TrajectoryPoint =>
  create(TrajectoryPointSchema, { timeNs: BigInt(Math.round(seconds * 1e9)), pose: create(PoseValueSchema, { x, y, z: 1, qw: 1 }), state: TrackingState.OK, ...about });
const gap = (seconds: number): TrajectoryPoint => create(TrajectoryPointSchema, { timeNs: BigInt(Math.round(seconds * 1e9)), state: TrackingState.LOST });
const pathOf = (points: readonly TrajectoryPoint[]): Path => {
  const path = new Path();
  path.put(0, points);
  return path;
};
const rounds = (count: number, perRound: number): Path =>
  pathOf(Array.from({ length: count * perRound }, (_, i) => point(i / 20, 3 * Math.cos((2 * Math.PI * i) / perRound), 2 * Math.sin((2 * Math.PI * i) / perRound), { mapped: i % 4 === 0 })));

describe('a path', () => {
  it('gives back what was put in, also after parts of it were put anew', () => {
    const path = pathOf([point(1.5, 1), gap(2), point(3, 2, 5, { state: TrackingState.WEAK, mapped: true })]);
    expect(path.length).toBe(3);
    expect(path.at(0)).toMatchObject({ timeNs: 1500000000n, pose: { x: 1, y: 0, z: 1, qw: 1 }, state: TrackingState.OK, mapped: false });
    expect(path.at(1)).toMatchObject({ pose: undefined, state: TrackingState.LOST });
    expect(path.at(-1)).toMatchObject({ pose: { x: 2, y: 5 }, state: TrackingState.WEAK, mapped: true });
    expect([path.seconds(2), path.at(3), path.at(-4)]).toEqual([1.5, undefined, undefined]);
    path.put(1, [point(2, 7)]);
    expect([path.length, path.at(-1)?.pose?.x]).toEqual([2, 7]);
  });

  it('knows where its newest minutes begin', () => {
    const path = pathOf(Array.from({ length: 200 }, (_, i) => point(i, i)));
    expect([0, 1, 2, 10].map((minutes) => path.firstOfLast(minutes))).toEqual([0, 139, 79, 0]);
    expect(new Path().firstOfLast(1)).toBe(0);
  });

  it('takes 3 MiB an hour', () => {
    expect(rounds(72, 1000).bytes).toBeLessThan(4.5 * 2 ** 20); // with room to grow
  });
});

describe('what is drawn of a path', () => {
  it('costs the same for one round as for a hundred', () => {
    const [once, often] = [drawnPath(rounds(1, 700), 0.05).length, drawnPath(rounds(100, 700), 0.05).length];
    expect(often).toBeLessThan(1.5 * once);
    expect(drawnViews(rounds(100, 700), 0.2).length).toBe(drawnViews(rounds(1, 700), 0.2).length);
  });

  it('passes everywhere that the camera did, within the distance asked for', () => {
    const path = rounds(3, 500);
    const corners = drawnPath(path, 0.05);
    for (let i = 0; i < path.length; i += 7) {
      let nearest = Infinity;
      for (let k = 0; k < corners.length; k += CORNER) nearest = Math.min(nearest, Math.hypot((corners[k] ?? 0) - path.place(i, 0), (corners[k + 1] ?? 0) - path.place(i, 1)));
      expect(nearest).toBeLessThan(0.1);
    }
  });

  it('ends at the newest pose, is in order of time, and has no line over a gap', () => {
    const corners = drawnPath(pathOf([point(0, 0), point(1, 1), gap(2), point(3, 3), point(4, 4)]), 0.1);
    expect(Array.from({ length: corners.length / CORNER }, (_, i) => [corners[CORNER * i], corners[CORNER * i + 3]])).toEqual([[0, 0], [1, 1], [3, 3], [4, 4]]);
    expect([4, 9, 14].map((k) => (corners[k] ?? 0) >= 0)).toEqual([true, false, true]);
  });

  it('may begin later, as if there had been nothing before', () => {
    const points = [...Array.from({ length: 300 }, (_, i) => point(i / 20, i / 50, Math.sin(i / 30), { mapped: i % 5 === 0 })), gap(15), point(16, 6), point(17, 7)];
    for (const first of [0, 1, 77, 150, 299, 300, 301, 302, 303]) {
      const path = pathOf(points);
      const later = pathOf(points.slice(first));
      const places = (corners: Float32Array): number[] => [...corners].filter((_, k) => k % CORNER !== 3); // seconds count from the first point
      expect(places(drawnPath(path, 0.05, first))).toEqual(places(drawnPath(later, 0.05)));
      expect([...drawnViews(path, 0.2, first)]).toEqual([...drawnViews(later, 0.2)]);
    }
  });

  it('keeps a change of tracking state', () => {
    const states = [TrackingState.OK, TrackingState.WEAK, TrackingState.OK];
    const corners = drawnPath(pathOf(states.flatMap((state, k) => [0, 1, 2].map((i) => point(3 * k + i, (3 * k + i) / 100, 0, { state })))), 1);
    expect(new Set(Array.from({ length: corners.length / CORNER }, (_, i) => corners[CORNER * i + 4]))).toContain(TrackingState.WEAK);
  });
});
