// Printing through the real page, with the simulated printer behind `navigator.serial`.
import { readFileSync } from 'node:fs';
import { test as base, type Page, type Route } from '@playwright/test';
import { binaryStl, box } from '../node/shapes.ts';
import { download, downloadButton, expect, noFindings, opened, openFile, sliceButton, test } from './page.ts';
import {
  button,
  commands,
  connected,
  ofJob,
  part,
  printFile,
  printStep,
  say,
  seen,
  unplug,
  type Wish,
  wish,
  withPrinter,
} from './printer.ts';

/** Home, heat, then moves that are all different, fifty a layer. */
function job(moves: number): string {
  const head = ['; a job', 'G28', 'M190 S60', 'M109 S200 ; hot', '', 'M83'];
  const lines = Array.from({ length: moves }, (_, i) => [
    ...(i % 50 === 0 ? [';LAYER_CHANGE', `;Z:${(0.2 * (1 + i / 50)).toFixed(1)}`] : []),
    `G1 X${i} Y${i % 97} Z${(0.2 * (1 + Math.floor(i / 50))).toFixed(1)} E0.0${1 + (i % 8)} ; ${i}`,
  ]);
  return `${[...head, ...lines.flat()].join('\n')}\n`;
}

const quick: Wish = { printer: { moveMs: 1 }, factor: 20 };
const slow: Wish = { printer: { moveMs: 200 } };

const ended = (page: Page) =>
  page.locator('print-job').locator('.problem, [role=status]:has-text("is printed")').first();

async function start(page: Page, it: Wish, address?: string): Promise<void> {
  await withPrinter(page);
  await printStep(page, address);
  await wish(page, it);
}

/** Prints a file and waits until some moves are made. */
async function underWay(page: Page, moves = 600, atLeast = 20): Promise<string> {
  const text = job(moves);
  await printFile(page, 'job.gcode', text);
  await expect.poll(async () => (await seen(page)).moves).toBeGreaterThan(atLeast);
  return text;
}

test('slice, connect, print: what the printer accepted is the file', async ({ page }) => {
  await withPrinter(page);
  await opened(page);
  await wish(page, { ...quick, baud: 250000 });
  await openFile(page, { name: 'plate.stl', bytes: binaryStl(box(12, 12, 1)) });
  await expect(page.getByText('12 × 12 × 1 mm')).toBeVisible();
  await sliceButton(page).click();
  await expect(page.getByRole('status').filter({ hasText: 'Sliced: 5 layers' })).toBeAttached();
  const gcode = readFileSync((await download(page)).file, 'utf8');

  await page.getByRole('tab', { name: 'Print' }).click();
  await connected(page);
  await expect(part(page, 'Printer')).toContainText('Sim One');
  await expect(part(page, 'Printer')).toContainText('Marlin 2.1.2');
  await expect(part(page, 'Printer')).toContainText('250000 baud');
  await expect(part(page, 'Temperature').getByRole('row', { name: /Nozzle/ })).toContainText('20 °C');
  await button(page, 'Print').click();
  await expect(ended(page)).toContainText('is printed');
  const { accepted, inPage, overruns, fullest } = await seen(page);
  expect(ofJob(accepted)).toEqual(commands(gcode));
  expect(inPage, 'a worker has the port').toBe(false);
  expect(overruns).toBe(0);
  expect(fullest).toBeLessThanOrEqual(127);
  await expect(page.getByRole('slider', { name: 'Layer' })).toHaveValue('5');
});

test('where a worker cannot tell the port, the page has it', async ({ page }) => {
  await start(page, { ...quick, ports: 2 });
  await connected(page);
  const text = job(60);
  await printFile(page, 'job.gcode', text);
  await expect(ended(page)).toContainText('job.gcode is printed');
  const { accepted, inPage } = await seen(page);
  expect(inPage).toBe(true);
  expect(ofJob(accepted)).toEqual(commands(text));
});

