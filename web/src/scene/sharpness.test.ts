import { describe, expect, it } from 'vitest';
import { Sharpness } from './sharpness';

describe('sharpness', () => {
  it('is full on a quick machine, moving or not', () => {
    const sharpness = new Sharpness(2);
    sharpness.took(10, 2);
    sharpness.moved(100);
    expect(sharpness.ratio(110)).toBe(2);
    expect(sharpness.sharpIn(110)).toBeUndefined();
  });

  it('is less while moved on a slow one, and full again at rest', () => {
    const sharpness = new Sharpness(1);
    sharpness.took(100, 1);
    sharpness.moved(1000);
    expect(sharpness.ratio(1010)).toBe(0.5);
    sharpness.took(30, 0.5);
    expect(sharpness.sharpIn(1010)).toBe(170);
    expect(sharpness.ratio(1180)).toBe(1);
    expect(sharpness.sharpIn(1180)).toBeUndefined();
  });

  it('waits longer for the next movement where pictures take longer than that', () => {
    const sharpness = new Sharpness(1);
    sharpness.took(100, 1);
    sharpness.moved(0);
    sharpness.took(300, 0.5);
    expect(sharpness.ratio(700)).toBe(0.5);
    sharpness.took(3000, 0.5);
    expect(sharpness.ratio(801)).toBe(1);
  });

  it('goes down no further than the time asks for', () => {
    const sharpness = new Sharpness(2);
    sharpness.took(50, 2);
    sharpness.moved(0);
    expect(sharpness.ratio(1)).toBe(1.25);
  });

  it('does not change within one movement, and learns from sharp pictures alone', () => {
    const sharpness = new Sharpness(1);
    sharpness.took(100, 1);
    sharpness.moved(0);
    for (let i = 0; i < 20; ++i) sharpness.took(5, 0.5);
    sharpness.moved(100);
    expect(sharpness.ratio(120)).toBe(0.5);
    for (let i = 0; i < 20; ++i) sharpness.took(5, 1);
    sharpness.moved(1000);
    expect(sharpness.ratio(1010)).toBe(1);
  });
});
