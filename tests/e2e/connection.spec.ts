// A server that dies and comes back; the page never shows a stale map as live.
import { expect, test } from '@playwright/test';
import { open, state } from './flog_page';
import { Program } from './program';

test('a killed server is said to be gone, and its successor is found without a reload', async ({ page }) => {
  const first = await Program.start('sim:room');
  await open(page, first.url);
  const { epoch } = await state(page);
  await first.end('SIGKILL');
  await expect(page.locator('.chip')).toHaveText(/Offline since/);
  await expect(page.locator('.banner')).toContainText('map as of');
  await expect(page.locator('.map > canvas')).toHaveClass(/stale/);
  const second = await Program.start('sim:room', first.port);
  try {
    await expect.poll(async () => (await state(page)).epoch, { timeout: 60_000 }).not.toBe(epoch);
    await expect(page.locator('.chip')).toHaveText(/Live|Lagging/, { timeout: 60_000 });
    await expect(page.locator('.banner')).toBeHidden();
    await expect(page.locator('.map > canvas')).not.toHaveClass(/stale/);
  } finally {
    await second.end();
  }
});

test('a new map empties the page', async ({ page }) => {
  const program = await Program.start('sim:room');
  try {
    await open(page, program.url);
    const { epoch } = await state(page);
    page.on('dialog', (dialog) => void dialog.dismiss());
    await page.getByRole('button', { name: 'Begin a new map' }).click();
    await page.getByRole('button', { name: 'Begin anew' }).click();
    await expect.poll(async () => (await state(page)).epoch).not.toBe(epoch);
    await expect.poll(async () => (await state(page)).tiles).toBeGreaterThan(2);
  } finally {
    await program.end();
  }
});
