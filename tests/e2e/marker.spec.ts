// The camera on the map: the view that follows it, and the live picture that stands where it looks.
import { expect, test, type Page } from '@playwright/test';
import { open, pixels, project } from './flog_page';
import { Program } from './program';

type Vector = readonly [number, number, number];
interface PathPoint { readonly position: Vector; readonly orientation_xyzw: readonly [number, number, number, number] }

let program: Program;
test.beforeAll(async () => { program = await Program.start('sim:room'); });
test.afterAll(async () => { await program.end(); });

/** Where the camera is, once it rests. */
async function pauseAfter(seconds: number): Promise<PathPoint> {
  if ((await program.json<{ state: string }>('session')).state !== 'running') await program.post('session:resume');
  await new Promise((resolve) => { setTimeout(resolve, 1000 * seconds); });
  await program.post('session:pause');
  let points: PathPoint[] = [];
  for (let before = -1; before !== points.length;) { // what is under way arrives
    before = points.length;
    await new Promise((resolve) => { setTimeout(resolve, 1500); });
    ({ points } = await program.json<{ points: PathPoint[] }>('maps/live/trajectory'));
  }
  return points.at(-1) ?? { position: [0, 0, 0], orientation_xyzw: [0, 0, 0, 1] };
}

/** A point of the camera's coordinates (x right, y down, z ahead) in the world's. */
function worldFromCamera({ position, orientation_xyzw: [x, y, z, w] }: PathPoint, [a, b, c]: Vector): Vector {
  return [
    position[0] + (1 - 2 * (y * y + z * z)) * a + 2 * (x * y - z * w) * b + 2 * (x * z + y * w) * c,
    position[1] + 2 * (x * y + z * w) * a + (1 - 2 * (x * x + z * z)) * b + 2 * (y * z - x * w) * c,
    position[2] + 2 * (x * z - y * w) * a + 2 * (y * z + x * w) * b + (1 - 2 * (x * x + y * y)) * c,
  ];
}

const middleOf = async (page: Page): Promise<{ x: number; y: number }> => {
  const box = await page.locator('.map > canvas').boundingBox();
  return { x: (box?.width ?? 0) / 2, y: (box?.height ?? 0) / 2 };
};

/** From the camera's place to one metre ahead of it, in CSS pixels of the flat map; and its place from the middle. */
async function cameraOnScreen(page: Page, camera: PathPoint): Promise<{ off: number; ahead: { x: number; y: number } }> {
  const middle = await middleOf(page);
  const [x, y] = camera.position;
  const [ax, ay] = worldFromCamera(camera, [0, 0, 1]);
  const [here, there] = [await project(page, x, y), await project(page, ax, ay)];
  return { off: Math.hypot(here.x - middle.x, here.y - middle.y), ahead: { x: there.x - here.x, y: there.y - here.y } };
}

test('the view follows the camera, north up and then with its heading up, until it is moved by hand', async ({ page }) => {
  const first = await pauseAfter(6);
  await open(page, `${program.url}/?fresh`, 1);
  await page.locator('.map > canvas').focus();
  await page.keyboard.press('f');
  await expect.poll(async () => (await cameraOnScreen(page, first)).off, { timeout: 20_000 }).toBeLessThan(1);
  const east = await project(page, first.position[0] + 1, first.position[1]);
  const here = await project(page, first.position[0], first.position[1]);
  expect(Math.abs(east.y - here.y)).toBeLessThan(0.5); // x to the right: y, the map's north, is up
  expect(east.x).toBeGreaterThan(here.x);

  await page.keyboard.press('f');
  for (let step = 0; step < 3; ++step) {
    const camera = step === 0 ? first : await pauseAfter(4); // also while it walks and turns
    await expect.poll(async () => (await cameraOnScreen(page, camera)).off, { timeout: 20_000 }).toBeLessThan(1);
    await page.waitForTimeout(1000); // the last of the turn
    const { ahead } = await cameraOnScreen(page, camera);
    expect(ahead.y).toBeLessThan(-10);
    expect(Math.abs(ahead.x)).toBeLessThan(0.03 * -ahead.y);
  }

  const last = await project(page, 0, 0);
  await page.locator('.map > canvas').hover();
  const box = await page.locator('.map > canvas').boundingBox();
  const grip = { x: (box?.x ?? 0) + (box?.width ?? 0) / 2, y: (box?.y ?? 0) + (box?.height ?? 0) / 2 };
  await page.mouse.down();
  await page.mouse.move(grip.x + 150, grip.y + 60, { steps: 6 });
  await page.mouse.up();
  await pauseAfter(2);
  const moved = await project(page, 0, 0);
  expect(moved.x - last.x).toBeCloseTo(150, 0);
  expect(moved.y - last.y).toBeCloseTo(60, 0);
});

