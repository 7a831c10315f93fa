// A large map in which a camera walks, looked at for minutes: frame times, memory of the page, tiles on the graphics card.
// Run by hand: scripts/soak [MINUTES [HOUSES]]. Prints a line every half minute and a verdict; exit code 1 if memory grows.
import { spawn } from 'node:child_process';
import { createRequire } from 'node:module';
import path from 'node:path';
import { fileURLToPath } from 'node:url';

const root = path.resolve(path.dirname(fileURLToPath(import.meta.url)), '../..');
const { chromium } = createRequire(path.join(root, 'web/package.json'))('@playwright/test');
const [minutes = 10, houses = 16] = process.argv.slice(2).map(Number);
const DEMO = process.env.FLOGMAP_DEMO ?? path.join(root, 'build/release/tests/server/hub_demo');
const ARGS = ['--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking', '--disable-component-update', '--disable-sync', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--js-flags=--expose-gc'];
const SETTLES_S = 90; // the walk's first round takes 60: until then the map grows in all houses at once
const MAY_GROW = 1.15; // of heap and arrays, from the first to the last third

const sleep = (ms) => new Promise((resolve) => { setTimeout(resolve, ms); });
const MiB = (bytes) => (bytes / 2 ** 20).toFixed(1);

function startDemo(seconds) {
  const child = spawn(DEMO, ['0', String(seconds), path.join(root, 'web/dist'), String(houses)], { stdio: ['ignore', 'pipe', 'inherit'] });
  return new Promise((resolve, reject) => {
    child.stdout.on('data', (data) => resolve({ child, url: String(data).trim() }));
    child.on('error', reject);
    child.on('exit', (code) => reject(new Error(`${DEMO} ended with ${code}`)));
  });
}

/** Pans and zooms for a while; times between pictures of the map, ms, sorted. */
async function frames(page, seconds) {
  const from = await page.evaluate(() => performance.now());
  const { width, height } = await page.locator('.map > canvas').boundingBox();
  const middle = [width / 2, height / 2];
  const times = new Set();
  for (const end = Date.now() + 1000 * seconds; Date.now() < end;) {
    for (const [dx, dy] of [[120, 40], [-120, -40]]) {
      await page.mouse.move(...middle);
      await page.mouse.down();
      await page.mouse.move(middle[0] + dx, middle[1] + dy, { steps: 24 });
      await page.mouse.up();
    }
    await page.mouse.wheel(0, 240);
    await page.mouse.wheel(0, -240);
    for (const time of await page.evaluate(() => window.__flog.pictures)) times.add(time); // it keeps the last ones only
  }
  const drawn = [...times].filter((time) => time >= from).sort((a, b) => a - b);
  return drawn.slice(1).map((time, i) => time - drawn[i]).sort((a, b) => a - b);
}

/** After a collection of garbage. `arrays`: tiles, packed path and the like, which do not count as heap. */
async function memory(cdp, page) {
  await cdp.send('HeapProfiler.collectGarbage');
  const { usedSize, backingStorageSize } = await cdp.send('Runtime.getHeapUsage');
  const { tiles, tileBytes, textureBytes, rev, poses } = await page.evaluate(() => ({ tiles: window.__flog.tiles(), tileBytes: window.__flog.tileBytes, textureBytes: window.__flog.textureBytes, rev: window.__flog.rev, poses: window.__flog.trajectoryLength }));
  return { heap: usedSize, arrays: backingStorageSize ?? 0, tiles, tileBytes, textureBytes, rev, poses };
}

const at = (list, share) => list[Math.min(list.length - 1, Math.floor(share * list.length))] ?? 0;
const mean = (list) => list.reduce((sum, x) => sum + x, 0) / list.length;

const { child, url } = await startDemo(60 * minutes + SETTLES_S + 120);
const browser = await chromium.launch({ executablePath: process.env.FLOGMAP_CHROMIUM ?? '/usr/bin/chromium', args: ARGS });
try {
  const page = await browser.newPage({ viewport: { width: 1280, height: 800 } });
  page.setDefaultTimeout(180_000); // drawn without a graphics card, perhaps beside a compiler
  await page.goto(`${url}/?fresh`);
  await page.locator('.chip', { hasText: /Live|Lagging/ }).waitFor();
  await page.keyboard.press('0');
  const cdp = await page.context().newCDPSession(page);
  const look = async () => {
    const times = await frames(page, 10);
    const row = { ...(await memory(cdp, page)), median: at(times, 0.5), p95: at(times, 0.95) };
    console.log(`${row.tiles} tiles, revision ${row.rev}, ${row.poses} poses: picture every ${row.median.toFixed(0)} ms, 95 % below ${row.p95.toFixed(0)} (${times.length}); heap ${MiB(row.heap)} MiB, arrays ${MiB(row.arrays)}, of them tiles ${MiB(row.tileBytes)}; textures ${MiB(row.textureBytes)}`);
    return row;
  };
  await sleep(20_000);
  console.log('while all houses grow:');
  await look();
  await sleep(1000 * (SETTLES_S - 30));
  console.log('then:');
  const rows = [];
  for (const end = Date.now() + 60_000 * minutes; Date.now() < end;) {
    rows.push(await look());
    await sleep(Math.min(20_000, Math.max(0, end - Date.now())));
  }
  const third = Math.max(1, Math.floor(rows.length / 3));
  const held = ({ heap, arrays }) => heap + arrays;
  const growth = mean(rows.slice(-third).map(held)) / mean(rows.slice(0, third).map(held));
  const flat = growth <= MAY_GROW && rows.at(-1).textureBytes <= rows[0].textureBytes * MAY_GROW;
  console.log(`${flat ? 'flat' : 'GROWS'}: memory x ${growth.toFixed(3)} from the first to the last third; pictures every ${mean(rows.map(({ median }) => median)).toFixed(0)} ms, 95 % below ${mean(rows.map(({ p95 }) => p95)).toFixed(0)} ms`);
  process.exitCode = flat ? 0 : 1;
} finally {
  await browser.close();
  child.removeAllListeners('exit');
  child.kill('SIGTERM');
}
