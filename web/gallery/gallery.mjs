// Pictures of the page with a real map in it, and a short animation of how it grows. Called by scripts/gallery.
import { spawn } from 'node:child_process';
import { writeFileSync } from 'node:fs';
import path from 'node:path';
import { fileURLToPath } from 'node:url';
import { chromium } from '@playwright/test';
import { animatedPng } from './animated_png.mjs';

const [source = 'sim:room', folder = 'docs/gallery'] = process.argv.slice(2);
const web = path.resolve(path.dirname(fileURLToPath(import.meta.url)), '..');
const ARGS = ['--no-sandbox', '--disable-quic', '--no-first-run', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'];
const FRAMES = Number(process.env.GALLERY_FRAMES ?? 24);
const only = process.env.GALLERY_ONLY?.split(','); // names of pictures; the animation is left out then
const MAPPED_S = Number(process.env.GALLERY_SECONDS ?? 45); // how long the camera walks before the pictures

function startProgram() {
  const child = spawn(process.env.FLOGMAP_BIN ?? 'build/release/flogmap', ['serve', '--source', source, '--listen', '127.0.0.1:0', '--web-root', path.join(web, 'dist')], { stdio: ['ignore', 'pipe', 'inherit'] });
  return new Promise((resolve, reject) => {
    child.stdout.on('data', (data) => {
      const url = /http:\/\/127\.0\.0\.1:\d+/.exec(String(data))?.[0];
      if (url) resolve({ child, url });
    });
    child.on('exit', (code) => reject(new Error(`flogmap ended with ${code}`)));
  });
}

async function openPage(browser, url, size, scheme, hash = '') {
  const page = await browser.newPage({ viewport: size, colorScheme: scheme, deviceScaleFactor: size.width < 500 ? 2 : 1 });
  page.setDefaultTimeout(180_000); // drawn without a graphics card, perhaps beside a compiler
  await page.goto(`${url}/?fresh${hash}`);
  await page.locator('.chip', { hasText: /Live|Lagging/ }).waitFor();
  return page;
}

/** The picture of the README: the map as it grows, and the camera's pictures as fresh as they are. */
async function readme(browser, url) {
  const page = await openPage(browser, url, DESKTOP, 'dark');
  await page.waitForTimeout(6000);
  await page.waitForFunction(() => document.querySelector('.chip')?.textContent === 'Live' && ![...document.querySelectorAll('.picture-age')].some((age) => age.classList.contains('old')));
  await page.screenshot({ path: path.join(folder, '../pictures/page.png'), timeout: 180_000 });
  await page.close();
}

/** Frames of the growing map, `FRAMES` over the time of mapping. */
async function film(browser, url) {
  const page = await openPage(browser, url, { width: 880, height: 560 }, 'dark');
  await page.keyboard.press('[');
  await page.waitForFunction(() => window.__flog.tiles() > 0);
  const frames = [];
  for (let i = 0; i < FRAMES; ++i) {
    frames.push(await page.screenshot({ timeout: 180_000 }));
    await page.waitForTimeout((1000 * MAPPED_S) / FRAMES);
  }
  await page.close();
  writeFileSync(path.join(folder, 'growing.png'), animatedPng(frames, 180));
}

/** First person, at a part of the recorded path. */
async function walk(page, part) {
  await page.getByRole('button', { name: 'Walk through the mapped views' }).click();
  await page.locator('.walk-bar').waitFor();
  await page.evaluate((to) => {
    const slider = document.querySelector('.walk-bar input[type=range]');
    slider.value = String(Number(slider.max) * to);
    slider.dispatchEvent(new Event('input'));
  }, part);
  await page.waitForFunction(() => window.__flog.walk.shown > 4 && window.__flog.walk.missing === 0);
}

/** Far apart: two places of the reach of a robot that starts where the camera had looked. */
async function endsOfAWay() {
  const { points } = await (await fetch(`${url}/api/v1/maps/live/trajectory`)).json();
  for (const part of [0.1, 0.4, 0.7]) {
    const { position: [px, py], orientation_xyzw: [x, y, z, w] } = points[Math.floor(part * points.length)];
    const from = [px + 3 * (x * z + w * y), py + 3 * (y * z - w * x)];
    const answer = await fetch(`${url}/api/v1/maps/live/reachable`, { method: 'POST', headers: { 'Content-Type': 'application/json' }, body: JSON.stringify({ from, robot_radius_m: 0.3, robot_height_m: 0.7 }) });
    if (!answer.ok) continue;
    const { origin, cell_size, width, runs } = await answer.json();
    const reached = [];
    runs.reduce((at, length, i) => {
      for (let k = at; i % 2 === 1 && k < at + length; k += 9) reached.push([origin[0] + (k % width) * cell_size, origin[1] + Math.floor(k / width) * cell_size]);
      return at + length;
    }, 0);
    const away = ([ax, ay]) => Math.hypot(ax - reached[0][0], ay - reached[0][1]);
    if (reached.length > 100) return [reached[0], reached.reduce((a, b) => (away(b) > away(a) ? b : a))];
  }
  return [];
}

/** A way by two clicks, and where the robot gets to at all. */
async function route(page) {
  await page.waitForTimeout(4000);
  await page.locator('.map > canvas').focus();
  await page.keyboard.press('r');
  await page.getByRole('slider', { name: 'Robot height' }).fill('0.7');
  for (const [x, y] of await endsOfAWay()) {
    const position = await page.evaluate(([wx, wy]) => window.__flog.project(wx, wy), [x, y]);
    await page.locator('.map > canvas').click({ position });
  }
  await page.getByRole('switch', { name: 'Show where it can get to' }).click();
}

const DESKTOP = { width: 1280, height: 800 };
const SHOTS = [
  ['live-dark', DESKTOP, 'dark', ''],
  ['live-light', DESKTOP, 'light', ''],
  ['paper-grey', DESKTOP, 'light', '#p=grey'],
  ['motion', DESKTOP, 'dark', '#s=motion&p=viridis'],
  ['solid', DESKTOP, 'dark', '', async (page) => { await page.getByRole('switch', { name: 'Colour by height' }).click(); await page.locator('.map > canvas').focus(); await page.keyboard.press('v'); }],
  ['spread', DESKTOP, 'light', '', async (page) => {
    await page.getByRole('switch', { name: 'Colour by height' }).click();
    await page.locator('.map > canvas').focus();
    await page.keyboard.press('v');
    for (let i = 0; i < 2; ++i) await page.keyboard.press('-');
    await page.getByRole('slider', { name: 'Spread layers' }).fill('1');
  }],
  ['cell', DESKTOP, 'dark', '', async (page) => { await page.locator('.map > canvas').click({ position: { x: 330, y: 250 } }); await page.locator('summary', { hasText: 'Camera' }).click(); }],
  ['status', DESKTOP, 'dark', '', async (page) => { for (const title of ['Camera', 'Cell']) await page.locator('summary', { hasText: title }).click(); await page.waitForTimeout(8000); }],
  ['route', DESKTOP, 'dark', '#s=motion&p=grey', route],
  ['walkthrough', DESKTOP, 'dark', '', (page) => walk(page, 0.55)],
  ['phone-walkthrough', { width: 390, height: 844 }, 'dark', '', (page) => walk(page, 0.8)],
  ['phone', { width: 390, height: 844 }, 'dark', ''],
];

const { child, url } = await startProgram();
const browser = await chromium.launch({ executablePath: process.env.FLOGMAP_CHROMIUM ?? '/usr/bin/chromium', args: ARGS });
try {
  if (only) await new Promise((resolve) => { setTimeout(resolve, 1000 * MAPPED_S); });
  else await film(browser, url);
  if (!only || only.includes('page')) await readme(browser, url);
  await fetch(`${url}/api/v1/session:pause`, { method: 'POST' });
  for (const [name, size, scheme, hash, act] of SHOTS.filter(([name]) => !only || only.includes(name))) {
    const page = await openPage(browser, url, size, scheme, hash);
    await act?.(page);
    await page.waitForTimeout(2500);
    await page.screenshot({ path: path.join(folder, `${name}.png`), timeout: 180_000 });
    await page.close();
    console.log(`${folder}/${name}.png`);
  }
} finally {
  await browser.close();
  child.kill('SIGTERM');
}
process.exit(0);
