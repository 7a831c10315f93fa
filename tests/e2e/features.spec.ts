// One server for what a person can do with the map: each feature as it is used, by mouse and keys.
import { expect, test, type Locator, type Page } from '@playwright/test';
import { open, pixels, project, state } from './flog_page';
import { Program } from './program';

let program: Program;
test.beforeAll(async () => {
  program = await Program.start('sim:room');
  await expect.poll(async () => (await program.json<{ tiles: number }>('maps/live').catch(() => ({ tiles: 0 }))).tiles, { timeout: 60_000 }).toBeGreaterThan(6);
  await new Promise((resolve) => { setTimeout(resolve, 12_000); }); // enough of the room to find ways in
  await program.post('session:pause');
});
test.afterEach(async () => { // also after a failure
  if ((await program.json<{ state: string }>('session')).state === 'running') await program.post('session:pause');
});
test.afterAll(async () => { await program.end(); });

const setSlider = (page: Page, label: string, value: number): Promise<void> => page.getByLabel(label, { exact: true }).evaluate((input: HTMLInputElement, to) => {
  input.value = String(to);
  input.dispatchEvent(new Event('input', { bubbles: true }));
}, value);

/** Waits until the view stands still: slow machines glide long. */
async function settled(page: Page): Promise<void> {
  for (let before = { x: NaN, y: NaN }, still = 0; still < 2; await page.waitForTimeout(500)) {
    const now = await project(page, 1, 1);
    still = Math.hypot(now.x - before.x, now.y - before.y) < 0.5 ? still + 1 : 0;
    before = now;
  }
}

/** Share of sampled pixels of the map that differ between two moments. */
async function changed(page: Page, act: () => Promise<unknown>): Promise<number> {
  await settled(page);
  const before = await pixels(page);
  await act();
  await page.waitForTimeout(1500);
  const after = await pixels(page);
  const box = await page.locator('.map > canvas').boundingBox();
  let differ = 0;
  let all = 0;
  for (let y = 10; y < (box?.height ?? 0) - 10; y += 12)
    for (let x = 10; x < (box?.width ?? 0) - 10; x += 12) {
      ++all;
      const [a, b] = [before.at(x, y), after.at(x, y)];
      if (Math.max(...a.map((channel, i) => Math.abs(channel - (b[i] ?? 0)))) > 16) ++differ;
    }
  return differ / all;
}

test('layers stand at their height, spread apart, and are cut', async ({ page }) => {
  await open(page, `${program.url}/?fresh`);
  await page.locator('.map > canvas').focus();
  expect(await changed(page, () => page.keyboard.press('v'))).toBeGreaterThan(0.1);
  expect(await changed(page, () => setSlider(page, 'Spread layers', 1.5))).toBeGreaterThan(0.02);
  await setSlider(page, 'Spread layers', 0);
  expect(await changed(page, () => setSlider(page, 'Cut above', 0.4))).toBeGreaterThan(0.01);
});

test('a layer that is pointed at in the list stands out, and a link brings back how layers were looked at', async ({ page }) => {
  await open(page, `${program.url}/?fresh`);
  await page.locator('.map > canvas').focus();
  await page.keyboard.press('v');
  await setSlider(page, 'Spread layers', 0.8);
  expect(await changed(page, () => page.locator('.layers li').first().hover())).toBeGreaterThan(0.01);
  await page.mouse.move(500, 20);
  const box = await page.locator('.map > canvas').boundingBox();
  const there = async (): Promise<{ x: number; y: number }> => page.evaluate(() => (window as never as { __flog: { project(...at: number[]): { x: number; y: number } } }).__flog.project(0, 0, 1));
  await page.mouse.move((box?.x ?? 0) + 200, (box?.y ?? 0) + 300);
  await page.mouse.down({ button: 'right' });
  await page.mouse.move((box?.x ?? 0) + 240, (box?.y ?? 0) + 220, { steps: 4 }); // turns and tilts
  await page.mouse.up({ button: 'right' });
  await settled(page);
  const before = await there();
  await page.getByRole('button', { name: /link/i }).first().click();
  await expect(page).toHaveURL(/&d=1&a=[\d.]+,0\.8,/);
  const link = page.url();
  await page.goto('about:blank');
  await open(page, link);
  await settled(page);
  const after = await there();
  expect(Math.hypot(after.x - before.x, after.y - before.y)).toBeLessThan(2);
});

test('the path changes its colours, and can be left out', async ({ page }) => {
  await open(page, `${program.url}/?fresh`);
  expect(await changed(page, () => page.locator('input[value="state"]').check({ force: true }))).toBeGreaterThan(0);
  expect(await changed(page, () => page.getByRole('switch', { name: 'Path', exact: true }).click())).toBeGreaterThan(0);
});

