// What the browser tests share: a page that must not complain, and waiting for its states.
import { mkdirSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import AxeBuilder from '@axe-core/playwright';
import { test as base, expect, type Locator, type Page } from '@playwright/test';

/** A test whose page must not log errors, break its Content-Security-Policy or ask other hosts for anything. */
export const test = base.extend({
  page: async ({ page, baseURL }, use) => {
    const complaints: string[] = [];
    page.on('console', (message) => {
      if (message.type() === 'error') complaints.push(message.text());
    });
    page.on('pageerror', (error) => complaints.push(String(error)));
    page.on('request', (request) => {
      const own = request.url().startsWith(baseURL ?? '') || /^(blob|data):/.test(request.url());
      if (!own) complaints.push(`asked for ${request.url()}`);
    });
    await page.addInitScript(() => {
      document.addEventListener('securitypolicyviolation', (event) => {
        console.error(`security policy: ${event.violatedDirective} ${event.blockedURI}`);
      });
    });
    // Caught from the start: a chooser that comes up before it is asked for would be missed.
    page.on('filechooser', () => undefined);
    await use(page);
    expect(complaints).toEqual([]);
  },
});

export { expect };

export const sliceButton = (page: Page) => page.getByRole('button', { name: 'Slice', exact: true });
export const cancelButton = (page: Page) => page.getByRole('button', { name: 'Cancel' });
export const downloadButton = (page: Page) => page.getByRole('button', { name: 'Download G-code' });
export const layerSlider = (page: Page) => page.getByRole('slider', { name: 'Layer' });
export const stepTab = (page: Page, name: 'Prepare' | 'Preview' | 'Print' | 'Learn') =>
  page.getByRole('tab', { name, exact: true });
export const picture = (page: Page) => page.getByRole('application');

/** The page with its sample sliced, as a visitor finds it. */
export async function ready(page: Page, address = './'): Promise<void> {
  await page.goto(address);
  await expect(downloadButton(page)).toBeEnabled();
}

/** The page with its sample open but not sliced: for what needs no result. */
export const UNSLICED = './?model=sample.stl';

/** The page as a visitor finds it, for tests that go on to something else than the sample's result. */
export async function opened(page: Page): Promise<void> {
  await page.goto(UNSLICED);
  await expect(page.getByText('sample.stl', { exact: true })).toBeVisible();
}

/** A file to choose: a path, or its name and bytes. */
type Chosen = string | { readonly name: string; readonly bytes: Uint8Array | string };

/** Answers the file chooser that `open` brings up. */
export async function choose(page: Page, open: () => Promise<unknown>, file: Chosen): Promise<void> {
  const chooser = page.waitForEvent('filechooser');
  await open();
  const isPath = typeof file === 'string';
  const given = isPath
    ? file
    : { name: file.name, mimeType: 'application/octet-stream', buffer: Buffer.from(file.bytes) };
  await (await chooser).setFiles(given);
}

/** Opens a file through a button. */
export async function openFile(page: Page, file: Chosen, button = 'Open model'): Promise<void> {
  const opener: Locator = page.getByRole('button', { name: button });
  await choose(page, () => opener.click(), file);
}

/** A file for a test, in its folder. */
export function fileIn(folder: string, name: string, bytes: Uint8Array | string): string {
  mkdirSync(folder, { recursive: true });
  const file = path.join(folder, name);
  writeFileSync(file, bytes);
  return file;
}

/**
 * Axe finds nothing wrong, in light and in dark: names, roles and order are the same in both, so dark is asked for
 * its contrasts alone.
 */
export async function noFindings(page: Page, state: string): Promise<void> {
  await page.emulateMedia({ colorScheme: 'light' });
  expect(await found(new AxeBuilder({ page })), state).toEqual([]);
  await page.emulateMedia({ colorScheme: 'dark' });
  await expect(page.locator('[data-theme="dark"]').first()).toBeAttached();
  expect(
    await found(new AxeBuilder({ page }).withRules(['color-contrast', 'link-in-text-block'])),
    `${state}, dark`,
  ).toEqual([]);
}

async function found(axe: AxeBuilder): Promise<string[]> {
  const { violations } = await axe.analyze();
  return violations.map(({ id, nodes }) => `${id}: ${nodes.map(({ target }) => target.join(' ')).join(', ')}`);
}

/** The bytes that Download hands over, and the file's name. */
export async function download(page: Page): Promise<{ name: string; file: string }> {
  const waiting = page.waitForEvent('download');
  await downloadButton(page).click();
  const got = await waiting;
  return { name: got.suggestedFilename(), file: await got.path() };
}

/** Waits until the picture stands still, and returns it. */
export async function settled(page: Page): Promise<Buffer> {
  // A picture that moves may show less than when it rests.
  await page.waitForTimeout(300);
  let before = await picture(page).screenshot();
  for (let tries = 0; tries < 20; tries++) {
    await page.waitForTimeout(150);
    const now = await picture(page).screenshot();
    if (now.equals(before)) return now;
    before = now;
  }
  throw new Error('the picture does not settle');
}
