// <foothold-slicer> in the example of a host page: another origin, a strict policy, a sub-path, no special headers.
import { mkdirSync, readFileSync } from 'node:fs';
import path from 'node:path';
import { type Page, test as plain } from '@playwright/test';
import { embedExample } from '../../scripts/embed.mjs';
import { foothold } from '../node/command.ts';
import { expect, noFindings, sliceButton } from './page.ts';
import { connected, ofJob, printFile, printStep, seen, wish, withPrinter } from './printer.ts';

const sample = new URL('../../www/public/sample.stl', import.meta.url).pathname;

interface Example {
  readonly element: { readonly origin: string; readonly asked: string[] };
  readonly host: { readonly origin: string; readonly asked: string[] };
  readonly address: string;
}

/** The example, whose page must not complain nor break its policy, in a page or in a worker. */
const test = plain.extend<{ example: Example }>({
  // biome-ignore lint/correctness/noEmptyPattern: Playwright wants the pattern
  example: async ({}, use) => {
    const example = await embedExample();
    await use(example);
    await example.close();
  },
  page: async ({ page }, use) => {
    const complaints: string[] = [];
    page.on('console', (message) => {
      if (message.type() === 'error') complaints.push(message.text());
    });
    page.on('pageerror', (error) => complaints.push(String(error)));
    await page.addInitScript(() => {
      addEventListener('securitypolicyviolation', ({ violatedDirective, blockedURI }) =>
        console.error(`security policy: ${violatedDirective} ${blockedURI}`),
      );
    });
    await use(page);
    expect(complaints).toEqual([]);
  },
});

const report = (page: Page) =>
  page.evaluate(async () => {
    const slicer = document.querySelector('foothold-slicer') as HTMLElement & { slice(): Promise<object> };
    return slicer.slice();
  });

/** The text of an element's G-code. */
const gcodeOf = (page: Page, at = 0) =>
  page.evaluate(async (k) => {
    const slicer = document.querySelectorAll('foothold-slicer')[k] as HTMLElement & { gcode(): File | undefined };
    const file = slicer.gcode();
    return file && { name: file.name, text: await file.text() };
  }, at);

test('the example: a price from the report, the bytes of the command line, nothing asked for but the model', async ({
  page,
  example,
}, { outputDir }) => {
  await page.goto(example.address);
  await expect(page.getByText('bracket.stl', { exact: true })).toBeVisible();
  await expect(page.getByText('Creality Ender-3', { exact: true })).toBeVisible();
  await expect(page.getByRole('button', { name: 'Open model' })).toHaveCount(0);
  await expect(page.getByLabel('Layer height')).toHaveCount(0);
  await sliceButton(page).click();
  await expect(page.getByRole('button', { name: 'Order' })).toBeEnabled({ timeout: 60_000 });
  await expect(page.locator('.quote output')).toHaveText(/^\d+\.\d\d € for \d+\.\d g of PETG$/);

  const got = await gcodeOf(page);
  mkdirSync(outputDir, { recursive: true });
  const words = ['slice', sample, '-o', 'shop.gcode', '--printer', 'ender3', '--material', 'petg'];
  expect(await foothold(words, outputDir)).toMatchObject({ code: 0, err: '' });
  const same = readFileSync(path.join(outputDir, 'shop.gcode'), 'utf8') === got?.text;
  expect(same, 'the bytes of the command line').toBe(true);

  // The host is asked for its own files and the model; the element's host for parts of the element.
  expect(new Set(example.host.asked)).toEqual(
    new Set(['', 'shop.css', 'shop.js', 'icon.svg', 'bracket.stl'].map((name) => `/shop/parts/${name}`)),
  );
  expect(example.element.asked.filter((it) => !/^\/(foothold-slicer\.js|assets\/[^/]+\.(js|wasm))$/.test(it))).toEqual(
    [],
  );
  await noFindings(page, 'sliced');
  const kept = await page.evaluate(async () => [
    localStorage.length,
    (await indexedDB.databases()).map((it) => it.name),
  ]);
  expect(kept).toEqual([0, ['foothold-print']]);
});

