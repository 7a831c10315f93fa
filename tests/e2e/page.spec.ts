// The page by itself, with the room it simulates: layout, keys, links, accessibility. Needs only a server of files.
import AxeBuilder from '@axe-core/playwright';
import { expect, test, type Page } from '@playwright/test';
import { state } from './flog_page';
import { serveFiles, type FileServer } from './file_server';

let files: FileServer;
test.beforeAll(async () => { files = await serveFiles(); });
test.afterAll(async () => { await files.close(); });

async function openMock(page: Page, hash = ''): Promise<void> {
  await page.goto(`${files.url}/?mock=1&fresh${hash}`);
  await expect.poll(async () => (await state(page)).tiles, { timeout: 60_000 }).toBeGreaterThan(4);
}
const pauseMock = (page: Page): Promise<void> => page.evaluate(() => (window as never as { __mock: { order(what: string): void } }).__mock.order('pause'));

test('nothing breaks the strictest content policy, and nothing is fetched from elsewhere', async ({ page }) => {
  const problems: string[] = [];
  page.on('console', (message) => { if (message.type() === 'error' || message.type() === 'warning') problems.push(message.text()); });
  page.on('pageerror', (error) => problems.push(error.message));
  page.on('request', (request) => { if (!request.url().startsWith(files.url) && !request.url().startsWith('blob:')) problems.push(request.url()); });
  await openMock(page);
  expect(problems).toEqual([]);
});

for (const [width, height] of [[390, 844], [360, 640], [1280, 800], [1920, 1080]] as const)
  test(`fits ${width} x ${height} without scrolling sideways`, async ({ page }) => {
    await page.setViewportSize({ width, height });
    await openMock(page);
    await pauseMock(page);
    expect(await page.evaluate(() => document.documentElement.scrollWidth)).toBeLessThanOrEqual(width);
    const outside = await page.evaluate(() => [...document.querySelectorAll('button, .chip, .legend')]
      .filter((element) => { const box = element.getBoundingClientRect(); return box.width > 0 && (box.right > innerWidth + 1 || box.left < -1); }).map((element) => element.outerHTML.slice(0, 80)));
    expect(outside).toEqual([]);
  });

test('on a phone every panel is one tap away and controls are large enough for a thumb', async ({ page }) => {
  await page.setViewportSize({ width: 390, height: 844 });
  await openMock(page);
  await pauseMock(page);
  for (const [tab, text] of [['Map', 'Layers'], ['Camera', 'Tracked corners'], ['Cell', 'Point at the map'], ['Status', 'Mapped views']] as const) {
    await page.locator('.tabs').getByRole('button', { name: tab }).click();
    await expect(page.getByText(text).first()).toBeVisible();
    await page.locator('.tabs').getByRole('button', { name: tab }).click();
    await expect(page.locator('.side:visible')).toHaveCount(0);
  }
  const small = await page.evaluate(() => [...document.querySelectorAll('button')].filter((b) => { const box = b.getBoundingClientRect(); return box.width > 0 && Math.min(box.width, box.height) < 44; }).map((b) => b.outerHTML.slice(0, 80)));
  expect(small).toEqual([]);
});

for (const scheme of ['dark', 'light'] as const)
  test(`axe finds nothing serious, ${scheme}`, async ({ page }) => {
    await page.emulateMedia({ colorScheme: scheme });
    await openMock(page);
    await pauseMock(page);
    const { violations } = await new AxeBuilder({ page }).analyze();
    expect(violations.filter(({ impact }) => impact === 'serious' || impact === 'critical').map(({ id, nodes }) => [id, nodes.map((node) => node.html.slice(0, 120))])).toEqual([]);
  });

/** What axe holds against the page as it is now. */
async function faults(page: Page, where: string): Promise<unknown[]> {
  const { violations } = await new AxeBuilder({ page }).analyze();
  return violations.filter(({ impact }) => impact === 'serious' || impact === 'critical').map(({ id, nodes }) => [where, id, nodes.map((node) => node.html.slice(0, 120))]);
}

for (const scheme of ['dark', 'light'] as const)
  test(`axe finds nothing serious in tools, menus, dialogs and sheets, ${scheme}`, async ({ page }) => {
    await page.emulateMedia({ colorScheme: scheme, reducedMotion: 'reduce' });
    await openMock(page);
    await pauseMock(page);
    await page.locator('.map > canvas').focus();
    const found: unknown[] = [];
    for (const [key, name] of [['m', 'measure'], ['r', 'route'], ['t', 'level'], ['v', 'solid'], ['h', 'held']] as const) {
      await page.keyboard.press(key);
      found.push(...await faults(page, name));
    }
    await page.keyboard.press('Escape');
    await page.locator('summary[aria-label="Export"]').click();
    found.push(...await faults(page, 'export'));
    await page.keyboard.press('Escape');
    await page.getByRole('button', { name: 'Keys and help' }).click();
    found.push(...await faults(page, 'help'));
    await page.getByRole('button', { name: 'Close' }).click();
    await page.setViewportSize({ width: 390, height: 844 });
    for (const tab of ['Map', 'Camera', 'Cell', 'Status']) {
      await page.locator('.tabs').getByRole('button', { name: tab }).click();
      found.push(...await faults(page, `sheet ${tab}`));
    }
    expect(found).toEqual([]);
  });

