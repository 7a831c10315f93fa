// The page in Debian's Chromium against the real program. Run by `npm run e2e` in web/.
import { defineConfig } from '@playwright/test';

export default defineConfig({
  testDir: '.',
  outputDir: '../../web/test-results',
  snapshotPathTemplate: '{testDir}/golden/{arg}{ext}',
  workers: 1, // every test starts a mapping program of its own: two at a time would only slow each other down
  fullyParallel: false,
  timeout: 240_000,
  expect: { timeout: 60_000 },
  reporter: 'list',
  use: {
    viewport: { width: 1000, height: 640 },
    colorScheme: 'dark',
    launchOptions: {
      executablePath: process.env['FLOGMAP_CHROMIUM'] ?? '/usr/bin/chromium',
      args: ['--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking', '--disable-component-update', '--disable-sync',
        '--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
    },
  },
});
