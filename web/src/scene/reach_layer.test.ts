import { describe, expect, it } from 'vitest';
import { reachTexels } from './reach_layer';

describe('reachTexels', () => {
  it('alternates between not reached and reached, beginning with not', () => {
    expect([...reachTexels({ width: 4, height: 2, runs: [1, 2, 3, 1, 1] })]).toEqual([0, 255, 255, 0, 0, 0, 255, 0]);
    expect([...reachTexels({ width: 2, height: 1, runs: [0, 2] })]).toEqual([255, 255]);
  });
});
