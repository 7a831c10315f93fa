// A recording whose right pictures were taken later than the left ones: the page says by how much, in words and as a curve.
import { cpSync, existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, symlinkSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { expect, test } from '@playwright/test';
import { open } from './flog_page';
import { Program } from './program';

const DATA = process.env['FLOGMAP_DATA'];
const RECORDING = path.join(DATA ?? '', 'euroc_mh01_10hz/mav0');
const LATE_NS = 1_500_000n; // within what a pair may differ by

test.skip(!DATA || !existsSync(RECORDING), 'FLOGMAP_DATA does not hold euroc_mh01_10hz: there is no recording to shift');

/** The same pictures; the times of the right ones are later. */
function shifted(): string {
  const folder = mkdtempSync(path.join(tmpdir(), 'flogmap-skew-'));
  for (const camera of ['cam0', 'cam1']) {
    mkdirSync(path.join(folder, 'mav0', camera), { recursive: true });
    symlinkSync(path.join(RECORDING, camera, 'data'), path.join(folder, 'mav0', camera, 'data'));
    cpSync(path.join(RECORDING, camera, 'sensor.yaml'), path.join(folder, 'mav0', camera, 'sensor.yaml'));
    const rows = readFileSync(path.join(RECORDING, camera, 'data.csv'), 'utf8').split('\n');
    const late = (row: string): string => row.replace(/^\d+/, (time) => String(BigInt(time) + LATE_NS));
    writeFileSync(path.join(folder, 'mav0', camera, 'data.csv'), (camera === 'cam0' ? rows : rows.map(late)).join('\n'));
  }
  return folder;
}

test('the time between left and right pictures is told and drawn, with its limit', async ({ page }) => {
  const folder = shifted();
  const program = await Program.start(`euroc:${folder}`, 0, ['--loop']);
  try {
    await page.setViewportSize({ width: 1280, height: 1600 });
    await open(page, `${program.url}/?fresh`, 1);
    await expect(page.locator('.facts')).toContainText('1.50 ms, at most 1.5');
    const chart = page.locator('.chart-box', { hasText: 'Left to right' });
    await expect(chart).toContainText('allowed');
    await chart.scrollIntoViewIfNeeded();
    await page.waitForTimeout(5000); // a sample a second
    const coloured = await chart.locator('canvas').evaluate((canvas: HTMLCanvasElement) => {
      const data = canvas.getContext('2d')?.getImageData(0, 0, canvas.width, canvas.height).data ?? new Uint8ClampedArray();
      let count = 0;
      for (let i = 0; i < data.length; i += 4) {
        const [r = 0, g = 0, b = 0, opaque = 0] = data.slice(i, i + 4);
        if (opaque > 200 && Math.max(r, g, b) - Math.min(r, g, b) > 60) ++count;
      }
      return count;
    });
    expect(coloured).toBeGreaterThan(20); // curves, not axes alone
    await page.screenshot({ path: path.join(test.info().outputDir, 'skew.png') });
  } finally {
    await program.end();
    rmSync(folder, { recursive: true });
  }
});