async function somewhereFree(page: Page): Promise<{ x: number; y: number }[]> {
  const { points } = await program.json<{ points: { position: [number, number, number] }[] }>('maps/live/trajectory');
  const spots = [points[0], points.at(Math.floor(points.length / 2))].map((point) => point?.position ?? [0, 0, 0]);
  return Promise.all(spots.map(([x, y]) => project(page, x, y)));
}

test('several cells are pinned, and one is copied as JSON', async ({ page, context }) => {
  await context.grantPermissions(['clipboard-read', 'clipboard-write'], { origin: program.url });
  await open(page, `${program.url}/?fresh`);
  await settled(page);
  for (const position of await somewhereFree(page)) {
    await page.locator('.map > canvas').click({ position });
    await page.keyboard.press('p');
  }
  await expect(page.locator('.cell-tile')).toHaveText(/^Tile 0\/-?\d+\/-?\d+, last changed in revision \d+$/);
  await expect(page.locator('.pin-row')).toHaveCount(2);
  await expect(page.locator('.pin-mark')).toHaveCount(2);
  await page.getByRole('button', { name: 'Copy as JSON' }).click();
  const copied = JSON.parse(await page.evaluate(() => navigator.clipboard.readText())) as { layers: { empty: number; rays: number }[]; rev: number };
  expect(copied.layers).toHaveLength(3);
  const link = page.getByRole('link', { name: 'REST' });
  const served = (await (await fetch((await link.getAttribute('href')) ?? '')).json()) as { layers: { E: number }[] };
  expect(copied.layers.map(({ empty }) => empty.toFixed(3))).toEqual(served.layers.map(({ E }) => E.toFixed(3)));
  await page.getByRole('button', { name: 'Remove pin 1' }).click();
  await expect(page.locator('.pin-row')).toHaveCount(1);
});

interface Reach { readonly origin: [number, number]; readonly cell_size: number; readonly width: number; readonly runs: number[] }

/** The reach from some place that the camera had in front of it. */
async function reachAhead(robot: Record<string, number>): Promise<Reach> {
  const { points } = await program.json<{ points: { position: [number, number, number]; orientation_xyzw: [number, number, number, number] }[] }>('maps/live/trajectory');
  for (const part of [0, 0.25, 0.5, 0.75])
    for (const metres of [1, 1.5, 2]) {
      const { position: [px, py], orientation_xyzw: [x, y, z, w] } = points[Math.floor(part * points.length)] ?? { position: [0, 0, 0], orientation_xyzw: [0, 0, 0, 1] };
      const from = [px + metres * 2 * (x * z + w * y), py + metres * 2 * (y * z - w * x)];
      const asked = { method: 'POST', headers: { 'Content-Type': 'application/json' }, body: JSON.stringify({ from, ...robot }) };
      const found = await program.json<Reach>('maps/live/reachable', asked).catch(() => null);
      if (found && found.runs.length > 40) return found;
    }
  throw new Error('nowhere to go');
}

/** Two places far apart between which a slim robot can go, by the server's own account. */
async function endsOfAWay(page: Page, reach: Reach): Promise<[number, number][]> {
  const reached: [number, number][] = [];
  let at = 0;
  reach.runs.forEach((length, i) => {
    for (let k = at; i % 2 === 1 && k < at + length; k += 7) reached.push([reach.origin[0] + (k % reach.width + 0.5) * reach.cell_size, reach.origin[1] + (Math.floor(k / reach.width) + 0.5) * reach.cell_size]);
    at += length;
  });
  // Only what the tool's card, over the upper part of the map, leaves free to be clicked.
  const sampled = reached.filter((_, i) => i % Math.ceil(reached.length / 80) === 0);
  const spots = await Promise.all(sampled.map(([x, y]) => project(page, x, y)));
  const clear = sampled.filter((_, i) => (spots[i]?.y ?? 0) > 280);
  const a = clear[0] ?? [0, 0];
  const away = ([x, y]: [number, number]): number => Math.hypot(x - a[0], y - a[1]);
  return [a, clear.reduce((best, p) => (away(p) > away(best) ? p : best), a)];
}

/** The route tool over a map that stands still, for a slim and low robot; the words of its card. */
async function planRoutes(page: Page): Promise<Locator> {
  await open(page, `${program.url}/?fresh`);
  await settled(page);
  await page.locator('.map > canvas').focus();
  await page.keyboard.press('r');
  await setSlider(page, 'Robot radius', 0.1);
  await setSlider(page, 'Robot height', 0.7);
  return page.locator('.robot-words');
}

test('a route is found by two clicks, and where the robot gets to shrinks as it grows', async ({ page }) => {
  const words = await planRoutes(page);
  await page.getByRole('switch', { name: 'Start at the camera' }).click();
  for (const [x, y] of await endsOfAWay(page, await reachAhead({ robot_radius_m: 0.15, robot_height_m: 0.7 }))) await page.locator('.map > canvas').click({ position: await project(page, x, y) });
  await expect(words).toHaveText(/Route: \d+\.\d\d m, least clearance \d\.\d\d m/);
  await expect(page.locator('.route-line')).toHaveCount(1);
  await page.getByRole('switch', { name: 'Show where it can get to' }).click();
  await expect(words).toHaveText(/Reaches \d+\.\d m²/);
  const area = async (): Promise<number> => Number(/Reaches ([\d.]+)/.exec((await words.textContent()) ?? '')?.[1] ?? NaN);
  const slim = await area();
  expect(slim).toBeGreaterThan(0.3);
  await setSlider(page, 'Robot radius', 0.3);
  await expect.poll(async () => { const now = await area(); return Number.isNaN(now) || now < slim; }).toBe(true);
});

