import { create } from '@bufbuild/protobuf';
import { describe, expect, it } from 'vitest';
import { MapInfoSchema } from '../gen/flogmap/v1/map_pb';
import { DEFAULTS, withLayer } from '../settings';
import { BYTES_PER_LAYER } from '../tile_store';
import { layerHeights, occupiedBoxes } from './solid_layers';

const info = create(MapInfoSchema, { cellSize: 0.02, minRays: 8, layers: [{ id: 0, zMin: 0, zMax: 1, fullConfidenceRays: 100 }, { id: 1, zMin: 1, zMax: 2, fullConfidenceRays: 100 }] });

describe('boxes of the solid view', () => {
  const planes = new Uint8Array(2 * BYTES_PER_LAYER);
  planes.set([0, 255, 255, 0], 4 * (64 * 2 + 3)); // layer 0, column 3, row 2: occupied
  planes.set([255, 0, 255, 0], 4 * 9); // free
  planes.set([0, 255, 255, 0], BYTES_PER_LAYER); // layer 1, first column: occupied
  const tile = { level: 1, x: -1, y: 2, rev: 1n, planes };

  it('stand where cells are occupied, as large as cells of their level', () => {
    const quarters = occupiedBoxes(tile, info, DEFAULTS);
    expect(quarters.map(({ length }) => length)).toEqual([8, 0, 0, 0]);
    const boxes = quarters[0] ?? [];
    expect(boxes[0]).toBeCloseTo(-2.56 + 3 * 0.04, 6);
    expect(boxes[1]).toBeCloseTo(5.12 + 2 * 0.04, 6);
    expect(boxes[2]).toBeCloseTo(0.04, 6);
    expect([Math.floor(boxes[3] ?? -1), Math.floor(boxes[7] ?? -1)]).toEqual([0, 1]);
  });
  it('are gone with a hidden layer', () => {
    expect(occupiedBoxes(tile, info, { ...DEFAULTS, ...withLayer(DEFAULTS, 0, { visible: false }) })[0]?.length).toBe(4);
  });
  it('move apart with their layers', () => {
    expect(layerHeights(info, 0.5)).toEqual([{ bottom: 0, top: 1 }, { bottom: 1.5, top: 2.5 }]);
  });
});