test('pause parks, resume returns, cancel cools down', async ({ page }) => {
  await start(page, { printer: { moveMs: 20 }, factor: 4 });
  await connected(page);
  // Long enough not to end before it is cancelled, however slow the page is.
  await underWay(page, 20_000);
  await button(page, 'Pause').click();
  await expect(part(page, 'Print')).toContainText('Paused.');
  await expect(button(page, 'Resume')).toBeVisible();
  await expect(part(page, 'Printer')).toContainText('Paused');
  expect((await seen(page)).accepted).toContain('G1 X0 Y0 F6000');
  const before = (await seen(page)).moves;
  await button(page, 'Resume').click();
  await expect.poll(async () => (await seen(page)).moves).toBeGreaterThan(before + 3);
  await part(page, 'Print').getByLabel('Speed of moves').fill('150');
  await part(page, 'Print').getByLabel('Flow').fill('95');
  await expect.poll(async () => (await seen(page)).accepted).toMatch(/M220 S150[\s\S]*M221 S95/);
  await button(page, 'Cancel print').click();
  await expect(ended(page)).toContainText('The print was cancelled.');
  await expect(part(page, 'Printer')).toContainText('Ready');
  expect((await seen(page)).accepted).toMatch(/M104 S0\nM140 S0/);
});

test('the emergency stop leaves at once, the port is closed, the reason stands in words', async ({ page }) => {
  await start(page, slow);
  await connected(page);
  await underWay(page, 600, 5);
  await button(page, 'Emergency stop').click();
  await expect(ended(page)).toContainText('Emergency stop. The printer has to be reset');
  const { halted, open } = await seen(page);
  expect([halted, open]).toEqual([true, false]);
});

test('unplugged and plugged in again, the print goes on behind the last acknowledged line', async ({ page }) => {
  await start(page, slow);
  await connected(page);
  const text = await underWay(page, 80);
  await unplug(page);
  await expect(ended(page)).toContainText('cable pulled');
  await expect(part(page, 'Unfinished print')).toContainText('Connect the printer to go on.');
  await connected(page);
  await button(page, 'Go on from here').click();
  await expect(ended(page)).toContainText('job.gcode is printed');
  // The line in flight when the cable was pulled may have arrived: then it comes twice in a row.
  const printed = ofJob((await seen(page)).accepted);
  expect(printed.filter((line, k) => line !== printed[k - 1])).toEqual(commands(text));
});

test('a printer that forgot its state begins at a layer: hot, homed beside the part, purged', async ({ page }) => {
  await start(page, { printer: { moveMs: 20 }, factor: 4 });
  await connected(page);
  await underWay(page, 600, 130);
  await unplug(page);
  await wish(page, { printer: { moveMs: 20 }, factor: 4, resetOnOpen: true });
  await connected(page);
  const standing = part(page, 'Unfinished print');
  await expect(standing).toContainText('no longer knows where its head is');
  await expect(button(page, 'Go on from here')).toHaveCount(0);
  await standing.getByLabel('Begin at layer').fill('3');
  await standing.getByLabel('Begin at layer').press('Tab');
  await standing.getByLabel('Height of the nozzle now').fill('0.6');
  await standing.getByLabel('Height of the nozzle now').press('Tab');
  await button(page, 'Begin at this layer').click();
  await expect.poll(async () => (await seen(page)).accepted).toMatch(/G92 Z5\.6[\s\S]*G1 X101 /);
  const { accepted } = await seen(page);
  const restart = accepted.slice(accepted.lastIndexOf('M140 S60'));
  expect(
    commands(restart)
      .filter((line) => line !== 'M105')
      .slice(0, 15),
  ).toEqual([
    'M140 S60',
    'M109 S200',
    'G21',
    'G91',
    'G1 Z5 F600',
    'G90',
    'G28 X Y',
    'G92 Z5.6',
    'M190 S60',
    'M83',
    'G1 E20 F150',
    'G90',
    'G1 X99 Y2 F6000',
    'G1 Z0.4 F600',
    'G90',
  ]);
});

