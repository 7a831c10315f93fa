// A real recording becomes the same live map in two pages, also after a reload in the middle, and in `flogmap map`.
import { execFileSync } from 'node:child_process';
import { existsSync, mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { expect, test, type Page } from '@playwright/test';
import { keys, open, state, tile } from './flog_page';
import { ENVIRONMENT, Program, PROGRAM } from './program';

const DATA = process.env['FLOGMAP_DATA'];
const RECORDING = path.join(DATA ?? '', 'euroc_mh01_10hz');

test.skip(!DATA || !existsSync(RECORDING), 'FLOGMAP_DATA does not hold euroc_mh01_10hz: no real recording is played');

interface Changes {
  readonly rev: number;
  readonly more: boolean;
  readonly tiles: readonly { level: number; x: number; y: number; rev: number }[];
}

/** Every tile the server has, as the page names them, with its revision. */
async function served(program: Program): Promise<Map<string, number>> {
  const { tiles, more } = await program.json<Changes>('maps/live/changes?since=0&limit=10000');
  expect(more).toBe(false);
  return new Map(tiles.map(({ level, x, y, rev }) => [`${level}/${x}/${y}`, rev]));
}

/** Tile revisions as the page holds them. */
async function held(page: Page): Promise<Map<string, number>> {
  const found = new Map<string, number>();
  for (const key of await keys(page)) {
    const [level, x, y] = key.split('/').map(Number) as [number, number, number];
    found.set(key, (await tile(page, level, x, y))?.rev ?? -1);
  }
  return found;
}

const sorted = (tiles: Map<string, number>): [string, number][] => [...tiles].filter(([key]) => key.startsWith('0/')).sort();

test('a real recording becomes the same live map in two pages, one of them reloaded in the middle', async ({ page, context }) => {
  const program = await Program.start(`euroc:${RECORDING}`);
  try {
    await open(page, program.url);
    const other = await context.newPage();
    await open(other, program.url);
    expect((await program.json<{ state: string }>('session')).state).toMatch(/running|finished/);
    await page.reload();
    await expect.poll(async () => (await program.json<{ state: string }>('session')).state, { timeout: 120_000 }).toBe('finished');
    // What has been read is finished; what is counted follows with the next status, half a second later at most.
    const counted = async (): Promise<unknown> => program.json('session');
    await expect.poll(counted, { timeout: 10_000 }).toMatchObject({ frames: 110, tracked: 110, lost: 0 });
    const { rev } = await program.json<{ rev: number }>('maps/live');
    for (const viewer of [page, other]) {
      await expect.poll(async () => (await state(viewer)).rev).toBe(rev);
      await expect.poll(async () => (await state(viewer)).trajectoryLength).toBe(110);
      await expect(viewer.locator('.chip')).toHaveText(/Live/);
      // The revision is that of the newest batch; the last ones of the same round may still be on the way.
      await expect.poll(async () => sorted(await held(viewer))).toEqual(sorted(await served(program)));
    }
    await page.getByRole('button', { name: 'Show the whole map' }).click();
    await page.screenshot({ path: path.join(test.info().outputDir, 'recording.png') });
  } finally {
    await program.end();
  }
});

test('the live map is the map that the headless run writes', async () => {
  const program = await Program.start(`euroc:${RECORDING}`, 0, ['--pace', 'fast']);
  const out = mkdtempSync(path.join(tmpdir(), 'flogmap-e2e-'));
  try {
    execFileSync(PROGRAM, ['map', '--source', `euroc:${RECORDING}`, '--out', path.join(out, 'map')], { stdio: 'pipe', env: ENVIRONMENT });
    await expect.poll(async () => (await program.json<{ state: string }>('session')).state, { timeout: 120_000 }).toBe('finished');
    // What has been read is finished; the last frames are tracked a moment later.
    await expect.poll(async () => (await program.json<{ tracked: number }>('session')).tracked, { timeout: 20_000 }).toBe(110);
    expect(await (await fetch(`${program.url}/api/v1/maps/live/trajectory?format=tum`)).text()).toBe(execFileSync('cat', [path.join(out, 'map/trajectory.tum')]).toString());
  } finally {
    await program.end();
    rmSync(out, { recursive: true });
  }
});
