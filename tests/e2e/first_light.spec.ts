// A map grows in the page while the camera walks; what is drawn is what the server holds, by the rules that are chosen.
import { expect, test, type Page } from '@playwright/test';
import { rampColour } from '../../web/src/palette';
import { styleValue, type Style } from '../../web/src/rules';
import { keys, open, pixels, PLANE, project, quiet, sameBytes, state, tile } from './flog_page';
import { Program } from './program';

let program: Program;

test.beforeAll(async () => { program = await Program.start('sim:room'); });
test.afterAll(async () => { await program.end(); });

/** Stops the camera and waits until the views under way are mapped and shown. */
async function pause(page: Page): Promise<void> {
  const { state: now } = await program.json<{ state: string }>('session');
  if (now === 'running') await program.post('session:pause');
  const rev = async (): Promise<number> => (await program.json<{ rev: number }>('maps/live')).rev;
  for (let before = -1, still = 0; still < 3; await page.waitForTimeout(1000)) {
    const here = await rev();
    still = here === before ? still + 1 : 0;
    before = here;
  }
  await quiet(page, await rev());
}

test.afterEach(async () => { // also after a failure, or the next test would wait for ever
  if ((await program.json<{ state: string }>('session')).state === 'paused') await program.post('session:resume');
});

test('the room appears and grows while the camera walks', async ({ page }) => {
  const errors: string[] = [];
  page.on('pageerror', (error) => errors.push(error.message));
  page.on('console', (message) => { if (message.type() === 'error') errors.push(message.text()); });
  await open(page, program.url);
  const before = await state(page);
  await expect.poll(async () => (await state(page)).rev).toBeGreaterThan(before.rev);
  await expect.poll(async () => (await state(page)).trajectoryLength).toBeGreaterThan(before.trajectoryLength);
  await expect(page.locator('.chip')).toHaveText(/Live|Lagging/);
  for (const picture of ['Left', 'Disparity'])
    await expect.poll(() => page.locator(`canvas[aria-label^="${picture}"]`).evaluate((canvas: HTMLCanvasElement) => canvas.width)).toBeGreaterThan(100);
  expect(errors).toEqual([]);
});

test('the page holds the server’s tiles, byte for byte', async ({ page }) => {
  await open(page, program.url);
  await pause(page);
  const held = await keys(page);
  expect(held.filter((key) => key.startsWith('0/')).length).toBeGreaterThan(3);
  expect(new Set(held.map((key) => key[0])).size).toBeGreaterThan(3); // overviews as well
  await sameBytes(page, program, held);
});

interface Column {
  readonly x: number;
  readonly y: number;
  readonly evidence: readonly (readonly [E: number, O: number, K: number, C: number])[];
}

/** Columns that every layer has seen, of the tiles in the page, none at a tile's edge and none marked as in conflict. */
async function seenColumns(page: Page): Promise<Column[]> {
  const { cell_size: cell, layers } = await program.json<{ cell_size: number; layers: unknown[] }>('maps/live');
  const found: Column[] = [];
  for (const key of (await keys(page)).filter((text) => text.startsWith('0/'))) {
    const [, tx, ty] = key.split('/').map(Number) as [number, number, number];
    const planes = (await tile(page, 0, tx, ty))?.planes ?? [];
    for (let column = 65; column < PLANE - 65; column += 37) {
      const evidence = layers.map((_, k) => [0, 1, 2, 3].map((i) => (planes[k * 4 * PLANE + 4 * column + i] ?? 0) / 255) as [number, number, number, number]);
      const seen = evidence.every(([, , K]) => K > 0.2);
      const conflict = Math.max(...evidence.map(([E, O, K]) => 2 * Math.min(E, O) * K));
      if (seen && conflict < 0.85) found.push({ x: (tx * 64 + (column % 64) + 0.5) * cell, y: (ty * 64 + Math.floor(column / 64) + 0.5) * cell, evidence });
    }
  }
  return found;
}

const fusedValue = (style: Style, { evidence }: Column): number =>
  Math.max(...evidence.map(([E, O, K, C]) => styleValue(style, 'algebraic', { E, O, K, C })));

