// The page as tests see it: through window.__flog and through its pixels.
import { inflateSync } from 'node:zlib';
import { expect, type Page } from '@playwright/test';
import type { Program } from './program';

export interface FlogState {
  rev: number;
  epoch: string;
  state: string;
  tiles: number;
  trajectoryLength: number;
}

export const state = (page: Page): Promise<FlogState> =>
  page.evaluate(() => {
    const flog = (window as never as { __flog?: FlogState & { tiles(): number } }).__flog;
    if (!flog) return { rev: 0, epoch: '', state: '', tiles: 0, trajectoryLength: 0 }; // still loading
    return { rev: flog.rev, epoch: flog.epoch, state: flog.state, tiles: flog.tiles(), trajectoryLength: flog.trajectoryLength };
  });

export const keys = (page: Page): Promise<string[]> => page.evaluate(() => (window as never as { __flog: { keys(): string[] } }).__flog.keys());

export const tile = (page: Page, level: number, x: number, y: number): Promise<{ rev: number; planes: number[] } | null> =>
  page.evaluate(([l, tx, ty]) => (window as never as { __flog: { tile(...at: number[]): { rev: number; planes: number[] } | null } }).__flog.tile(l as number, tx as number, ty as number), [level, x, y]);

export const PLANE = 64 * 64;

/** These tiles in the page are the server's, byte for byte. */
export async function sameBytes(page: Page, program: Program, keysOfTiles: readonly string[]): Promise<void> {
  for (const key of keysOfTiles) {
    const [level, x, y] = key.split('/').map(Number) as [number, number, number];
    const mine = await tile(page, level, x, y);
    for (const layer of [0, 1, 2]) {
      const served = await program.json<{ rev: number; layers: Record<'E' | 'O' | 'K', number[]>[] }>(`maps/live/layers/${layer}/tiles/${key}?f=json`);
      expect(served.rev, key).toBe(mine?.rev);
      for (const [i, plane] of (['E', 'O', 'K'] as const).entries()) {
        const here = Array.from({ length: PLANE }, (_, column) => mine?.planes[layer * 4 * PLANE + 4 * column + i]);
        expect(here, `${key} layer ${layer} ${plane}`).toEqual(served.layers[0]?.[plane]);
      }
    }
  }
}

export const project = (page: Page, x: number, y: number): Promise<{ x: number; y: number }> =>
  page.evaluate(([wx, wy]) => (window as never as { __flog: { project(...at: number[]): { x: number; y: number } } }).__flog.project(wx as number, wy as number), [x, y]);

/** Opens the page and waits for a map of at least `tiles` tiles. */
export async function open(page: Page, url: string, tiles = 4): Promise<void> {
  await page.goto(url);
  await expect.poll(async () => (await state(page)).tiles, { timeout: 60_000 }).toBeGreaterThanOrEqual(tiles);
  await expect.poll(async () => (await state(page)).state).toMatch(/live|lagging/);
}

/** Waits until the page holds revision `rev` and nothing moves. */
export async function quiet(page: Page, rev: number): Promise<void> {
  await expect.poll(async () => (await state(page)).rev).toBeGreaterThanOrEqual(rev);
  await page.waitForTimeout(1500);
}

export interface Picture {
  at(x: number, y: number): readonly [number, number, number];
}

/** The map's pixels as the eye sees them, by CSS pixel of the canvas; floating panels are left out of the picture. */
export async function pixels(page: Page): Promise<Picture> {
  const box = await page.locator('.map > canvas').boundingBox();
  if (!box) throw new Error('no canvas');
  // A constructed sheet: the page's content policy refuses style elements.
  await page.evaluate(() => {
    const sheet = new CSSStyleSheet();
    sheet.replaceSync('body * { visibility: hidden !important } .map > canvas { visibility: visible !important }');
    document.adoptedStyleSheets = [sheet];
  });
  const png = await page.screenshot({ clip: box, animations: 'disabled' });
  await page.evaluate(() => { document.adoptedStyleSheets = []; });
  return decodePng(png);
}

/** 8-bit RGB or RGBA without interlacing, as Chromium writes. PNG, second edition, section 9: filters. */
function decodePng(png: Buffer): Picture {
  const width = png.readUInt32BE(16);
  const channels = png[25] === 6 ? 4 : 3;
  const parts: Buffer[] = [];
  for (let at = 8; at < png.length; at += 12 + png.readUInt32BE(at))
    if (png.toString('latin1', at + 4, at + 8) === 'IDAT') parts.push(png.subarray(at + 8, at + 8 + png.readUInt32BE(at)));
  const raw = inflateSync(Buffer.concat(parts));
  const stride = width * channels;
  const rows = Buffer.alloc((raw.length / (stride + 1)) * stride);
  for (let row = 0; row * (stride + 1) < raw.length; ++row) unfilter(raw, rows, row, stride, channels);
  return { at: (x, y) => { const i = Math.round(y) * stride + Math.round(x) * channels; return [rows[i] ?? 0, rows[i + 1] ?? 0, rows[i + 2] ?? 0]; } };
}

function unfilter(raw: Buffer, rows: Buffer, row: number, stride: number, channels: number): void {
  const filter = raw[row * (stride + 1)];
  for (let i = 0; i < stride; ++i) {
    const left = i >= channels ? (rows[row * stride + i - channels] ?? 0) : 0;
    const up = row > 0 ? (rows[(row - 1) * stride + i] ?? 0) : 0;
    const corner = row > 0 && i >= channels ? (rows[(row - 1) * stride + i - channels] ?? 0) : 0;
    const guess = left + up - corner;
    const [a, b, c] = [Math.abs(guess - left), Math.abs(guess - up), Math.abs(guess - corner)];
    const paeth = a <= b && a <= c ? left : b <= c ? up : corner;
    const add = filter === 1 ? left : filter === 2 ? up : filter === 3 ? (left + up) >> 1 : filter === 4 ? paeth : 0;
    rows[row * stride + i] = ((raw[row * (stride + 1) + 1 + i] ?? 0) + add) & 255;
  }
}