test('a closed tab: the next visit offers to go on', async ({ page }) => {
  await start(page, slow);
  await connected(page);
  await underWay(page, 600, 8);
  await page.waitForTimeout(400);
  page.once('dialog', (dialog) => dialog.accept());
  await page.reload();
  await page.getByRole('tab', { name: 'Print' }).click();
  await expect(part(page, 'Unfinished print')).toContainText(/job\.gcode stands at line \d+, layer 1/);
  await button(page, 'Give it up').click();
  await expect(part(page, 'Unfinished print')).toHaveCount(0);
  await page.reload();
  await page.getByRole('tab', { name: 'Print' }).click();
  await expect(part(page, 'Unfinished print')).toHaveCount(0);
});

test('what is wrong with a file stands in words, and nothing of it is printed that should not be', async ({ page }) => {
  await start(page, quick);
  await connected(page);
  await printFile(page, 'macro.gcode', 'G1 X1\nSTART_PRINT BED=60\nG1 X2\n');
  await expect(part(page, 'Print').getByRole('alert')).toContainText('Line 2 (START_PRINT) is a macro');
  await button(page, 'Do not print').click();
  await printFile(page, 'long.gcode', `G1 X1\nG1 X${'1'.repeat(200)}\n`);
  await expect(ended(page)).toContainText('Line 2 of the file cannot be sent: it is 204 bytes long');
  await printFile(page, 'stop.gcode', 'G1 X1\nM112\nG1 X2\n');
  await expect(ended(page)).toContainText('Line 2 of the file is an emergency stop');
  expect(ofJob((await seen(page)).accepted).filter((line) => line.startsWith('G1 X'))).toEqual(['G1 X1', 'G1 X1']);
});

test('console, jog, preheat; a printer that pauses by itself', async ({ page }) => {
  await start(page, quick);
  await connected(page);
  const command = part(page, 'Console').getByLabel('Command');
  await command.fill('M999');
  await command.press('Enter');
  await expect(page.getByRole('log')).toContainText('Unknown command: "M999"');
  await command.press('ArrowUp');
  await expect(command).toHaveValue('M999');
  await button(page, 'Move X by 10 mm').click();
  await button(page, 'Home all').click();
  await button(page, 'Preheat (210 / 60 °C)').click();
  await expect
    .poll(async () => ofJob((await seen(page)).accepted))
    .toEqual([...['M999', 'G91', 'G1 X10 F3000', 'G90', 'G28', 'M140 S60', 'M104 S210']]);
  await expect(part(page, 'Temperature').getByRole('row', { name: /Nozzle/ })).toContainText('210 °C');
});

test('a pause at the printer is obeyed and told', async ({ page }) => {
  await start(page, slow);
  await connected(page);
  await underWay(page, 600, 5);
  await say(page, '//action:pause');
  await expect(part(page, 'Print')).toContainText('Paused by the printer.');
});

test('a port in use, no printer, and a chooser that was closed', async ({ page }) => {
  await start(page, { ...quick, busy: true });
  await button(page, 'Connect printer').click();
  await expect(part(page, 'Printer').getByRole('alert')).toContainText('could not be opened');
  await wish(page, { factor: 100, baud: 1 });
  await button(page, 'Connect printer').click();
  await expect(part(page, 'Printer').getByRole('alert')).toContainText('Nothing answers like a printer');
  expect((await seen(page)).open).toBe(false);
});

test('the screen lock is held while printing, and leaving asks first', async ({ page }) => {
  await page.addInitScript(() => {
    const held: string[] = [];
    const request = async () => {
      held.push('held');
      return { released: false, release: async () => void held.push('released') };
    };
    Object.defineProperty(navigator, 'wakeLock', { value: { request } });
    Object.assign(globalThis, { held });
  });
  await start(page, slow);
  await connected(page);
  await underWay(page, 600, 3);
  const held = () => page.evaluate(() => (globalThis as unknown as { held: string[] }).held);
  expect(await held()).toEqual(['held']);
  const asks = await page.evaluate(() => !dispatchEvent(new Event('beforeunload', { cancelable: true })));
  expect(asks).toBe(true);
  await button(page, 'Cancel print').click();
  await expect(ended(page)).toContainText('cancelled');
  await expect.poll(held).toEqual(['held', 'released']);
});

