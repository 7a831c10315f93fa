import type { Group } from 'three';
import type { Motion } from '../level';

/** Moves all of a group by a rigid motion; undefined puts it back. */
export function place(group: Group, motion: Motion | undefined): void {
  group.matrixAutoUpdate = false;
  group.matrix.identity();
  if (motion) {
    const { rotation: [a, b, c], shift: [x, y, z] } = motion;
    group.matrix.set(...a, x, ...b, y, ...c, z, 0, 0, 0, 1);
  }
  group.matrixWorldNeedsUpdate = true;
}
