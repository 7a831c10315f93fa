// A recording is stopped, stepped, hastened and wound back; a view follows the camera; a link says that the map has moved on.
import { existsSync } from 'node:fs';
import path from 'node:path';
import { expect, test, type Page } from '@playwright/test';
import { open, project, state } from './flog_page';
import { Program } from './program';

const DATA = process.env['FLOGMAP_DATA'];
const RECORDING = path.join(DATA ?? '', 'euroc_mh01_10hz');

interface Playback { readonly position_s: number; readonly rate: number; readonly paused: boolean }

test.describe('with a recording', () => {
  test.skip(!DATA || !existsSync(RECORDING), 'FLOGMAP_DATA does not hold euroc_mh01_10hz: no recording is played');

  test('the replay is paused, stepped, hastened and wound back', async ({ page }) => {
    const program = await Program.start(`euroc:${RECORDING}`, 0, ['--loop']);
    const playback = (): Promise<Playback> => program.json<Playback>('playback');
    try {
      await open(page, `${program.url}/?fresh`, 1);
      await page.getByRole('button', { name: 'Pause the replay' }).click();
      await expect.poll(async () => (await playback()).paused).toBe(true);
      await page.waitForTimeout(1000); // what was under way
      const { position_s: before } = await playback();
      await page.getByRole('button', { name: 'One frame further' }).click();
      await expect.poll(async () => (await playback()).position_s).toBeCloseTo(before + 0.1, 2);
      await page.getByRole('combobox', { name: 'Speed of the replay' }).selectOption('0.5');
      await expect.poll(async () => (await playback()).rate).toBe(0.5);
      const { epoch } = await state(page);
      await page.getByRole('slider', { name: 'Position in the recording' }).fill('0.5');
      await expect.poll(async () => (await state(page)).epoch, { message: 'winding back begins a new map' }).not.toBe(epoch);
      await page.getByRole('button', { name: 'Go on with the replay' }).click();
      await expect.poll(async () => (await playback()).position_s).toBeGreaterThan(0.8);
      await expect.poll(async () => (await state(page)).tiles).toBeGreaterThan(0);
    } finally {
      await program.end();
    }
  });

  test('who comes after the end sees where the camera stands, and may play it again', async ({ page }) => {
    const program = await Program.start(`euroc:${RECORDING}`, 0, ['--pace', 'fast']);
    try {
      await expect.poll(async () => (await program.json<{ state: string }>('session')).state, { timeout: 120_000 }).toBe('finished');
      await page.waitForTimeout(1500); // it rests
      await open(page, `${program.url}/?fresh`, 1);
      const { epoch } = await state(page);
      expect(await page.evaluate(() => (window as never as { __flog: { poseS: number } }).__flog.poseS)).toBeGreaterThan(0);
      await page.getByRole('button', { name: 'Play again from the start' }).click();
      await expect.poll(async () => (await state(page)).epoch, { message: 'a new map begins' }).not.toBe(epoch);
      await expect(page.getByRole('button', { name: 'Pause the replay' })).toBeVisible();
    } finally {
      await program.end();
    }
  });
});

/** CSS pixels from the middle of the map to the newest pose. */
async function offTheMiddle(page: Page): Promise<number> {
  const [x = 0, y = 0] = await page.evaluate(() => (window as never as { __flog: { path: number[][] } }).__flog.path[1] ?? []);
  const at = await project(page, x, y);
  const box = await page.locator('.map > canvas').boundingBox();
  return Math.hypot(at.x - (box?.width ?? 0) / 2, at.y - (box?.height ?? 0) / 2);
}

test('the view follows the camera, and a link says what has changed since it was made', async ({ page }) => {
  const program = await Program.start('sim:room');
  try {
    await open(page, `${program.url}/?fresh`);
    await page.locator('.map > canvas').focus();
    await page.keyboard.press('f');
    await page.keyboard.press('+'); // about the camera
    await page.waitForTimeout(3000);
    for (let i = 0; i < 3; ++i) {
      expect(await offTheMiddle(page)).toBeLessThan(60); // it glides, and the camera walks on
      await page.waitForTimeout(1500);
    }
    const { epoch, rev } = await state(page);
    await expect.poll(async () => (await state(page)).rev).toBeGreaterThan(rev);
    await page.goto('about:blank');
    await page.goto(`${program.url}/?fresh#e=${epoch}&r=${rev}`);
    await expect(page.getByText(/The map has moved on by \d+ changes/)).toBeVisible();
    await page.goto('about:blank');
    await page.goto(`${program.url}/?fresh#e=0123456789abcdef&r=1`);
    await expect(page.getByText(/made on another map/)).toBeVisible();
  } finally {
    await program.end();
  }
});
