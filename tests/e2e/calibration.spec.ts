// Live calibration in the browser: pictures with corners, where the board has been, the verdict.
import { expect, test } from '@playwright/test';
import { existsSync, mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { Program } from './program';

const BOARDS = path.join(process.env['FLOGMAP_DATA'] ?? '', 'calibration_chessboard/case1');

test('a board is shown to both cameras and the verdict is read', async ({ page }) => {
  test.skip(!process.env['FLOGMAP_DATA'] || !existsSync(BOARDS), 'needs FLOGMAP_DATA with calibration_chessboard');
  const folder = mkdtempSync(path.join(tmpdir(), 'flogmap-calibration-'));
  const out = path.join(folder, 'calib.yaml');
  const program = await Program.launch(['calibrate', '--source', `images:${BOARDS}/left*,${BOARDS}/right*`, '--serve',
    '--board', '9x6', '--square-mm', '25', '--out', out]);
  try {
    const faults: string[] = [];
    page.on('console', (message) => { if (message.type() === 'error') faults.push(message.text()); });
    await page.goto(`${program.url}/calibrate.html`);
    await expect(page.locator('.count')).toHaveText('13 pairs kept');
    for (const side of ['left', 'right']) await expect(page.getByRole('img', { name: `${side} camera` })).toBeVisible();
    const size = await page.locator('canvas').first().evaluate((canvas: HTMLCanvasElement) => [canvas.width, canvas.height]);
    expect(size).toEqual([640, 480]);
    await page.getByRole('button', { name: 'Calibrate' }).click();
    await expect(page.locator('.verdict')).toContainText('Corners off by');
    await expect(page.locator('.verdict')).toContainText(out);
    await expect(page.getByRole('status')).toHaveText('Calibrated');
    expect(existsSync(out)).toBe(true);
    expect(faults).toEqual([]);
  } finally {
    await program.end();
    rmSync(folder, { recursive: true, force: true });
  }
});
