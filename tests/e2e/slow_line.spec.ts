// A page at the end of a slow line is told the truth about it, and in the end has the whole map.
import { expect, test, type Page } from '@playwright/test';
import { sameBytes, state } from './flog_page';
import { Program } from './program';
import { SlowLine } from './slow_line';

const BYTES_PER_S = 30_000;
const DELAY_MS = 100; // there, and as much back

interface Changes { readonly more: boolean; readonly tiles: readonly { level: number; x: number; y: number; rev: number }[] }

/** All tiles, overviews too, and their revisions. */
async function served(program: Program): Promise<[string, number][]> {
  const { tiles, more } = await program.json<Changes>('maps/live/changes?since=0&limit=10000');
  expect(more).toBe(false);
  return tiles.map(({ level, x, y, rev }) => [`${level}/${x}/${y}`, rev]);
}

const held = (page: Page): Promise<[string, number][]> =>
  page.evaluate(() => (window as never as { __flog: { revisions(): [string, number][] } }).__flog.revisions());

/** What the page lacks, has in another revision, or has too much; as "level/x/y: here, there". */
async function differences(page: Page, program: Program): Promise<string[]> {
  const [here, there] = [new Map(await held(page)), new Map(await served(program))];
  const all = new Set([...here.keys(), ...there.keys()]);
  return [...all].filter((key) => here.get(key) !== there.get(key)).map((key) => `${key}: ${here.get(key) ?? 'none'}, ${there.get(key) ?? 'none'}`);
}

/** Every word that the chip says from now on, each once, without its number. */
async function wordsOfTheChip(page: Page): Promise<() => Promise<string[]>> {
  await page.locator('.chip').waitFor();
  await page.evaluate(() => {
    const said = new Set<string>();
    Object.assign(window, { __said: said });
    const chip = document.querySelector('.chip') as Element;
    const note = (): void => {
      const words = (chip.textContent ?? '').replace(/[\d:.]+.*/, '').trim();
      said.add(words.startsWith('Offline') ? `${words} ${document.querySelector('.banner')?.textContent ?? ''}` : words); // with the reason
    };
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
    await expect.poll(() => differences(page, program), { timeout: 120_000, intervals: [2000] }).toEqual([]);
    await expect(page.locator('.chip')).toHaveText(/Live/, { timeout: 60_000 });
    expect((await said()).filter((words) => words.startsWith('Offline'))).toEqual([]);
    line.bytesPerS = 3_000_000; // comparing keeps this process busy, and the line with it
    await sameBytes(page, program, (await held(page)).map(([key]) => key));
  } finally {
    line.close();
    await program.end();
  }
});
