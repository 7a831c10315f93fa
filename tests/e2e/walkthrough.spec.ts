// The walkthrough: meshes that any glTF reader takes, and a picture that is the recorded one where a view was taken.
import path from 'node:path';
import { pathToFileURL } from 'node:url';
import { expect, test, type Page } from '@playwright/test';
import validator from 'gltf-validator';
import { open, pixels } from './flog_page';
import { Program } from './program';

interface Views { readonly views: { readonly number: number; readonly time_ns: string }[] }
interface Walk { readonly views: number; readonly shown: number; readonly missing: number; readonly bytes: number; readonly rideS: number; readonly riding: boolean; readonly position: number[] }
const walk = (page: Page): Promise<Walk> => page.evaluate(() => (window as never as { __flog: { walk: Walk } }).__flog.walk);

let program: Program;
test.beforeAll(async () => {
  program = await Program.start('sim:room');
  await expect.poll(async () => (await program.json<Views>('maps/live/views').catch(() => ({ views: [] }))).views.length, { timeout: 60_000 }).toBeGreaterThan(12);
  await program.post('session:pause');
});
test.afterAll(async () => { await program.end(); });

const fetchMesh = async (number: number): Promise<Buffer> => Buffer.from(await (await fetch(`${program.url}/api/v1/maps/live/views/${number}.glb`)).arrayBuffer());

test('every view is valid glTF 2.0 for the Khronos validator and loads in three.js', async () => {
  const { validateBytes } = validator as { validateBytes(bytes: Uint8Array): Promise<{ issues: { messages: { severity: number }[] } }> };
  const loaderFile = path.resolve(__dirname, '../../web/node_modules/three/examples/jsm/loaders/GLTFLoader.js');
  const { GLTFLoader } = (await import(pathToFileURL(loaderFile).href)) as typeof import('three/examples/jsm/loaders/GLTFLoader.js');
  const { views } = await program.json<Views>('maps/live/views');
  for (const { number } of [...views.slice(0, 2), ...views.slice(-2)]) {
    const file = await fetchMesh(number);
    const { issues } = await validateBytes(new Uint8Array(file));
    expect(issues.messages.filter(({ severity }) => severity <= 1), `view ${number}`).toEqual([]); // errors and warnings
    const bytes = file.buffer.slice(file.byteOffset, file.byteOffset + file.byteLength) as ArrayBuffer;
    Object.assign(globalThis, { self: globalThis });
    const quiet = console.error;
    console.error = (): void => {}; // Node cannot decode the picture; the geometry is what is read here
    const { scene } = await new GLTFLoader().parseAsync(bytes, '');
    console.error = quiet;
    let vertices = 0;
    scene.traverse((object) => { vertices += (object as { geometry?: { attributes: { position: { count: number } } } }).geometry?.attributes.position.count ?? 0; });
    expect(vertices).toBeGreaterThan(1000);
  }
});

test('a mesh has a tag, and is not sent again while it is the same', async () => {
  const { views } = await program.json<Views>('maps/live/views');
  const url = `${program.url}/api/v1/maps/live/views/${views[0]?.number}.glb`;
  const first = await fetch(url);
  expect(first.headers.get('content-type')).toBe('model/gltf-binary');
  const again = await fetch(url, { headers: { 'If-None-Match': first.headers.get('etag') ?? '' } });
  expect(again.status).toBe(304);
  expect((await fetch(`${program.url}/api/v1/maps/live/views/999999.glb`)).status).toBe(404);
});

interface Vertex { readonly world: number[]; readonly texture: number[] }

/** Some vertices of a view in the world, read by the specification alone. */
function vertices(file: Buffer, count: number): { list: Vertex[]; jpeg: Buffer } {
  const json = JSON.parse(file.toString('utf8', 20, 20 + file.readUInt32LE(12))) as {
    accessors: { bufferView: number; count: number }[]; bufferViews: { byteOffset: number; byteLength: number }[];
    images: { bufferView: number }[]; nodes: { translation?: number[]; rotation: number[] }[];
  };
  const start = 20 + file.readUInt32LE(12) + 8;
  const at = (view: number): number => start + (json.bufferViews[view]?.byteOffset ?? 0);
  const [t, [qx, qy, qz, qw]] = [json.nodes[1]?.translation ?? [0, 0, 0], (json.nodes[1]?.rotation ?? [0, 0, 0, 1]) as [number, number, number, number]];
  const total = json.accessors[0]?.count ?? 0;
  const list = Array.from({ length: count }, (_, k) => {
    const i = Math.floor((k * total) / count);
    const [x, y, z] = [0, 1, 2].map((c) => file.readFloatLE(at(0) + 12 * i + 4 * c)) as [number, number, number];
    const [a, b, c] = [2 * (qy * z - qz * y), 2 * (qz * x - qx * z), 2 * (qx * y - qy * x)];
    const world = [x + qw * a + qy * c - qz * b + (t[0] ?? 0), y + qw * b + qz * a - qx * c + (t[1] ?? 0), z + qw * c + qx * b - qy * a + (t[2] ?? 0)];
    return { world, texture: [file.readUInt16LE(at(1) + 4 * i) / 65535, file.readUInt16LE(at(1) + 4 * i + 2) / 65535] };
  });
  const picture = json.bufferViews[json.images[0]?.bufferView ?? 0];
  return { list, jpeg: file.subarray(start + (picture?.byteOffset ?? 0), start + (picture?.byteOffset ?? 0) + (picture?.byteLength ?? 0)) };
}

