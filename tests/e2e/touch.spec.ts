// A phone of 390 px with a finger: the stick walks, dragging looks, tapping chooses.
import { expect, test, type CDPSession, type Page } from '@playwright/test';
import { open } from './flog_page';
import { Program } from './program';

test.use({ viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true });

interface Walk { readonly views: number; readonly shown: number; readonly position: number[]; readonly yaw: number }
const walk = (page: Page): Promise<Walk> => page.evaluate(() => (window as never as { __flog: { walk: Walk } }).__flog.walk);

async function touch(cdp: CDPSession, kind: 'touchStart' | 'touchMove' | 'touchEnd', x = 0, y = 0): Promise<void> {
  await cdp.send('Input.dispatchTouchEvent', { type: kind, touchPoints: kind === 'touchEnd' ? [] : [{ x, y }] });
}

test('the stick walks, a drag looks around, and the map comes back', async ({ page }) => {
  const program = await Program.start('sim:room');
  try {
    await open(page, `${program.url}/?fresh`);
    await expect.poll(async () => (await program.json<{ views: unknown[] }>('maps/live/views')).views.length).toBeGreaterThan(4);
    await program.post('session:pause');
    await page.getByRole('button', { name: 'Walk through the mapped views' }).tap();
    await expect.poll(async () => (await walk(page)).shown).toBeGreaterThan(0);
    const cdp = await page.context().newCDPSession(page);
    const stick = await page.locator('.stick').boundingBox();
    if (!stick) throw new Error('no stick for the thumb');
    expect(stick.x).toBeGreaterThanOrEqual(0);
    expect(stick.x + stick.width).toBeLessThanOrEqual(390);
    const [x, y] = [stick.x + stick.width / 2, stick.y + stick.height / 2];
    const from = (await walk(page)).position;
    await touch(cdp, 'touchStart', x, y);
    await touch(cdp, 'touchMove', x, y - 40);
    await expect.poll(async () => { const { position } = await walk(page); return Math.hypot(...position.map((p, i) => p - (from[i] ?? 0))); }).toBeGreaterThan(0.3);
    await touch(cdp, 'touchEnd');
    await page.waitForTimeout(800);
    const stands = (await walk(page)).position;
    await page.waitForTimeout(1200);
    expect((await walk(page)).position).toEqual(stands); // let go: it stands
    const { yaw } = await walk(page);
    await touch(cdp, 'touchStart', 195, 300);
    for (let i = 1; i <= 6; ++i) await touch(cdp, 'touchMove', 195 + 15 * i, 300);
    await touch(cdp, 'touchEnd');
    await expect.poll(async () => Math.abs((await walk(page)).yaw - yaw), { timeout: 10_000 }).toBeGreaterThan(0.1); // a drag of 90 px
    expect((await walk(page)).position).toEqual(stands); // the head turned, the feet did not
    await page.getByRole('button', { name: 'Leave' }).tap();
    await expect(page.locator('.tabs')).toBeVisible();
    await page.locator('.tabs').getByRole('button', { name: 'Cell' }).tap();
    await expect(page.getByText('Point at the map')).toBeVisible();
  } finally {
    await program.end();
  }
});
