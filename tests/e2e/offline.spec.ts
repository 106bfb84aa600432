// Without a network: after one visit the page works as before, below any path; newer versions wait for the visitor.
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { type Page, test } from '@playwright/test';
import { serve } from '../../scripts/serve.mjs';
import { foothold, root } from '../node/command.ts';
import { binaryStl, box, bunny } from '../node/shapes.ts';
import { cancelButton, download, expect, layerSlider, openFile, picture, ready, sliceButton, stepTab } from './page.ts';

test.use({ serviceWorkers: 'allow' });

const PLACE = { '/tools/slicer/': path.join(root, 'dist/page') };

/** Waits until a service worker answers for the page. */
const controlled = (page: Page) =>
  page.waitForFunction(() => navigator.serviceWorker.controller?.state === 'activated', undefined, { timeout: 60_000 });

function inFolder(folder: string, name: string, bytes: Uint8Array): string {
  mkdirSync(folder, { recursive: true });
  writeFileSync(path.join(folder, name), bytes);
  return path.join(folder, name);
}

test('after one visit it opens, slices, shows and saves a model without network and server', async ({ page, context }, {
  outputDir,
}) => {
  const server = await serve(PLACE);
  await ready(page, `${server.origin}/tools/slicer/`);
  await controlled(page);
  await context.setOffline(true);
  await server.close();

  await page.goto(`${server.origin}/tools/slicer/?learn=teeth/1`);
  await expect(page.locator('.lesson-pictures svg').first()).toBeVisible();
  await ready(page, `${server.origin}/tools/slicer/`);
  await page.getByRole('combobox', { name: 'Language' }).selectOption('de');
  await page.getByRole('combobox', { name: 'Sprache' }).selectOption('en');
  await stepTab(page, 'Prepare').click();
  await page.getByLabel('Printer', { exact: true }).selectOption('ender3');
  const stl = inFolder(outputDir, 'box.stl', binaryStl(box(20, 10, 8)));
  await openFile(page, stl);
  await expect(page.getByText('box.stl', { exact: true })).toBeVisible();
  await sliceButton(page).click();
  await expect(layerSlider(page)).toHaveAttribute('max', '40');
  await expect(picture(page).first()).toBeVisible();
  const { file } = await download(page);
  const words = ['slice', stl, '-o', 'box.gcode', '--printer', 'ender3'];
  expect(await foothold(words, outputDir)).toMatchObject({ code: 0, err: '' });
  const bytes = readFileSync(path.join(outputDir, 'box.gcode'));
  expect(readFileSync(file).equals(bytes), 'the bytes of the command line').toBe(true);

  // Another kind of file needs a module that the first visit did not use.
  const obj = 'v 0 0 0\nv 20 0 0\nv 0 20 0\nv 0 0 20\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n';
  await stepTab(page, 'Prepare').click();
  await openFile(page, inFolder(outputDir, 'corner.obj', Buffer.from(obj)));
  await expect(page.getByText('corner.obj', { exact: true })).toBeVisible();
});

test('it can be installed: name, address, icons', async ({ page, request }) => {
  await page.goto('./');
  const address = await page.locator('link[rel=manifest]').evaluate((it) => (it as HTMLLinkElement).href);
  const manifest = (await (await request.get(address)).json()) as {
    start_url: string;
    scope: string;
    display: string;
    icons: { src: string; sizes: string; type: string; purpose?: string }[];
  };
  expect(manifest).toMatchObject({ name: 'Foothold', start_url: './', scope: './', display: 'standalone' });
  expect(manifest.icons.some(({ purpose }) => purpose === 'maskable')).toBe(true);
  for (const { src, sizes } of manifest.icons.filter(({ type }) => type === 'image/png')) {
    const image = await request.get(new URL(src, address).href);
    // A PNG says its width and height from its byte 16.
    const bytes = await image.body();
    expect(`${bytes.readUInt32BE(16)}x${bytes.readUInt32BE(20)}`).toBe(sizes);
  }
});

test('a new version is told, never in the middle of a job, and waits for jobs in other tabs', async ({
  page,
  context,
}, { outputDir }) => {
  let version = '';
  const server = await serve(PLACE, {
    edit: (text, asked) => (asked.endsWith('offline.js') ? `${text}\n// ${version}` : text),
  });
  const address = `${server.origin}/tools/slicer/`;
  const said = (it: Page) => it.getByText('A new version is ready.', { exact: true });
  const reload = (it: Page) => it.getByRole('button', { name: 'Reload' });
  await ready(page, address);
  await controlled(page);
  await expect(said(page)).toHaveCount(0);
  const other = await context.newPage();
  await ready(other, address);
  await openFile(other, inFolder(outputDir, 'bunny.stl', binaryStl(bunny())));
  await expect(other.getByText('bunny.stl', { exact: true })).toBeVisible();
  // Many layers, so that the job does not end before it is cancelled.
  await other.getByLabel('Layer height').first().fill('0.05');
  await other.getByLabel('Layer height').first().press('Tab');

  version = 'two';
  await page.evaluate(async () => void (await (await navigator.serviceWorker.getRegistration())?.update()));
  await expect(said(page)).toBeVisible();
  await expect(said(other)).toBeVisible();

  await sliceButton(other).click();
  await expect(cancelButton(other)).toBeVisible();
  await expect(reload(other)).toHaveCount(0);
  await reload(page).click();
  await expect(page.getByText('it waits for the job in another tab')).toBeVisible();
  await cancelButton(other).click();
  await expect(said(other)).toBeVisible();

  await page.evaluate(() => document.body.setAttribute('data-old', ''));
  await reload(page).click();
  await expect(page.locator('body[data-old]')).toHaveCount(0);
  await expect(page.getByRole('button', { name: 'Open model' })).toBeVisible();
  await expect(reload(page)).toHaveCount(0);
  // The other tab is told, and left as it is.
  await expect(said(other)).toBeVisible();
  await expect(other.getByText('bunny.stl', { exact: true })).toBeVisible();
  await server.close();
});