const correlation = (a: readonly number[], b: readonly number[]): number => {
  const mean = (list: readonly number[]): number => list.reduce((sum, value) => sum + value, 0) / list.length;
  const [ma, mb] = [mean(a), mean(b)];
  const sum = (f: (i: number) => number): number => a.reduce((total, _, i) => total + f(i), 0);
  return sum((i) => ((a[i] ?? 0) - ma) * ((b[i] ?? 0) - mb)) / Math.sqrt(sum((i) => ((a[i] ?? 0) - ma) ** 2) * sum((i) => ((b[i] ?? 0) - mb) ** 2));
};

const rideTo = (page: Page, part: number): Promise<void> => page.evaluate((to) => {
  const slider = document.querySelector<HTMLInputElement>('.walk-bar input[type=range]');
  if (!slider) throw new Error('no ride');
  slider.value = String(Number(slider.max) * to);
  slider.dispatchEvent(new Event('input'));
}, part);

test('seen from where a view was taken the walkthrough shows what the camera saw', async ({ page }) => {
  await open(page, `${program.url}/?fresh`);
  await page.locator('.map > canvas').focus();
  await page.keyboard.press('w');
  await expect(page.locator('.walk-bar')).toBeVisible();
  await expect.poll(async () => (await walk(page)).views).toBeGreaterThan(12);
  await rideTo(page, 0);
  await expect.poll(async () => { const { shown, missing } = await walk(page); return shown >= 8 && missing === 0; }).toBe(true);
  await page.waitForTimeout(1500);
  const first = (await program.json<Views>('maps/live/views')).views[0]?.number ?? 0;
  const { list, jpeg } = vertices(await fetchMesh(first), 1500);
  const grey = await page.evaluate(async ([base64, spots]) => {
    const bitmap = await createImageBitmap(await (await fetch(`data:image/jpeg;base64,${base64 as string}`).catch(() => new Response(Uint8Array.from(atob(base64 as string), (c) => c.charCodeAt(0))))).blob());
    const context = new OffscreenCanvas(bitmap.width, bitmap.height).getContext('2d');
    context?.drawImage(bitmap, 0, 0);
    return (spots as number[][]).map(([u, v]) => context?.getImageData(Math.min(bitmap.width - 1, (u ?? 0) * bitmap.width), Math.min(bitmap.height - 1, (v ?? 0) * bitmap.height), 1, 1).data[0] ?? 0);
  }, [jpeg.toString('base64'), list.map(({ texture }) => texture)] as const);
  const places = await page.evaluate((points) => points.map(([x, y, z]) => (window as never as { __flog: { projectWalk(...p: number[]): { x: number; y: number } | null } }).__flog.projectWalk(x as number, y as number, z as number)), list.map(({ world }) => world));
  const picture = await pixels(page);
  const size = await page.locator('.map > canvas').boundingBox();
  const pairs = places.flatMap((place, i) => (place && size && place.x > 2 && place.y > 2 && place.x < size.width - 2 && place.y < size.height - 2 ? [[grey[i] ?? 0, picture.at(place.x, place.y)[1]] as const] : []));
  expect(pairs.length).toBeGreaterThan(400);
  expect(correlation(pairs.map(([a]) => a), pairs.map(([, b]) => b))).toBeGreaterThan(0.8);
});

test('one walks by keys, rides the path, stays within the budget, and comes back to the map', async ({ page }) => {
  await open(page, `${program.url}/?fresh&budget=24`); // 12 MiB for meshes
  await page.getByRole('button', { name: 'Walk through the mapped views' }).click();
  await expect.poll(async () => (await walk(page)).shown).toBeGreaterThan(0);
  const from = (await walk(page)).position;
  await page.keyboard.down('w');
  await expect.poll(async () => { const { position } = await walk(page); return Math.hypot(...position.map((p, i) => p - (from[i] ?? 0))); }).toBeGreaterThan(0.3);
  await page.keyboard.up('w');
  for (const part of [0.2, 0.5, 0.9]) {
    await rideTo(page, part);
    await expect.poll(async () => (await walk(page)).missing).toBe(0);
  }
  expect((await walk(page)).bytes).toBeLessThanOrEqual(18 * 2 ** 20); // what is on screen stays, whatever the budget
  await rideTo(page, 0.3);
  const before = (await walk(page)).rideS;
  await page.getByRole('button', { name: 'Ride the recorded path' }).click();
  await expect.poll(async () => (await walk(page)).rideS).toBeGreaterThan(before + 0.3);
  await page.keyboard.press('Escape');
  await expect(page.locator('.walk-bar')).toBeHidden();
  await expect(page.locator('.legend')).toBeVisible();
});