/** The column with the most others within `reach` metres, far enough from the camera's mark. */
async function clearSpot(columns: readonly Column[], reach: number): Promise<Column> {
  const { points } = await program.json<{ points: { position: [number, number, number] }[] }>('maps/live/trajectory');
  const [cx, cy] = points.at(-1)?.position ?? [0, 0];
  const around = (a: Column): number => columns.filter((b) => Math.abs(a.x - b.x) < reach && Math.abs(a.y - b.y) < reach).length;
  const [best] = columns.filter(({ x, y }) => Math.hypot(x - cx, y - cy) > 2).map((column) => ({ column, count: around(column) })).sort((a, b) => b.count - a.count);
  if (!best) throw new Error('nothing is mapped two metres from the camera');
  return best.column;
}

test('every pixel has the colour that rules and palette give to its cell', async ({ page }) => {
  await open(page, program.url);
  await page.getByRole('switch', { name: 'Grid', exact: true }).click();
  await page.getByRole('switch', { name: 'Path', exact: true }).click();
  await pause(page);
  const spot = await clearSpot(await seenColumns(page), 0.6);
  await page.goto(`${program.url}/?near#v=${spot.x.toFixed(3)},${spot.y.toFixed(3)},400,0`); // a cell is eight pixels wide
  await quiet(page, (await program.json<{ rev: number }>('maps/live')).rev);
  const canvas = await page.locator('.map > canvas').boundingBox();
  const columns = await seenColumns(page);
  for (const style of ['visual', 'planning', 'motion', 'confidence'] as const) {
    await page.locator(`.rules input[value="${style}"]`).check({ force: true });
    await page.waitForTimeout(700);
    const picture = await pixels(page);
    const off: number[] = [];
    for (const column of columns) {
      const at = await project(page, column.x, column.y);
      if (!canvas || at.x < 4 || at.y < 4 || at.x > canvas.width - 4 || at.y > canvas.height - 4) continue;
      const expected = rampColour('cividis', Math.round(255 * fusedValue(style, column)) / 255);
      off.push(Math.max(...picture.at(at.x, at.y).map((channel, i) => Math.abs(channel - (expected[i] ?? 0)))));
    }
    expect(off.length, style).toBeGreaterThan(30);
    expect(Math.max(...off), `${style}: ${off.length} pixels, farthest off`).toBeLessThanOrEqual(4); // one step of the ramp
  }
});

test('a click shows the evidence of the column as the server has it', async ({ page }) => {
  await open(page, program.url);
  await pause(page);
  const spot = (await seenColumns(page))[20];
  if (!spot) throw new Error('nothing seen');
  const at = await project(page, spot.x, spot.y);
  await page.locator('.map > canvas').click({ position: at });
  const where = (await page.locator('.cell-where').textContent()) ?? '';
  const [x, y] = where.match(/-?\d+\.\d+/g)?.map(Number) ?? [];
  await expect(page.locator('.cell-layer .rays').first()).toHaveText(/N \d+/);
  const served = await program.json<{ layers: { layer: number; E: number; N: number }[] }>(`maps/live/cell?x=${x}&y=${y}`);
  for (const { layer } of served.layers) await expect(page.locator(`.cell-layer[data-layer="${layer}"] .bar`)).toHaveCount(3);
});

test('a reload in the middle gives the whole map again', async ({ page }) => {
  await open(page, program.url);
  await pause(page);
  const before = { ...(await state(page)), keys: (await keys(page)).sort() };
  await page.reload();
  await open(page, program.url, before.tiles);
  await quiet(page, before.rev);
  const after = { ...(await state(page)), keys: (await keys(page)).sort() };
  expect(after.keys).toEqual(before.keys);
  expect(after.trajectoryLength).toBe(before.trajectoryLength);
});

test('two pages see the same map', async ({ page, context }) => {
  const other = await context.newPage();
  await open(page, program.url);
  await open(other, program.url);
  await pause(page);
  await quiet(other, (await state(page)).rev);
  expect((await keys(other)).sort()).toEqual((await keys(page)).sort());
  expect(await state(other)).toMatchObject({ epoch: (await state(page)).epoch, rev: (await state(page)).rev });
  await other.close();
});
