// What a person can choose about the view, kept between visits. Nothing here touches the map itself.

import { PALETTES, type PaletteName, type Theme } from './palette';
import { DEFAULT_THRESHOLD, OPERATORS, STYLES, type Operators, type Style } from './rules';
import { Store } from './signal';

export type Follow = 'free' | 'north' | 'heading';
export const PATH_MINUTES = [0, 1, 10] as const;
export type PathMinutes = (typeof PATH_MINUTES)[number];
export type ThemeChoice = 'auto' | Theme;

export interface LayerSetting {
  readonly visible: boolean;
  readonly opacity: number; // 0..1
}

export interface Settings {
  readonly theme: ThemeChoice;
  readonly palette: PaletteName;
  readonly style: Style;
  readonly operators: Operators;
  readonly threshold: number;
  /** Three classes by the threshold instead of a graded value. */
  readonly classes: boolean;
  readonly colourByHeight: boolean;
  readonly markConflict: boolean;
  readonly showGrid: boolean;
  readonly showPath: boolean;
  readonly pathBy: 'time' | 'state';
  readonly pathMinutes: PathMinutes; // the newest of the path; 0: all of it
  readonly follow: Follow;
  readonly solid: boolean; // layers at their height instead of flat
  readonly spread: number; // metres between layers in the solid view
  readonly clipHeight: number; // metres; nothing above is drawn in the solid view
  readonly showFeatures: boolean;
  readonly imageFps: number;
  readonly robotRadius: number; // metres
  readonly robotHeight: number; // metres; 0: every layer must be free
  readonly showRight: boolean; // the right picture too
  readonly showRows: boolean; // lines along which left and right are compared
  readonly imageWidth: number; // pixels, at most
  readonly leftPanel: boolean;
  readonly rightPanel: boolean;
  /** By layer id; a layer that is not named is visible and opaque. */
  readonly layers: Readonly<Record<number, LayerSetting>>;
}

export const DEFAULTS: Settings = {
  theme: 'auto', palette: 'cividis', style: 'visual', operators: 'algebraic', threshold: DEFAULT_THRESHOLD, classes: false,
  colourByHeight: false, markConflict: true, showGrid: true, showPath: true, pathBy: 'time', pathMinutes: 0, follow: 'free', solid: false, spread: 0,
  clipHeight: 10, showFeatures: true, imageFps: 5, robotRadius: 0.25, robotHeight: 0, showRight: false, showRows: false, imageWidth: 480, leftPanel: true, rightPanel: true, layers: {},
};

const LAYER: LayerSetting = { visible: true, opacity: 1 };
export const layerSetting = (settings: Settings, id: number): LayerSetting => settings.layers[id] ?? LAYER;

export function withLayer(settings: Settings, id: number, patch: Partial<LayerSetting>): Pick<Settings, 'layers'> {
  return { layers: { ...settings.layers, [id]: { ...layerSetting(settings, id), ...patch } } };
}

const KEY = 'flogmap.settings';

/** The settings of the last visit; what is missing, unknown or of the wrong kind is the default. */
export function restoreSettings(text: string | null): Settings {
  let stored: Record<string, unknown> = {};
  try {
    const parsed: unknown = JSON.parse(text ?? '{}');
    if (typeof parsed === 'object' && parsed !== null) stored = parsed as Record<string, unknown>;
  } catch {
    return DEFAULTS;
  }
  const kept = Object.entries(DEFAULTS).map(([key, fallback]) => [key, typeof stored[key] === typeof fallback ? stored[key] : fallback]);
  return checked(Object.fromEntries(kept) as unknown as Settings);
}

function checked(s: Settings): Settings {
  const oneOf = <T>(value: T, allowed: readonly T[], fallback: T): T => (allowed.includes(value) ? value : fallback);
  return {
    ...s,
    theme: oneOf(s.theme, ['auto', 'dark', 'light'], DEFAULTS.theme),
    palette: oneOf(s.palette, PALETTES, DEFAULTS.palette),
    style: oneOf(s.style, STYLES, DEFAULTS.style),
    operators: oneOf(s.operators, OPERATORS, DEFAULTS.operators),
    pathBy: oneOf(s.pathBy, ['time', 'state'], DEFAULTS.pathBy),
    pathMinutes: oneOf(s.pathMinutes, PATH_MINUTES, DEFAULTS.pathMinutes),
    follow: oneOf(s.follow, ['free', 'north', 'heading'], DEFAULTS.follow),
    threshold: Math.min(1, Math.max(0.02, s.threshold)),
  };
}

/** A store that writes itself to local storage, where there is one. */
export function keptSettings(storage: Storage | null): Store<Settings> {
  const store = new Store<Settings>(restoreSettings(storage?.getItem(KEY) ?? null));
  store.changed.on(({ now }) => {
    try {
      storage?.setItem(KEY, JSON.stringify(now));
    } catch {
      // storage full or forbidden: the page works the same, it only forgets
    }
  });
  return store;
}
