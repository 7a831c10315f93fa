// One viewer on a slow line: it says so, gets the newest instead of everything, and nobody else notices.
import { expect, test, type Page } from '@playwright/test';
import { open, state } from './flog_page';
import { Program } from './program';
import { SlowLine } from './slow_line';

test.use({ viewport: { width: 480, height: 360 } }); // two pages are drawn without a graphics card, beside the mapping

const poseS = (page: Page): Promise<number> => page.evaluate(() => (window as never as { __flog: { poseS: number } }).__flog.poseS);

/** How far the newest pose of a page lies behind another's, s, the worst of some looks. */
async function behind(page: Page, other: Page, looks: number): Promise<number> {
  let worst = 0;
  for (let i = 0; i < looks; ++i) {
    worst = Math.max(worst, (await poseS(other)) - (await poseS(page)));
    await page.waitForTimeout(1000);
  }
  return worst;
}

test('a slow viewer lags, says so, gets the newest pose and in the end the whole map; the other one stays live', async ({ page, context }) => {
  const program = await Program.start('sim:room', 0, ['--threads', '1']);
  const line = await SlowLine.to(program.port, 4_000_000);
  try {
    await open(page, `${line.url}/?fresh`);
    const quick = await context.newPage();
    await open(quick, `${program.url}/?fresh`);
    line.bytesPerSecond = 9_000; // less than tiles, pictures and poses ask for
    await expect(page.locator('.chip')).toHaveText(/Lagging/, { timeout: 60_000 });
    await expect(quick.locator('.chip')).toHaveText(/Live/);
    expect(await behind(page, quick, 8)).toBeLessThan(20); // a batch at most waits before a pose: no backlog that grows
    const before = await poseS(page);
    await expect.poll(() => poseS(page)).toBeGreaterThan(before); // and it still comes
    await program.post('session:pause');
    line.bytesPerSecond = 4_000_000;
    await expect(page.locator('.chip')).toHaveText(/Live/, { timeout: 60_000 });
    const { rev } = await program.json<{ rev: number }>('maps/live');
    for (const viewer of [page, quick]) await expect.poll(async () => (await state(viewer)).rev).toBe(rev);
    expect((await state(page)).tiles).toBe((await state(quick)).tiles);
    expect(await poseS(page)).toBe(await poseS(quick));
  } finally {
    line.close();
    await program.end();
  }
});
