// What the browser tests share: a page that must not complain, and waiting for its states.
import AxeBuilder from '@axe-core/playwright';
import { test as base, expect, type Page } from '@playwright/test';

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
    await use(page);
    expect(complaints).toEqual([]);
  },
});

export { expect };

export const sliceButton = (page: Page) => page.getByRole('button', { name: 'Slice', exact: true });
export const cancelButton = (page: Page) => page.getByRole('button', { name: 'Cancel' });
export const downloadButton = (page: Page) => page.getByRole('button', { name: 'Download G-code' });
export const layerSlider = (page: Page) => page.getByRole('slider', { name: 'Layer' });
export const stepTab = (page: Page, name: 'Prepare' | 'Preview') => page.getByRole('tab', { name, exact: true });
export const picture = (page: Page) => page.getByRole('application');

/** The page with its sample sliced, as a visitor finds it. */
export async function ready(page: Page, address = './'): Promise<void> {
  await page.goto(address);
  await expect(downloadButton(page)).toBeEnabled();
}

/** Opens a file through the button. */
export async function openFile(page: Page, file: string): Promise<void> {
  const chooser = page.waitForEvent('filechooser');
  await page.getByRole('button', { name: 'Open model' }).click();
  await (await chooser).setFiles(file);
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
  let before = await picture(page).screenshot();
  for (let tries = 0; tries < 20; tries++) {
    await page.waitForTimeout(150);
    const now = await picture(page).screenshot();
    if (now.equals(before)) return now;
    before = now;
  }
  throw new Error('the picture does not settle');
}

/** Axe finds nothing on the page, which is in this state. */
export async function noFindings(page: Page, state: string): Promise<void> {
  const { violations } = await new AxeBuilder({ page }).analyze();
  const found = violations.map(({ id, nodes }) => `${id}: ${nodes.map(({ target }) => target.join(' ')).join(', ')}`);
  expect(found, state).toEqual([]);
}
