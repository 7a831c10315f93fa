import { describe, expect, it } from 'vitest';
import { chooseViews, sees, type Eye, type MappedView } from './view_choice';

const camera = { focalPx: 400, cxPx: 320, cyPx: 240, widthPx: 640, heightPx: 480 };

/** A view at a place, looking level in the direction `yaw`. */
function view(number: number, x: number, y: number, yaw: number): MappedView {
  // Columns of world_from_camera: right, down, forward; as a quaternion by the trace formula's general form.
  const [c, s] = [Math.cos(yaw), Math.sin(yaw)];
  const m = [[s, 0, c], [-c, 0, s], [0, -1, 0]] as const;
  const qw = Math.sqrt(Math.max(0, 1 + m[0][0] + m[1][1] + m[2][2])) / 2;
  const qx = Math.sqrt(Math.max(0, 1 + m[0][0] - m[1][1] - m[2][2])) / 2 * Math.sign(m[2][1] - m[1][2] || 1);
  const qy = Math.sqrt(Math.max(0, 1 - m[0][0] + m[1][1] - m[2][2])) / 2 * Math.sign(m[0][2] - m[2][0] || 1);
  const qz = Math.sqrt(Math.max(0, 1 - m[0][0] - m[1][1] + m[2][2])) / 2 * Math.sign(m[1][0] - m[0][1] || 1);
  return { number, timeNs: BigInt(number), position: [x, y, 1.5], orientation: { qx, qy, qz, qw } };
}

const eyeAt = (x: number, y: number, yaw: number): Eye => ({ position: [x, y, 1.5], forward: [Math.cos(yaw), Math.sin(yaw), 0], right: [Math.sin(yaw), -Math.cos(yaw), 0] });

describe('sees', () => {
  it('is true ahead and false behind, beside and far away', () => {
    const ahead = view(0, 0, 0, 0.3);
    const at = (angle: number, distance: number): [number, number, number] => [distance * Math.cos(angle), distance * Math.sin(angle), 1.5];
    expect(sees(ahead, camera, at(0.3, 2))).toBe(true);
    expect(sees(ahead, camera, at(0.3 + Math.PI, 2))).toBe(false);
    expect(sees(ahead, camera, at(0.3 + 1, 2))).toBe(false);
    expect(sees(ahead, camera, at(0.3, 20))).toBe(false);
  });
});

describe('chooseViews', () => {
  const circle = Array.from({ length: 36 }, (_, i) => view(i, 0, 0, (2 * Math.PI * i) / 36));

  it('takes first the view that was taken where the eye is', () => {
    for (let i = 0; i < 36; i += 5) expect(chooseViews(circle, camera, eyeAt(0, 0, (2 * Math.PI * i) / 36), 5)[0]?.number).toBe(i);
  });

  it('prefers the nearer of two that look alike', () => {
    const chosen = chooseViews([view(1, -3, 0, 0), view(2, -0.2, 0, 0)], camera, eyeAt(0, 0, 0), 2);
    expect(chosen.map(({ number }) => number)).toEqual([2, 1]);
  });

  it('prefers a view that sees the place to a nearer one that looks away', () => {
    expect(chooseViews([view(1, 0, 0, Math.PI), view(2, -1.5, 0, 0)], camera, eyeAt(0, 0, 0), 1)[0]?.number).toBe(2);
  });

  it('gives each view once and no more than asked for, or all there are', () => {
    const chosen = chooseViews(circle, camera, eyeAt(0.1, 0.2, 1), 8);
    expect(new Set(chosen.map(({ number }) => number)).size).toBe(8);
    expect(chooseViews(circle.slice(0, 3), camera, eyeAt(0, 0, 0), 8)).toHaveLength(3);
    expect(chooseViews([], camera, eyeAt(0, 0, 0), 8)).toEqual([]);
  });
});