test('every control is reached by Tab and has a name', async ({ page }) => {
  await openMock(page);
  await pauseMock(page);
  await page.keyboard.press('t'); // the tool with most controls
  await page.evaluate(() => (document.activeElement as HTMLElement | null)?.blur());
  const all = await page.evaluate(() => {
    const named = (e: Element): boolean => Boolean(e.getAttribute('aria-label') ?? (e.textContent?.trim() || (e as HTMLInputElement).labels?.[0]?.textContent?.trim()));
    const controls = [...document.querySelectorAll<HTMLElement>('button, input, select, summary, a[href], canvas[tabindex]')]
      .filter((e) => e.checkVisibility({ checkVisibilityCSS: true }) && e.closest('[hidden]') === null && !(e as HTMLButtonElement).disabled);
    controls.forEach((e, i) => { e.dataset['reach'] = String(i); });
    // Of radio buttons one is a stop for Tab, the others are reached by arrows.
    const stops = controls.filter((e) => (e as HTMLInputElement).type !== 'radio' || (e as HTMLInputElement).checked);
    return { stops: stops.map((e) => e.dataset['reach']), unnamed: controls.filter((e) => !named(e)).map((e) => e.outerHTML.slice(0, 90)) };
  });
  expect(all.unnamed).toEqual([]);
  const reached = new Set<string | undefined>();
  for (let i = 0; i < 2 * all.stops.length && reached.size < all.stops.length; ++i) {
    await page.keyboard.press('Tab');
    const now = await page.evaluate(() => (document.activeElement as HTMLElement | null)?.dataset['reach']);
    if (now !== undefined) reached.add(now);
  }
  const missed = all.stops.filter((stop) => !reached.has(stop));
  expect(await page.evaluate((list) => list.map((i) => document.querySelector(`[data-reach="${i}"]`)?.outerHTML.slice(0, 90)), missed)).toEqual([]);
});

test('keys do what the help says', async ({ page }) => {
  await openMock(page);
  await pauseMock(page);
  await page.locator('.map > canvas').focus();
  await page.keyboard.press('s');
  await expect(page.locator('.rules input[value="planning"]')).toBeChecked();
  await expect(page.locator('.legend figcaption')).toHaveText('Planning value');
  await page.keyboard.press('1');
  await expect(page.locator('.layer').last()).toHaveClass(/off/);
  await page.keyboard.press('Shift+Digit2');
  await expect(page.locator('.layer:not(.off)')).toHaveCount(1);
  await page.keyboard.press('m');
  await expect(page.locator('.tool-card')).toContainText('Measure');
  await page.keyboard.press('Escape');
  await expect(page.locator('.tool-card')).toBeHidden();
  await page.keyboard.press('v');
  await expect(page.getByRole('button', { name: 'Layers at their height' })).toHaveAttribute('aria-pressed', 'true');
  await page.keyboard.press('?');
  await expect(page.getByRole('dialog', { name: 'Keys' })).toBeVisible();
  await page.keyboard.press('Escape');
  await expect(page.getByRole('dialog')).toHaveCount(0);
});

test('a link brings back view, layers, style and cell', async ({ page }) => {
  await page.goto(`${files.url}/?mock=1&fresh#v=2,3,120,0.5&l=0:1,1:-,2:0.5&s=motion&p=viridis&o=minmax&t=0.45&c=2.5,3.5&e=another&r=1`);
  await expect(page.locator('.notice')).toContainText('another map');
  await expect(page.locator('.rules input[value="motion"]')).toBeChecked();
  await expect(page.locator('.palettes input[value="viridis"]')).toBeChecked();
  await expect(page.locator('.layer.off')).toHaveCount(1);
  await expect(page.locator('.cell-where')).toContainText('2.50');
  const middle = await page.evaluate(() => { const box = document.querySelector('.map > canvas')?.getBoundingClientRect(); const at = (window as never as { __flog: { project(x: number, y: number): { x: number; y: number } } }).__flog.project(2, 3); return [at.x - (box?.width ?? 0) / 2, at.y - (box?.height ?? 0) / 2]; });
  expect(Math.hypot(...middle)).toBeLessThan(2);
});

test('choices survive a reload', async ({ page }) => {
  await page.goto(`${files.url}/?mock=1`);
  await page.locator('.palettes input[value="contrast"]').check({ force: true });
  await page.reload();
  await expect(page.locator('.palettes input[value="contrast"]')).toBeChecked();
});

test('a broken connection is told at once and mends itself', async ({ page }) => {
  await openMock(page);
  await page.evaluate(() => (window as never as { __mock: { cut(): void } }).__mock.cut());
  await expect(page.locator('.chip')).toHaveText(/Offline since/);
  await expect(page.locator('.map > canvas')).toHaveClass(/stale/);
  await expect(page.locator('.chip')).toHaveText(/Live|Lagging/);
  await expect(page.locator('.map > canvas')).not.toHaveClass(/stale/);
});

test('measuring gives lengths in metres', async ({ page }) => {
  await page.setViewportSize({ width: 1280, height: 800 }); // both places lie on the map
  await openMock(page, '#v=2,3,100,0');
  await pauseMock(page);
  await page.getByRole('button', { name: 'Measure' }).click();
  const canvas = page.locator('.map > canvas');
  await canvas.click({ position: { x: 250, y: 300 } });
  await canvas.click({ position: { x: 450, y: 300 } });
  await page.mouse.move(5, 5);
  await expect(page.locator('.tool-card')).toContainText('2.00 m');
});
