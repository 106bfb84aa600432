// What the tests of the Print step share: a page with the simulated printer behind `navigator.serial`.
import { readFileSync } from 'node:fs';
import { expect, type Page } from '@playwright/test';
import { openFile, UNSLICED } from './page.ts';

/** What the stand-in makes of the printer and its port. */
export interface Wish {
  /** Without faults, or with those of a seed in a job of so many moves. */
  readonly printer?:
    | { readonly moveMs?: number; readonly heatRate?: number; readonly advanced?: boolean }
    | { readonly seed: number; readonly moves: number };
  /** The speed it understands. */
  readonly baud?: number;
  /** Time runs so many times as fast. */
  readonly factor?: number;
  /** The board starts anew whenever the port opens. */
  readonly resetOnOpen?: boolean;
  readonly unplugAfter?: number;
  /** Ports that look the same; a worker cannot tell two. */
  readonly ports?: number;
  readonly busy?: boolean;
  readonly noPort?: boolean;
}

/** What the simulated printer has seen. */
export interface Seen {
  readonly accepted: string;
  readonly halted: boolean;
  readonly moves: number;
  readonly overruns: number;
  readonly fullest: number;
  readonly opens: number;
  readonly open: boolean;
  readonly inPage: boolean;
}

interface Simulator {
  wish(wish: Wish): void;
  state(): Promise<Seen>;
  unplug(): Promise<void>;
  say(line: string): Promise<void>;
  fate(seed: number): string;
}

declare global {
  var simulator: Simulator;
}

const STAND_IN = new URL('../../dist/simulator/serial.js', import.meta.url);

/** Puts the simulated printer in front of the page and of its print worker. */
export async function withPrinter(page: Page): Promise<void> {
  const standIn = readFileSync(STAND_IN, 'utf8');
  await page.addInitScript(standIn);
  await page.route('**/print.worker-*.js', async (route) => {
    const response = await route.fetch();
    await route.fulfill({ response, body: `${standIn}\n${await response.text()}` });
  });
}

export const wish = (page: Page, it: Wish): Promise<void> => page.evaluate((it) => simulator.wish(it), it);
export const seen = (page: Page): Promise<Seen> => page.evaluate(() => simulator.state());
export const unplug = (page: Page): Promise<void> => page.evaluate(() => simulator.unplug());
export const say = (page: Page, line: string): Promise<void> => page.evaluate((line) => simulator.say(line), line);

export const button = (page: Page, name: string) => page.getByRole('button', { name, exact: true });
export const part = (page: Page, name: string) => page.getByRole('region', { name, exact: true });

export async function printStep(page: Page, address = UNSLICED): Promise<void> {
  await page.goto(address);
  await page.getByRole('tab', { name: 'Print' }).click();
}

/** At the speed that the stand-in understands when nothing else is wished. */
export async function connected(page: Page): Promise<void> {
  await page.getByRole('button', { name: /^(Connect|Reconnect) printer$/ }).click();
  await expect(part(page, 'Printer').getByText('Ready')).toBeVisible();
}

/** Opens a G-code file in the Print step: it prints at once. */
export async function printFile(page: Page, name: string, text: string): Promise<void> {
  await openFile(page, { name, bytes: text }, 'Print a G-code file…');
}

/** The commands of a file, as a printer should see them. */
export function commands(gcode: string): string[] {
  const lines = gcode.split('\n').map((line) => (line.split(';')[0] ?? '').trim());
  return lines.filter((line) => line !== '');
}

/** What the printer took of the job: everything but the link's own lines. */
export function ofJob(accepted: string): string[] {
  const own = /^(M110|M105|M115|M155)\b/;
  return accepted.split('\n').filter((line) => line !== '' && !own.test(line));
}