test('settings set before the element is defined count, and a job ends quietly with its element', async ({
  page,
  example,
}) => {
  await page.addInitScript(() => {
    // As the parser meets the element, before its module runs.
    new MutationObserver(() => {
      const early = document.querySelector('foothold-slicer');
      if (early !== null && !('settings' in early)) Object.assign(early, { settings: { layers: { height: 0.3 } } });
    }).observe(document, { childList: true, subtree: true });
  });
  await page.goto(example.address);
  const told = await page.evaluate(async () => {
    const slicer = document.querySelector('foothold-slicer') as HTMLElement & {
      load(address: string): Promise<void>;
      slice(): Promise<{ layers: number }>;
    };
    const errors: unknown[] = [];
    slicer.addEventListener('foothold-error', (event) => errors.push((event as CustomEvent).detail));
    await slicer.load('bracket.stl');
    const { layers } = await slicer.slice();
    const ended = slicer.slice().catch((error: Error) => error.name);
    slicer.remove();
    return { layers, ended: await ended, errors };
  });
  expect(told).toEqual({ layers: 160, ended: 'AbortError', errors: [] });
});

test('several on a page do not disturb each other, and one that is removed frees its workers', async ({
  page,
  example,
}) => {
  await page.goto(example.address);
  await report(page);
  const first = await gcodeOf(page);
  const before = page.workers().length;
  const errors = await page.evaluate(async () => {
    const second = document.createElement('foothold-slicer') as HTMLElement & {
      settings: object;
      load(file: Blob): Promise<void>;
      slice(): Promise<{ layers: number }>;
    };
    const found: string[] = [];
    second.addEventListener('foothold-error', (event) => {
      const { name, message } = (event as CustomEvent<{ name: string; message: string }>).detail;
      found.push(`${name}: ${message}`);
    });
    document.querySelector('main')?.append(second);
    await second.load(new File(['solid nothing'], 'broken.stl')).catch((error: Error) => found.push(error.name));
    second.setAttribute('printer', 'nobody');
    await second.load(new File([''], 'empty.stl')).catch((error: Error) => found.push(error.name));
    second.setAttribute('printer', 'mini');
    second.settings = { layers: { height: 0.3 } };
    await second.load(await (await fetch('bracket.stl')).blob());
    found.push(String((await second.slice()).layers));
    return found;
  });
  expect(errors[0]).toMatch(/^ModelError: /);
  expect(errors[1]).toBe('ModelError');
  expect(errors[2]).toMatch(/^SettingsError: there is no printer "nobody"/);
  expect(errors.at(-1)).toBe('160');
  const second = await gcodeOf(page, 1);
  expect(second?.text).toContain('layers.height = 0.3');
  expect(await gcodeOf(page)).toEqual(first);

  // Undo in one is not undo in the other, and keys outside are the host's.
  await page.keyboard.press('Control+z');
  expect(await gcodeOf(page)).toEqual(first);

  await page.evaluate(() => document.querySelectorAll('foothold-slicer')[1]?.remove());
  await expect.poll(() => page.workers().length).toBe(before);
  await page.evaluate(() => {
    const slicer = document.querySelector('foothold-slicer');
    // Moved, it goes on as it was.
    if (slicer !== null) document.querySelector('footer')?.append(slicer);
  });
  expect(await gcodeOf(page)).toEqual(first);
  await page.evaluate(() => document.querySelector('foothold-slicer')?.remove());
  await expect.poll(() => page.workers().length).toBe(0);
});

test('a visitor who is at another step when the model comes stays there', async ({ page, example }) => {
  let send = (): void => undefined;
  const asked = new Promise<void>((resolve) => {
    send = resolve;
  });
  await page.route('**/bracket.stl', async (route) => {
    await asked;
    await route.continue();
  });
  await page.goto(example.address);
  const print = page.getByRole('tab', { name: 'Print', exact: true });
  await print.click();
  send();
  await expect(page.getByText('bracket.stl is open.')).toBeAttached();
  await expect(print).toHaveAttribute('aria-selected', 'true');
});

test('a print from another origin: its worker has the port, and the host hears when it begins and ends', async ({
  page,
  example,
}) => {
  await withPrinter(page);
  await printStep(page, example.address);
  await wish(page, { printer: { moveMs: 1 }, factor: 20 });
  await page.evaluate(() => {
    const told: unknown[] = [];
    addEventListener('foothold-print', (event) => told.push((event as CustomEvent).detail));
    Object.assign(globalThis, { told });
  });
  await connected(page);
  const job = ['G28', 'M109 S200', 'M83', 'G1 X1 Y1 Z0.2 E0.01', 'G1 X2 Y2 E0.01'];
  await printFile(page, 'job.gcode', `${job.join('\n')}\n`);
  const told = () => page.evaluate(() => Object.getOwnPropertyDescriptor(globalThis, 'told')?.value as unknown);
  await expect.poll(told).toEqual([
    { state: 'started', name: 'job.gcode' },
    { state: 'finished', name: 'job.gcode' },
  ]);
  const { accepted, inPage } = await seen(page);
  expect(ofJob(accepted)).toEqual(job);
  expect(inPage).toBe(false);
});
