// The page's two ways of saying that something changed.

/** Calls every listener with each value, in the order of subscription. */
export class Signal<T> {
  private readonly listeners = new Set<(value: T) => void>();

  on(listener: (value: T) => void): () => void {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  }

  emit(value: T): void {
    for (const listener of this.listeners) listener(value);
  }
}

/** A plain object that tells when it changed. Values are replaced, never mutated. */
export class Store<T extends object> {
  readonly changed = new Signal<{ now: T; before: T }>();

  constructor(private value: T) {}

  get(): T {
    return this.value;
  }

  /** Takes the patch over; tells listeners only if some value differs. */
  set(patch: Partial<T>): void {
    const before = this.value;
    const keys = Object.keys(patch) as (keyof T)[];
    if (keys.every((key) => Object.is(before[key], patch[key]))) return;
    this.value = { ...before, ...patch };
    this.changed.emit({ now: this.value, before });
  }

  /** Runs `listener` now and whenever one of `keys` changes. */
  watch<K extends keyof T>(keys: readonly K[], listener: (value: T) => void): () => void {
    listener(this.value);
    return this.changed.on(({ now, before }) => {
      if (keys.some((key) => !Object.is(now[key], before[key]))) listener(now);
    });
  }
}
