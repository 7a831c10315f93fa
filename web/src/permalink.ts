// The view as an address: #e=epoch&r=revision&v=x,y,scale,turn&l=layers&s=style&o=operators&p=palette&t=threshold&c=x,y, and for
// layers at their height d=1&a=pitch,spread,cut.

import { PALETTES } from './palette';
import { OPERATORS, STYLES } from './rules';
import type { LayerSetting, Settings } from './settings';
import type { Point } from './viewport';

export interface Linked {
  readonly epoch?: string;
  readonly rev?: bigint;
  readonly view?: { readonly x: number; readonly y: number; readonly scale: number; readonly turn: number };
  readonly cell?: Point;
  readonly pitch?: number; // of the solid view, radians
  readonly settings: Partial<Settings>;
}

export interface Shown {
  readonly epoch: string;
  readonly rev: bigint;
  readonly view: { readonly x: number; readonly y: number; readonly scale: number; readonly turn: number };
  readonly cell: Point | undefined;
  readonly pitch: number;
  readonly settings: Settings;
  readonly layers: readonly number[];
}

const short = (value: number): string => String(Number(value.toFixed(3)));

export function linkHash({ epoch, rev, view, cell, pitch, settings, layers }: Shown): string {
  const visible = layers.map((id) => {
    const { visible: on, opacity } = settings.layers[id] ?? { visible: true, opacity: 1 };
    return `${id}:${on ? short(opacity) : '-'}`;
  });
  const parts: [string, string][] = [
    ['e', epoch], ['r', String(rev)], ['v', [view.x, view.y, view.scale, view.turn].map(short).join(',')], ['l', visible.join(',')], ['s', settings.style],
    ['o', settings.operators], ['p', settings.palette], ['t', short(settings.threshold)],
  ];
  if (cell) parts.push(['c', `${short(cell.x)},${short(cell.y)}`]);
  if (settings.solid) parts.push(['d', '1'], ['a', [pitch, settings.spread, settings.clipHeight].map(short).join(',')]);
  return `#${parts.map(([key, value]) => `${key}=${encodeURIComponent(value).replaceAll('%2C', ',').replaceAll('%3A', ':')}`).join('&')}`;
}

/** What a hash asks for; parts that make no sense are left out. */
export function readHash(hash: string): Linked {
  const parts = new URLSearchParams(hash.replace(/^#/, ''));
  const numbers = (key: string, count: number): number[] | undefined => {
    const list = (parts.get(key) ?? '').split(',').map(Number);
    return parts.get(key) && list.length === count && list.every(Number.isFinite) ? list : undefined;
  };
  const oneOf = <T extends string>(key: string, allowed: readonly T[]): T | undefined => allowed.find((value) => value === parts.get(key));
  const [x, y, scale, turn] = numbers('v', 4) ?? [];
  const cell = numbers('c', 2);
  const [pitch, spread, clipHeight] = numbers('a', 3)?.map((value) => Math.max(0, value)) ?? [];
  const rev = /^\d+$/.test(parts.get('r') ?? '') ? BigInt(parts.get('r') ?? '0') : undefined;
  const settings = {
    style: oneOf('s', STYLES), operators: oneOf('o', OPERATORS), palette: oneOf('p', PALETTES), threshold: numbers('t', 1)?.[0],
    layers: readLayers(parts.get('l')), solid: parts.has('v') ? parts.get('d') === '1' : undefined, spread, clipHeight,
  };
  return {
    ...(parts.get('e') ? { epoch: parts.get('e') as string } : {}),
    ...(rev === undefined ? {} : { rev }),
    ...(x !== undefined && y !== undefined && scale !== undefined && turn !== undefined && scale > 0 ? { view: { x, y, scale, turn } } : {}),
    ...(cell ? { cell: { x: cell[0] ?? 0, y: cell[1] ?? 0 } } : {}),
    ...(pitch === undefined ? {} : { pitch }),
    settings: Object.fromEntries(Object.entries(settings).filter(([, value]) => value !== undefined)),
  };
}

function readLayers(text: string | null): Record<number, LayerSetting> | undefined {
  const entries = (text ?? '').split(',').flatMap((part): [number, LayerSetting][] => {
    const match = /^(\d+):(-|[\d.]+)$/.exec(part);
    return match ? [[Number(match[1]), match[2] === '-' ? { visible: false, opacity: 1 } : { visible: true, opacity: Math.min(1, Number(match[2])) }]] : [];
  });
  return entries.length > 0 ? Object.fromEntries(entries) : undefined;
}
