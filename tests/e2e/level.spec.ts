// The map is tilted, turned and raised by hand: tried out, applied, taken back, and kept over a restart.
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { expect, test, type Page } from '@playwright/test';
import { open, pixels, quiet } from './flog_page';
import { Program } from './program';

interface Level { roll_deg: number; pitch_deg: number; yaw_deg: number; height_m: number; obstacle: string | null }

let program: Program;
let folder: string;
const serve = (port = 0, source = 'sim:room'): Promise<Program> => Program.start(source, port, ['--store', path.join(folder, 'map.flog')]);
const level = async (): Promise<Level> => (await program.json<{ level: Level }>('session')).level;
const setLevel = (body: object): Promise<unknown> => program.json('session:level', { method: 'POST', headers: { 'Content-Type': 'application/json' }, body: JSON.stringify(body) });
const revision = async (): Promise<number> => (await program.json<{ rev: number }>('maps/live')).rev;
const heights = (page: Page): Promise<readonly (readonly number[])[]> => page.evaluate(() => (window as never as { __flog: { path: number[][] } }).__flog.path);

/** What the page holds of level 0: a sum over the planes of each tile that holds anything. */
const cells = async (page: Page): Promise<Map<string, string>> => new Map(await page.evaluate(() => {
  const flog = (window as never as { __flog: { keys(): string[]; tile(...at: number[]): { planes: number[] } | null } }).__flog;
  const found: [string, string][] = [];
  for (const key of flog.keys().filter((name) => name.startsWith('0/'))) {
    const planes = flog.tile(...key.split('/').map(Number))?.planes ?? [];
    let [sum, any] = [0x811c9dc5, false];
    for (const value of planes) { sum = Math.imul(sum ^ value, 0x01000193); any ||= value > 0; }
    if (any) found.push([key, `${planes.length} ${sum}`]);
  }
  return found;
}));

/** Waits until the page's map is the server's newest and differs from `before`. */
async function builtAnew(page: Page, before: number): Promise<void> {
  await expect.poll(revision).toBeGreaterThan(before);
  await quiet(page, await revision());
}

const FLOOR = 'three points of the floor';

/** A hall looked down into from 1.5 m: the lower half of every picture is floor. */
const HALL = {
  camera: { width_px: 320, height_px: 240, focal_px: 210, baseline_m: 0.12, rate_hz: 10 }, texel_m: 0.012,
  materials: { wall: { pattern: 'bricks' }, floor: { pattern: 'speckle', size_m: 0.1 } },
  solids: [{ hall: { min: [-4, -4, 0], max: [4, 4, 2.5] }, material: 'wall', bottom: 'floor' }],
  path: { speed_m_s: 0.3, points: [[2, 0], [0, 2], [-2, 0], [0, -2]].map(([x, y]) => ({ at: [x, y, 1.5], look_at: [-0.5 * (x ?? 0), -0.5 * (y ?? 0), 0.2] })) },
};

test.beforeEach(async ({ page }, { title }) => {
  folder = mkdtempSync(path.join(tmpdir(), 'flogmap-level-'));
  const hall = path.join(folder, 'hall.json');
  writeFileSync(hall, JSON.stringify(HALL));
  program = await serve(0, title.startsWith(FLOOR) ? `sim:${hall}` : 'sim:room');
  await open(page, `${program.url}/?fresh`, 8);
  await expect.poll(async () => page.evaluate(() => document.querySelectorAll('.picture-empty[hidden]').length)).toBeGreaterThanOrEqual(2);
  await program.post('session:pause');
  await page.waitForTimeout(2500); // views under way
  await page.locator('.map > canvas').focus();
});
test.afterEach(async () => {
  await program.end();
  rmSync(folder, { recursive: true });
});

