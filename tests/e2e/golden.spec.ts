// Pictures of a stored map, compared with those in golden/, which people have looked at. The map is made here, and is the same
// on every machine. To renew: npm run e2e -- golden.spec.ts --update-snapshots, then look at every picture that changed.
import { execFileSync } from 'node:child_process';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { expect, test, type Page } from '@playwright/test';
import { open } from './flog_page';
import { ENVIRONMENT, Program, PROGRAM } from './program';

const VIEW = 'v=0,0,90,0';
const SHOTS: readonly (readonly [name: string, hash: string, scheme: 'dark' | 'light', solid?: true])[] = [
  ['visual-cividis', `#${VIEW}`, 'dark'],
  ['paper-grey', `#${VIEW}&p=grey`, 'light'],
  ['planning-viridis', `#${VIEW}&s=planning&p=viridis`, 'dark'],
  ['motion-contrast', `#${VIEW}&s=motion&p=contrast&l=0:1,1:-,2:-`, 'light'],
  ['confidence', `#${VIEW}&s=confidence`, 'dark'],
  ['solid', `#${VIEW}`, 'dark', true],
];

let folder: string;
let program: Program;
test.beforeAll(async () => {
  folder = mkdtempSync(path.join(tmpdir(), 'flogmap-golden-'));
  const [walk, out] = [path.join(folder, 'walk'), path.join(folder, 'map')];
  const run = (...args: string[]): Buffer => execFileSync(PROGRAM, args, { stdio: 'pipe', env: ENVIRONMENT });
  run('simulate', '--scene', 'two-boxes-near', '--frames', '40', '--out', walk);
  run('map', '--source', `euroc:${walk}`, '--poses', path.join(walk, 'groundtruth.tum'), '--out', out); // whatever becomes of odometry
  program = await Program.launch(['serve', '--store', path.join(out, 'map.flog')]);
});
test.afterAll(async () => {
  await program.end();
  rmSync(folder, { recursive: true });
});

/** Nothing but the map: letters look different on every machine. */
async function onlyTheMap(page: Page): Promise<void> {
  await page.evaluate(() => {
    const sheet = new CSSStyleSheet();
    sheet.replaceSync('body * { visibility: hidden !important } .map > canvas { visibility: visible !important }');
    document.adoptedStyleSheets = [sheet];
  });
}

for (const [name, hash, scheme, solid] of SHOTS)
  test(`the stored map looks as it did: ${name}`, async ({ page }) => {
    await page.emulateMedia({ colorScheme: scheme, reducedMotion: 'reduce' });
    await open(page, `${program.url}/?fresh${hash}`, 2);
    if (solid) {
      await page.locator('.map > canvas').focus();
      await page.keyboard.press('v');
      await page.locator('.map > canvas').blur(); // without the ring of the focus
    }
    await page.waitForTimeout(3000);
    await onlyTheMap(page);
    await expect(page.locator('.map > canvas')).toHaveScreenshot(`${name}.png`, { maxDiffPixelRatio: 0.01, threshold: 0.1 });
  });
