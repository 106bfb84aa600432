import { createServer } from 'node:net';
import { defineConfig } from '@playwright/test';
import { browser } from './scripts/setup.mjs';

const executablePath = await browser();
/** A port that nobody uses; the workers, which read this file again, hear of it by the environment. */
process.env['FOOTHOLD_PORT'] ??= String(await freePort());
const port = process.env['FOOTHOLD_PORT'];

export default defineConfig({
  testDir: 'tests/e2e',
  outputDir: 'test-results',
  fullyParallel: true,
  // A machine that is busy with something else may keep a browser waiting; what needs it twice is told as flaky.
  retries: 1,
  workers: 2,
  forbidOnly: process.env['CI'] === 'true',
  timeout: 120_000,
  expect: { timeout: 30_000 },
  reporter: [['list']],
  use: {
    baseURL: `http://localhost:${port}/`,
    headless: true,
    // Only the test of the page without a network wants what a service worker keeps.
    serviceWorkers: 'block',
    launchOptions: {
      ...(executablePath === undefined ? {} : { executablePath }),
      args: [
        '--no-sandbox',
        '--disable-gpu',
        // Pictures in space have tests of their own: everywhere else the browser's software would draw them slowly.
        '--disable-3d-apis',
        '--disable-background-networking',
        '--disable-component-update',
        '--disable-sync',
      ],
    },
  },
  webServer: {
    command: `node node_modules/vite/bin/vite.js preview --port ${port} --strictPort`,
    url: `http://localhost:${port}/`,
    reuseExistingServer: false,
  },
});

function freePort(): Promise<number> {
  return new Promise((resolve, reject) => {
    const server = createServer();
    server.on('error', reject);
    server.listen(0, () => {
      const address = server.address();
      server.close(() => resolve(typeof address === 'object' && address !== null ? address.port : 0));
    });
  });
}
