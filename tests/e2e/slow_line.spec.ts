// A page at the end of a slow line is told the truth about it, and in the end has the whole map.
import { expect, test, type Page } from '@playwright/test';
import { keys, state, tile } from './flog_page';
import { Program } from './program';
import { SlowLine } from './slow_line';

const BYTES_PER_S = 30_000;
const DELAY_MS = 100; // there, and as much back

interface Changes { readonly more: boolean; readonly tiles: readonly { level: number; x: number; y: number; rev: number }[] }

/** Tiles of the finest level and their revisions; overviews are made of them. */
async function served(program: Program): Promise<[string, number][]> {
  const { tiles, more } = await program.json<Changes>('maps/live/changes?since=0&limit=10000');
  expect(more).toBe(false);
  return tiles.filter(({ level }) => level === 0).map(({ level, x, y, rev }): [string, number] => [`${level}/${x}/${y}`, rev]).sort();
}

async function held(page: Page): Promise<[string, number][]> {
  const all = await Promise.all((await keys(page)).filter((key) => key.startsWith('0/')).map(async (key): Promise<[string, number]> => {
    const [level, x, y] = key.split('/').map(Number) as [number, number, number];
    return [key, (await tile(page, level, x, y))?.rev ?? -1];
  }));
  return all.sort();
}

/** Every word that the chip says from now on, each once, without its number. */
async function wordsOfTheChip(page: Page): Promise<() => Promise<string[]>> {
  await page.locator('.chip').waitFor();
  await page.evaluate(() => {
    const said = new Set<string>();
    Object.assign(window, { __said: said });
    const chip = document.querySelector('.chip') as Element;
    const note = (): void => { said.add((chip.textContent ?? '').replace(/[\d:.]+.*/, '').trim()); };
    new MutationObserver(note).observe(chip, { subtree: true, childList: true, characterData: true });
    note();
  });
  return () => page.evaluate(() => [...(window as never as { __said: Set<string> }).__said]);
}

test('a slow line is called slow and never dead, and brings the whole map', async ({ page }) => {
  const program = await Program.start('sim:room');
  const line = await SlowLine.to(program.port, 3_000_000, DELAY_MS); // the page's own files come quickly
  try {
    await expect.poll(async () => (await program.json<{ tiles: number }>('maps/live').catch(() => ({ tiles: 0 }))).tiles, { timeout: 60_000 }).toBeGreaterThan(20);
    await page.goto(`${line.url}/?fresh`, { waitUntil: 'commit' });
    line.bytesPerS = BYTES_PER_S;
    const said = await wordsOfTheChip(page);
    await expect(page.locator('.chip')).toHaveText(/Resuming \d+ %/, { timeout: 120_000 });
    await expect.poll(async () => (await state(page)).tiles, { timeout: 60_000 }).toBeGreaterThan(3); // what is in view comes first
    await expect.poll(said, { timeout: 120_000 }).toContain('Lagging'); // the camera walks on: more changes than the line carries
    const before = await state(page);
    await expect.poll(async () => (await state(page)).rev, { timeout: 60_000 }).toBeGreaterThan(before.rev); // it moves on all the same
    await program.post('session:pause');
    await expect.poll(async () => JSON.stringify(await held(page)) === JSON.stringify(await served(program)), { timeout: 120_000, intervals: [2000] }).toBe(true);
    await expect(page.locator('.chip')).toHaveText(/Live/, { timeout: 60_000 });
    expect(await said()).not.toContain('Offline since');
  } finally {
    line.close();
    await program.end();
  }
});
