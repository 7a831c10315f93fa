import { defineConfig } from 'vitest/config';

// Relative addresses, so that the page also works behind a proxy that gives it a sub-path. Nothing is inlined: the
// server's content security policy allows files of its own origin and nothing else.
export default defineConfig({
  base: './',
  build: {
    target: 'es2022',
    assetsInlineLimit: 0,
    chunkSizeWarningLimit: 900,
    modulePreload: { polyfill: false },
    rollupOptions: { input: ['index.html', 'calibrate.html'] },
  },
  worker: { format: 'es' },
  server: {
    proxy: { '/api': { target: process.env['FLOGMAP_SERVER'] ?? 'http://127.0.0.1:8080', ws: true } },
  },
  test: { include: ['src/**/*.test.ts'], environment: 'node' },
});