test('a route from the camera takes one click', async ({ page }) => {
  const words = await planRoutes(page);
  await expect(words).toHaveText(/click where to go/);
  const asked = { method: 'POST', headers: { 'Content-Type': 'application/json' }, body: JSON.stringify({ from: 'camera', robot_radius_m: 0.15, robot_height_m: 0.7 }) };
  const [, [x, y] = [0, 0]] = await endsOfAWay(page, await program.json<Reach>('maps/live/reachable', asked));
  await page.locator('.map > canvas').click({ position: await project(page, x, y) });
  await expect(words).toHaveText(/Route: \d+\.\d\d m, least clearance \d\.\d\d m/);
  await expect(page.locator('.route-line')).toHaveCount(1);
});

test('measuring an area', async ({ page }) => {
  await open(page, `${program.url}/?fresh#v=0,0,100,0`);
  await page.getByRole('button', { name: 'Measure' }).click();
  const box = await page.locator('.map > canvas').boundingBox();
  const [x, y] = [(box?.width ?? 0) / 2 - 60, (box?.height ?? 0) / 2];
  for (const [dx, dy] of [[0, 0], [100, 0], [100, 100], [0, 100]] as const) await page.locator('.map > canvas').click({ position: { x: x + dx, y: y + dy } });
  await page.mouse.move(5, 5);
  await expect(page.locator('.tool-card')).toContainText('area 1.00 m²');
});

test('all exports of the menu are files', async ({ page }) => {
  await open(page, `${program.url}/?fresh`);
  await page.getByLabel('Export', { exact: true }).click();
  const links = page.locator('.menu-list a');
  await expect(links).toHaveCount(7);
  for (const href of await links.evaluateAll((all) => all.map((link) => (link as HTMLAnchorElement).href))) {
    const response = await fetch(href);
    expect(response.status, href).toBe(200);
    expect((await response.arrayBuffer()).byteLength, href).toBeGreaterThan(100);
  }
});

test('the picture is held while the map goes on, and catches up', async ({ page }) => {
  await open(page, `${program.url}/?fresh`);
  await settled(page);
  await page.locator('.map > canvas').focus();
  await page.keyboard.press('h');
  await expect(page.locator('.chip')).toHaveText(/Held at/);
  const { rev } = await state(page);
  const held = await changed(page, async () => {
    await program.post('session:resume');
    await expect.poll(async () => (await state(page)).rev).toBeGreaterThan(rev + 3);
    await program.post('session:pause');
  });
  expect(held).toBeLessThan(0.003);
  await page.keyboard.press('h');
  await expect(page.locator('.chip')).toHaveText(/Live|Lagging/);
});

test('right picture, size, corners and depth under the cursor', async ({ page }) => {
  await program.post('session:resume');
  await open(page, `${program.url}/?fresh`);
  await page.getByRole('switch', { name: 'Right picture' }).click();
  const width = (title: string): Promise<number> => page.locator(`canvas[aria-label^="${title}"]`).evaluate((canvas: HTMLCanvasElement) => canvas.width);
  await expect.poll(() => width('Right')).toBeGreaterThan(100);
  await page.getByRole('switch', { name: 'Rows of the pair' }).click();
  for (const title of ['Left', 'Right']) // yellow at the same heights in both
    await expect.poll(() => page.locator(`canvas[aria-label^="${title}"]`).evaluate((canvas: HTMLCanvasElement) => {
      const [r = 0, , b = 0] = canvas.getContext('2d')?.getImageData(10, Math.round(canvas.height / 2), 1, 1).data ?? [];
      return r - b;
    })).toBeGreaterThan(60);
  await page.locator('input[value="240"]').check({ force: true });
  await expect.poll(() => width('Left')).toBe(240);
  await expect(page.locator('.picture-age').first()).toHaveText(/t = /);
  const disparity = page.locator('canvas[aria-label^="Disparity"]');
  await expect.poll(() => width('Disparity')).toBeGreaterThan(100);
  await disparity.evaluate((canvas) => {
    const box = canvas.getBoundingClientRect();
    canvas.dispatchEvent(new PointerEvent('pointermove', { clientX: box.left + 0.6 * box.width, clientY: box.top + 0.6 * box.height }));
  });
  await expect(disparity.locator('..').locator('.picture-readout')).toHaveText(/≈ [\d.]+ px, [\d.]+ m|no match/);
});