/** Brightness of the left picture as its panel shows it, at a share of its width and height, over a square of 1/40 of its width. */
const pictureAt = (page: Page, spots: readonly (readonly [number, number])[]): Promise<number[]> =>
  page.getByRole('img', { name: 'Left picture of the camera' }).evaluate((canvas: HTMLCanvasElement, at) => {
    const context = canvas.getContext('2d');
    const side = Math.max(1, Math.round(canvas.width / 40));
    return at.map(([u, v]) => {
      const corner = [(u as number) * canvas.width - side / 2, (v as number) * canvas.height - side / 2].map(Math.round) as [number, number];
      const rgba = context?.getImageData(...corner, side, side).data ?? new Uint8ClampedArray();
      return rgba.reduce((sum, value, i) => sum + value * ([0.3, 0.59, 0.11, 0][i % 4] ?? 0), 0) / (side * side);
    });
  }, spots);

function correlation(a: readonly number[], b: readonly number[]): number {
  const mean = (list: readonly number[]): number => list.reduce((sum, x) => sum + x, 0) / list.length;
  const [ma, mb] = [mean(a), mean(b)];
  const dot = (p: readonly number[], mp: number, q: readonly number[], mq: number): number => p.reduce((sum, x, i) => sum + (x - mp) * ((q[i] ?? 0) - mq), 0);
  return dot(a, ma, b, mb) / Math.sqrt(dot(a, ma, a, ma) * dot(b, mb, b, mb));
}

test('the live picture stands upright in the frustum, where the camera looks', async ({ page }) => {
  const camera = await pauseAfter(3);
  await page.setViewportSize({ width: 1280, height: 1000 });
  await open(page, `${program.url}/?fresh#v=${camera.position[0]},${camera.position[1]},60,0&l=0:-,1:-,2:-,3:-`, 1); // no layer stands before it
  await page.locator('.map > canvas').focus();
  await page.keyboard.press('v');
  await page.keyboard.press('f');
  await page.keyboard.press('f'); // from behind the camera
  for (const other of ['Tracked corners', 'Grid', 'Path']) // the picture alone
    await page.getByRole('switch', { name: other, exact: true }).click();
  const last = await pauseAfter(4); // a paused camera sends no pictures: now there is one
  const model = await page.evaluate(() => (window as never as { __flog: { camera: Record<'focalPx' | 'cxPx' | 'cyPx' | 'widthPx' | 'heightPx', number> } }).__flog.camera);
  await page.waitForTimeout(4000); // it glides there
  const scale = 60;
  const reach = 80 / scale; // 80 pixels at the camera, seen from above
  const grid: [number, number][] = [];
  for (let v = 0.08; v < 0.95; v += 0.04) for (let u = 0.08; u < 0.95; u += 0.04) grid.push([u, v]);
  const shown = await page.evaluate((points) => {
    const { project: at } = (window as never as { __flog: { project(...p: number[]): { x: number; y: number } } }).__flog;
    return points.map((point) => at(...point));
  }, grid.map(([u, v]) => worldFromCamera(last, [((u * model.widthPx - model.cxPx) / model.focalPx) * reach, ((v * model.heightPx - model.cyPx) / model.focalPx) * reach, reach])));
  const seen = await pixels(page);
  // Three pixels each way: the picture is made smaller there, and its finest texture is drawn as it falls.
  const around = shown.map(({ x, y }) => [-1, 0, 1].flatMap((dx) => [-1, 0, 1].map((dy) => seen.at(x + dx, y + dy))));
  const grey = around.map((colours) => colours.every(([r, g, b]) => Math.max(r, g, b) - Math.min(r, g, b) < 40)); // not the orange frustum
  expect(grey.filter(Boolean).length).toBeGreaterThan(0.6 * grid.length);
  const spots = grid.filter((_, i) => grey[i]);
  const bright = around.filter((_, i) => grey[i]).map((colours) => colours.reduce((sum, [r, g, b]) => sum + (0.3 * r + 0.59 * g + 0.11 * b) / 9, 0));
  const upright = correlation(bright, await pictureAt(page, spots));
  await page.screenshot({ path: test.info().outputPath('frustum.png') });
  expect(upright).toBeGreaterThan(0.9);
  for (const [du, dv] of [[-1, 1], [1, -1], [-1, -1]] as const) // neither mirrored nor upside down
    expect(correlation(bright, await pictureAt(page, spots.map(([u, v]) => [du < 0 ? 1 - u : u, dv < 0 ? 1 - v : v])))).toBeLessThan(upright - 0.2);
});
