// Overview levels of the simulated map by FLOG.md section 5: K E by min, K O by max, K by max. Dangers never vanish.

import { TILE_SIDE } from '../tile_store';

const COLUMNS = TILE_SIDE * TILE_SIDE;

/** One quarter of a parent's E, O, K planes from a child's; `right`, `up`: which quarter. */
export function shrinkInto(parent: Uint8Array, child: Uint8Array, right: boolean, up: boolean): void {
  const half = TILE_SIDE / 2;
  for (let y = 0; y < half; ++y)
    for (let x = 0; x < half; ++x) {
      const at = (y + (up ? half : 0)) * TILE_SIDE + x + (right ? half : 0);
      let KE = 1;
      let KO = 0;
      let K = 0;
      for (const from of [2 * y * TILE_SIDE + 2 * x, 2 * y * TILE_SIDE + 2 * x + 1, (2 * y + 1) * TILE_SIDE + 2 * x, (2 * y + 1) * TILE_SIDE + 2 * x + 1]) {
        const k = (child[2 * COLUMNS + from] ?? 0) / 255;
        KE = Math.min(KE, (k * (child[from] ?? 0)) / 255);
        KO = Math.max(KO, (k * (child[COLUMNS + from] ?? 0)) / 255);
        K = Math.max(K, k);
      }
      parent[at] = K > 0 ? Math.round((255 * KE) / K) : 0;
      parent[COLUMNS + at] = K > 0 ? Math.round((255 * KO) / K) : 0;
      parent[2 * COLUMNS + at] = Math.round(255 * K);
    }
}