/** One run with the mixed faults of a seed, as natively in tests/printer_link.rs. */
async function mixedRun(page: Page, seed: number): Promise<void> {
  const moves = 300;
  const text = job(moves);
  const fate = await page.evaluate((seed) => simulator.fate(seed), seed);
  const unplugAfter = fate === 'unplug' ? { unplugAfter: 1 + ((seed * 37) % (moves - 2)) } : {};
  await wish(page, { printer: { seed, moves }, factor: 30, resetOnOpen: seed % 3 === 0, ...unplugAfter });
  await page.getByLabel('Speed (baud)').selectOption('115200');
  await connected(page);
  await printFile(page, `${seed}.gcode`, text);
  await expect(button(page, 'Cancel print')).toBeVisible();
  await expect(ended(page)).toBeVisible({ timeout: 100_000 });
  const how = (await ended(page).textContent()) ?? '';
  const printed = ofJob((await seen(page)).accepted);
  const wanted = commands(text);
  expect(printed, `seed ${seed}: each line once and in order`).toEqual(wanted.slice(0, printed.length));
  const reasons: Readonly<Record<string, RegExp>> = {
    finish: /is printed/,
    reset: /restarted by itself/,
    hang: /stopped answering/,
    // A garbled error line is no error line; then the job may also be printed whole.
    error: /The printer reported|is printed/,
    unplug: /cable pulled/,
  };
  expect(how, `seed ${seed}, ${fate}`).toMatch(reasons[fate] ?? /never/);
  if (/is printed/.test(how)) {
    expect(printed.length, `seed ${seed}`).toBe(wanted.length);
    await button(page, 'Disconnect').click();
  }
  await expect(page.getByRole('button', { name: 'Reconnect printer' })).toBeVisible();
  expect((await seen(page)).open, 'the port is not left open').toBe(false);
}

const seeds = process.env['FOOTHOLD_LONG'] === '1' ? Array.from({ length: 20 }, (_, k) => k) : [5, 6, 7, 8, 9];
for (const turn of [0, 1]) {
  const mine = seeds.filter((_, k) => k % 2 === turn);
  test(`mixed faults through the page, seeds ${mine.join(', ')}`, async ({ page }) => {
    test.setTimeout(60_000 * mine.length);
    await start(page, {});
    for (const seed of mine) await mixedRun(page, seed);
  });
}

test('a printer that answers at once, and never more in flight than its buffer holds', async ({ page }, info) => {
  const lines = process.env['FOOTHOLD_LONG'] === '1' ? 200_000 : 20_000;
  await start(page, { printer: { moveMs: 0 } });
  await connected(page);
  const moves = commands(job(lines)).filter((line) => line.startsWith('G1'));
  const began = Date.now();
  await printFile(page, 'fast.gcode', moves.join('\n'));
  await expect(ended(page)).toContainText('is printed', { timeout: 100_000 });
  const speed = Math.round(lines / ((Date.now() - began) / 1000));
  info.annotations.push({ type: 'acknowledged lines a second', description: String(speed) });
  console.log(`${speed} acknowledged lines a second through the page`);
  const { moves: made, fullest, overruns } = await seen(page);
  expect([made, overruns]).toEqual([lines, 0]);
  expect(fullest).toBeLessThanOrEqual(127);
});

test('axe finds nothing on the Print step', async ({ page }) => {
  await start(page, slow);
  await page.getByText('Send to a print server').click();
  await noFindings(page, 'not connected');
  await connected(page);
  await underWay(page, 600, 3);
  await noFindings(page, 'printing');
  await button(page, 'Pause').click();
  await expect(button(page, 'Resume')).toBeVisible();
  await noFindings(page, 'paused');
  await unplug(page);
  await expect(ended(page)).toContainText('cable pulled');
  await noFindings(page, 'unplugged');
  await wish(page, { ...slow, resetOnOpen: true });
  await connected(page);
  await expect(button(page, 'Begin at this layer')).toBeVisible();
  await noFindings(page, 'connected, start at a layer');
});

