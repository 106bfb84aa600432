// How much of the page is loaded at first; the engine has a limit of its own, of 700 KiB.
import { readdirSync, readFileSync } from 'node:fs';
import path from 'node:path';
import { gzipSync } from 'node:zlib';
import { expect, test } from 'vitest';
import { root } from './command.ts';

const page = path.join(root, 'dist/page');
/** Of 900 KiB for the first load, what the engine leaves. */
const LIMIT = 200 * 1024;

test('the first load is small: without the engine, and without three.js', () => {
  const html = readFileSync(path.join(page, 'index.html'), 'utf8');
  const named = [...html.matchAll(/(?:src|href)="\.\/(assets\/[^"]+)"/g)].map(([, file]) => file ?? '');
  const workers = readdirSync(path.join(page, 'assets')).filter((it) => /^(lead|helper|view)\.worker-.*\.js$/.test(it));
  expect(workers).toHaveLength(3);
  const loaded = [...named, ...workers.map((it) => `assets/${it}`)].map((it) => readFileSync(path.join(page, it)));
  expect(loaded.some((it) => it.includes('WebGLRenderer'))).toBe(false);
  const total = [Buffer.from(html), ...loaded].reduce((sum, it) => sum + gzipSync(it, { level: 9 }).length, 0);
  expect(total).toBeLessThan(LIMIT);
});
