// What the tests and the simulated room share.

/** The same numbers in [0, 1) on every run: a linear congruential generator, upper bits only. */
export function seededRandom(seed: number): () => number {
  let state = seed >>> 0;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return (state >>> 8) / 0x1000000;
  };
}
