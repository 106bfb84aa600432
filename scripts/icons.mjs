// Draws the page's icons anew from www/public/icon.svg: `node scripts/icons.mjs`. What it writes is committed.
import { readFileSync } from 'node:fs';
import { chromium } from '@playwright/test';
import { at } from './places.mjs';
import { browser } from './setup.mjs';

const picture = `data:image/svg+xml,${encodeURIComponent(readFileSync(at('www', 'public', 'icon.svg'), 'utf8'))}`;
const executablePath = await browser();
const chrome = await chromium.launch({ ...(executablePath && { executablePath }), args: ['--no-sandbox'] });

/** A maskable icon has its colour to the edge, and the sign in its inner four fifths. */
async function icon(name, size, maskable = false) {
  const page = await chrome.newPage({ viewport: { width: size, height: size } });
  const inner = maskable ? 0.72 * size : size;
  await page.setContent(`<style>
    body { margin: 0; height: 100vh; display: grid; place-items: center; background: ${maskable ? '#0f766e' : 'none'} }
  </style><img src="${picture}" width="${inner}" height="${inner}">`);
  await page.locator('img').evaluate((it) => it.decode());
  await page.screenshot({ path: at('www', 'public', name), omitBackground: true });
}

await icon('icon-192.png', 192);
await icon('icon-512.png', 512);
await icon('icon-maskable.png', 512, true);
await chrome.close();
