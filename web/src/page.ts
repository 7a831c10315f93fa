// What every panel is given: the map, the choices, the view, and the ways to ask for more.

import type { Backend } from './backend';
import type { Connection } from './connection';
import type { LiveMap } from './live_map';
import type { Theme } from './palette';
import type { Walkthrough } from './scene/walkthrough';
import type { MapView } from './scene/map_view';
import type { Settings } from './settings';
import type { Store } from './signal';
import type { Point } from './viewport';

export type Tool = 'inspect' | 'measure' | 'route' | 'level';
export type Sheet = 'none' | 'map' | 'camera' | 'cell' | 'status';

/** What is being pointed at and worked on; not kept between visits. */
export interface Focus {
  readonly tool: Tool;
  readonly hover: Point | undefined;
  readonly cell: Point | undefined;
  readonly pins: readonly Point[];
  readonly sheet: Sheet; // on narrow screens
  readonly theme: Theme;
  /** Time of day from which on the picture stands still, though the map goes on; 0 = it does not. */
  readonly heldSince: number;
  /** First person through the map. */
  readonly walking: boolean;
  /** Points of the floor picked so far in the left picture, as shares of its size; undefined: nobody picks. */
  readonly floor: readonly Point[] | undefined;
}

export interface Page {
  readonly live: LiveMap;
  readonly settings: Store<Settings>;
  readonly focus: Store<Focus>;
  readonly view: MapView;
  readonly walk: Walkthrough;
  readonly connection: Connection;
  readonly backend: Backend;
}

/** Runs an action of the backend; what goes wrong is said, not swallowed. */
export async function attempt(page: Page, action: Promise<unknown>): Promise<void> {
  try {
    await action;
  } catch (error) {
    page.live.noticed.emit({ tone: 'warning', text: error instanceof Error ? sentence(error.message) : String(error) });
  }
}

export const sentence = (text: string): string => text.charAt(0).toUpperCase() + text.slice(1) + (/[.!?]$/.test(text) ? '' : '.');
