import { describe, expect, it } from 'vitest';
import { areaOf, heading, lengthOf, rotate, worldFromCamera } from './geometry';
import { poseOf } from './mock/simulation';
import { create } from '@bufbuild/protobuf';
import { PoseValueSchema } from './gen/flogmap/v1/map_pb';

describe('poses', () => {
  it('turn the optical axis into the heading and keep the picture upright', () => {
    for (const angle of [-3, -1.2, 0, 0.4, 1.6, 3]) {
      const pose = create(PoseValueSchema, poseOf({ x: 1, y: 2, z: 3, heading: angle }));
      expect(heading(pose)).toBeCloseTo(angle, 9);
      const down = rotate(pose, [0, 1, 0]);
      expect(down[2]).toBeCloseTo(-1, 9);
      const right = rotate(pose, [1, 0, 0]);
      expect(Math.atan2(right[1], right[0])).toBeCloseTo(Math.atan2(-Math.cos(angle), Math.sin(angle)), 9);
      const q = worldFromCamera(pose, [0, 0, 2]);
      expect(q[0]).toBeCloseTo(1 + 2 * Math.cos(angle), 9);
      expect(q[1]).toBeCloseTo(2 + 2 * Math.sin(angle), 9);
      expect(q[2]).toBeCloseTo(3, 9);
    }
  });
});

describe('measures', () => {
  const square = [{ x: 0, y: 0 }, { x: 2, y: 0 }, { x: 2, y: 2 }, { x: 0, y: 2 }];
  it('give length and area of a line, whichever way round', () => {
    expect(lengthOf(square)).toBe(6);
    expect(areaOf(square)).toBe(4);
    expect(areaOf([...square].reverse())).toBe(4);
    expect(lengthOf([])).toBe(0);
  });
});
