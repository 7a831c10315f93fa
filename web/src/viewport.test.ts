import { describe, expect, it } from 'vitest';
import { seededRandom } from './seeded_random';
import { fit, formatLength, levelFor, pan, pixelsApart, roundLength, screenFromWorld, towards, turnAt, visibleRect, worldFromScreen, wrapAngle, zoomAt, type Viewport } from './viewport';

const random = seededRandom(7);
const between = (a: number, b: number): number => a + (b - a) * random();
const anyView = (): Viewport => ({
  x: between(-50, 50), y: between(-50, 50), scale: between(1, 400), turn: between(-3, 3), width: between(300, 2000), height: between(300, 1200),
});
const anyPixel = (view: Viewport) => ({ x: between(0, view.width), y: between(0, view.height) });

describe('viewport', () => {
  it('goes from world to screen and back', () => {
    for (let i = 0; i < 200; ++i) {
      const view = anyView();
      const pixel = anyPixel(view);
      const back = screenFromWorld(view, worldFromScreen(view, pixel));
      expect(back.x).toBeCloseTo(pixel.x, 6);
      expect(back.y).toBeCloseTo(pixel.y, 6);
    }
  });
  it('has north at the top when not turned', () => {
    const view: Viewport = { x: 1, y: 2, scale: 100, turn: 0, width: 400, height: 300 };
    expect(screenFromWorld(view, { x: 1, y: 3 })).toEqual({ x: 200, y: 50 });
    expect(screenFromWorld(view, { x: 2, y: 2 })).toEqual({ x: 300, y: 150 });
  });
  it('keeps the point under the pointer when zooming and turning', () => {
    for (let i = 0; i < 200; ++i) {
      const view = anyView();
      const pixel = anyPixel(view);
      const world = worldFromScreen(view, pixel);
      for (const next of [zoomAt(view, between(0.5, 2), pixel), turnAt(view, between(-2, 2), pixel)]) {
        expect(screenFromWorld(next, world).x).toBeCloseTo(pixel.x, 5);
        expect(screenFromWorld(next, world).y).toBeCloseTo(pixel.y, 5);
      }
    }
  });
  it('moves the picture by the pixels it was dragged', () => {
    for (let i = 0; i < 100; ++i) {
      const view = anyView();
      const world = { x: between(-9, 9), y: between(-9, 9) };
      const before = screenFromWorld(view, world);
      const after = screenFromWorld(pan(view, 30, -12), world);
      expect(after.x - before.x).toBeCloseTo(30, 5);
      expect(after.y - before.y).toBeCloseTo(-12, 5);
    }
  });
  it('fits a rectangle wholly into the screen', () => {
    for (let i = 0; i < 100; ++i) {
      const rect = { xMin: -3, yMin: -1, xMax: between(0, 20), yMax: between(0, 20) };
      const view = fit(anyView(), rect, 20);
      for (const corner of [{ x: rect.xMin, y: rect.yMin }, { x: rect.xMax, y: rect.yMax }, { x: rect.xMin, y: rect.yMax }]) {
        const pixel = screenFromWorld(view, corner);
        expect(pixel.x).toBeGreaterThan(-1e-6);
        expect(pixel.x).toBeLessThan(view.width + 1e-6);
        expect(pixel.y).toBeGreaterThan(-1e-6);
        expect(pixel.y).toBeLessThan(view.height + 1e-6);
      }
    }
  });
  it('counts everything on the screen as visible', () => {
    for (let i = 0; i < 100; ++i) {
      const view = anyView();
      const rect = visibleRect(view);
      const world = worldFromScreen(view, anyPixel(view));
      expect(world.x).toBeGreaterThan(rect.xMin - 1e-6);
      expect(world.x).toBeLessThan(rect.xMax + 1e-6);
      expect(world.y).toBeGreaterThan(rect.yMin - 1e-6);
      expect(world.y).toBeLessThan(rect.yMax + 1e-6);
    }
  });
  it('chooses the finest level whose cells are at least a pixel wide', () => {
    const view: Viewport = { x: 0, y: 0, scale: 50, turn: 0, width: 1, height: 1 };
    expect(levelFor(view, 0.02, 6)).toBe(0); // a cell is exactly a pixel
    expect(levelFor({ ...view, scale: 49 }, 0.02, 6)).toBe(1);
    expect(levelFor({ ...view, scale: 12.5 }, 0.02, 6)).toBe(2);
    expect(levelFor({ ...view, scale: 1 }, 0.02, 3)).toBe(2);
    expect(levelFor({ ...view, scale: 1 }, 0.02, 1)).toBe(0);
  });
  it('names lengths shortly', () => {
    expect([0.02, 0.5, 1, 2.5, 1500].map(formatLength)).toEqual(['2 cm', '50 cm', '1 m', '2.5 m', '1.5 km']);
    expect([0.03, 0.7, 1, 4.9, 5, 23].map(roundLength)).toEqual([0.02, 0.5, 1, 2, 5, 20]);
  });
  it('wraps angles without turning them', () => {
    for (let i = 0; i < 100; ++i) {
      const angle = between(-30, 30);
      expect(Math.abs(wrapAngle(angle))).toBeLessThanOrEqual(Math.PI + 1e-9);
      expect(Math.cos(wrapAngle(angle))).toBeCloseTo(Math.cos(angle), 9);
      expect(Math.sin(wrapAngle(angle))).toBeCloseTo(Math.sin(angle), 9);
    }
  });
});

describe('towards', () => {
  it('starts at one view, ends at the other, and comes nearer on the way, the short way round', () => {
    for (let i = 0; i < 100; ++i) {
      const from = anyView();
      const to = { ...anyView(), width: from.width, height: from.height };
      expect(pixelsApart(towards(from, to, 0), from)).toBeLessThan(1e-6);
      expect(pixelsApart(towards(from, to, 1), to)).toBeLessThan(1e-6);
      expect(Math.abs(wrapAngle(towards(from, to, 0.5).turn - from.turn))).toBeLessThanOrEqual(Math.PI / 2 + 1e-9);
    }
  });
});