test('it is tried out in the page, applied for everybody, and taken back to the same cells', async ({ page, context }) => {
  const other = await context.newPage();
  await open(other, `${program.url}/?fresh`);
  const first = await cells(page);
  const [start] = await heights(page);
  await page.keyboard.press('t');
  await expect(page.getByText('Tilt, turn and raise it')).toBeVisible();
  await page.waitForTimeout(1500);
  const flat = await pixels(page);
  const raise = page.getByLabel('Raise, metres');
  await raise.fill('0.4');
  await raise.press('Enter');
  await page.getByLabel('Tilt left up', { exact: true }).press('ArrowRight');
  await page.getByLabel('Turn left, degrees').fill('20');
  await page.getByLabel('Turn left, degrees').press('Enter');
  await expect(page.getByText('A preview')).toBeVisible();
  await page.waitForTimeout(1500);
  const tried = await pixels(page);
  let differ = 0;
  for (let x = 200; x < 600; x += 10) for (let y = 150; y < 500; y += 10) differ += Math.abs(flat.at(x, y)[1] - tried.at(x, y)[1]) > 16 ? 1 : 0;
  expect(differ).toBeGreaterThan(50); // it is seen
  expect(await level()).toMatchObject({ roll_deg: 0, yaw_deg: 0, height_m: 0, obstacle: null }); // but nobody else has it

  const before = await revision();
  await page.getByRole('button', { name: 'Apply', exact: true }).click();
  await expect.poll(level).toMatchObject({ height_m: 0.4 });
  await builtAnew(page, before);
  expect((await level()).yaw_deg).toBeCloseTo(20, 6);
  expect((await level()).roll_deg).toBeCloseTo(0.1, 6);
  expect((await heights(page))[0]?.[2]).toBeGreaterThan((start?.[2] ?? 0) + 0.3);
  const levelled = await cells(page);
  expect(levelled).not.toEqual(first);
  await quiet(other, await revision());
  expect(await cells(other)).toEqual(levelled);

  await page.getByRole('button', { name: 'Undo', exact: true }).click();
  await expect.poll(level).toMatchObject({ roll_deg: 0, yaw_deg: 0, height_m: 0 });
  await expect.poll(async () => [...await cells(page)].sort()).toEqual([...first].sort());
});

test(`${FLOOR} in the left picture level a map that stands askew`, async ({ page }) => {
  const before = await revision();
  await setLevel({ roll_deg: 7, pitch_deg: -4, height_m: 0.5 });
  await builtAnew(page, before);
  await page.keyboard.press('t');
  await expect(page.getByLabel('Raise, metres')).toHaveValue('0.5');
  await page.getByRole('button', { name: 'Pick the floor' }).click();
  const box = await page.locator('.picture canvas').first().boundingBox();
  for (const [x, y] of [[0.15, 0.97], [0.85, 0.97], [0.5, 0.7]] as const) await page.mouse.click((box?.x ?? 0) + x * (box?.width ?? 0), (box?.y ?? 0) + y * (box?.height ?? 0));
  await expect(page.getByText('A preview')).toBeVisible();
  const value = async (label: string): Promise<number> => Number(await page.getByLabel(label).inputValue());
  expect(Math.abs(await value('Tilt left up, degrees'))).toBeLessThan(1);
  expect(Math.abs(await value('Tilt front down, degrees'))).toBeLessThan(1);
  expect(Math.abs(await value('Raise, metres'))).toBeLessThan(0.05); // the scene's floor is at 0
});

test('a store keeps the level, and what is mapped after a restart fits', async ({ page }) => {
  const before = await revision();
  await setLevel({ yaw_deg: 30, height_m: -0.2 });
  await builtAnew(page, before);
  await page.waitForTimeout(1500); // a commit
  const levelled = await cells(page);
  await program.end();
  program = await serve(program.port);
  expect(await level()).toMatchObject({ height_m: -0.2 });
  expect((await level()).yaw_deg).toBeCloseTo(30, 6);
  await expect.poll(async () => (await program.json<{ level: Level }>('session')).level.obstacle).toContain('reset the map');
  const held = await cells(page);
  let kept = 0;
  for (const key of levelled.keys()) kept += held.has(key) ? 1 : 0;
  expect(kept).toBe(levelled.size);
});