test('connect, print, pause, resume and cancel by keyboard alone', async ({ page }) => {
  await start(page, slow, './');
  const reach = async (name: RegExp): Promise<void> => {
    for (let presses = 0; presses < 60; presses++) {
      const label = await page.evaluate(() => {
        const at = document.activeElement;
        return at?.getAttribute('aria-label') ?? at?.textContent ?? '';
      });
      if (name.test(label.trim())) return;
      await page.keyboard.press('Tab');
    }
    throw new Error(`Tab does not reach ${name}`);
  };
  await expect(downloadButton(page)).toBeEnabled();
  const press = async (name: RegExp): Promise<void> => {
    await reach(name);
    await page.keyboard.press('Enter');
  };
  await press(/^Connect printer$/);
  await expect(part(page, 'Printer').getByText('Ready')).toBeVisible();
  await press(/^Print$/);
  await expect(button(page, 'Pause')).toBeVisible();
  await press(/^Pause$/);
  await expect(button(page, 'Resume')).toBeFocused();
  await page.keyboard.press('Enter');
  await expect(button(page, 'Pause')).toBeFocused();
  await press(/^Cancel print$/);
  await expect(ended(page)).toContainText('cancelled');
  await press(/^Move Z by 10 mm$/);
  await expect.poll(async () => (await seen(page)).accepted).toContain('G1 Z10 F600');
  await press(/^Emergency stop$/);
  await expect(button(page, 'Reconnect printer')).toBeVisible();
});

test('without Web Serial the step says so, and the download is there', async ({ page }) => {
  await page.addInitScript(() => Reflect.deleteProperty(Navigator.prototype, 'serial'));
  await printStep(page, './');
  await expect(page.getByText('This browser cannot print over USB')).toBeVisible();
  await expect(button(page, 'Connect printer')).toHaveCount(0);
  await expect(downloadButton(page)).toBeEnabled();
});

test('a file goes to a print server beside the page, with its key, which is kept only if asked', async ({
  page,
  baseURL,
}) => {
  const asked: { url: string; key: string | undefined; print: string | undefined; size: number }[] = [];
  const hear = (status: number) => async (route: Route) => {
    const request = route.request();
    const headers = request.headers();
    const size = request.postDataBuffer()?.length ?? 0;
    asked.push({ url: request.url(), key: headers['x-api-key'], print: headers['print-after-upload'], size });
    await route.fulfill({ status, body: '{}' });
  };
  await page.route('**/api/v1/files/**', hear(201));
  await page.route('**/api/files/local', hear(201));
  await printStep(page, './');
  await expect(downloadButton(page)).toBeEnabled();
  await page.getByText('Send to a print server').click();
  await page.getByLabel('Address', { exact: true }).fill(baseURL ?? '');
  await page.getByLabel('Key', { exact: true }).fill('secret');
  await button(page, 'Send file').click();
  await expect(page.getByText('The server has the file.')).toBeVisible();
  await page.getByLabel('Server', { exact: true }).selectOption('PrusaLink');
  await page.getByLabel('Print at once').check();
  await button(page, 'Send file').click();
  await expect.poll(() => asked.length).toBe(2);
  expect(asked.map(({ key }) => key)).toEqual(['secret', 'secret']);
  expect(asked[1]?.url).toMatch(/\/api\/v1\/files\/usb\/sample_.*\.gcode$/);
  expect(asked[1]?.print).toBe('?1');
  expect(await page.evaluate(() => localStorage.getItem('foothold-print-server'))).toBeNull();
  await page.getByLabel('Keep address and key').check();
  expect(await page.evaluate(() => localStorage.getItem('foothold-print-server'))).toContain('secret');
});

base('a server that the page may not talk to: the message says why', async ({ page }) => {
  await printStep(page, './');
  await expect(downloadButton(page)).toBeEnabled();
  await page.getByText('Send to a print server').click();
  await page.getByLabel('Address', { exact: true }).fill('octopi.local');
  await button(page, 'Send file').click();
  await expect(page.getByRole('alert')).toContainText(
    'policy of this page does not let it talk to http://octopi.local',
  );
  await page.getByLabel('Address', { exact: true }).fill('not an address');
  await button(page, 'Send file').click();
  await expect(page.getByRole('alert')).toContainText('That is no address');
});
