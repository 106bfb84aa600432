// How much of the page is loaded at first.
import { readdirSync, readFileSync } from 'node:fs';
import path from 'node:path';
import { gzipSync } from 'node:zlib';
import { expect, test } from 'vitest';
import { root } from './command.ts';

const page = path.join(root, 'dist/page');
const KIB = 1024;
const assets = readdirSync(path.join(page, 'assets'));
const gzipped = (bytes: Uint8Array): number => gzipSync(bytes, { level: 9 }).length;
const asset = (name: RegExp): Buffer => {
  const [file, ...more] = assets.filter((it) => name.test(it));
  if (file === undefined || more.length > 0) throw new Error(`${name}: not one file`);
  return readFileSync(path.join(page, 'assets', file));
};
const engine = asset(/^foothold_bg-.*\.wasm$/);
/** A build for trying things out keeps its names and is as large as it likes. */
const isQuick = WebAssembly.Module.customSections(await WebAssembly.compile(new Uint8Array(engine)), 'name').length > 0;

test.skipIf(isQuick)('the engine has at most 700 KiB', () => {
  expect(gzipped(engine)).toBeLessThan(700 * KIB);
});

test('the first load has at most 900 KiB with such an engine, and no three.js', () => {
  const html = readFileSync(path.join(page, 'index.html'), 'utf8');
  const named = [...html.matchAll(/(?:src|href)="\.\/(assets\/[^"]+)"/g)].map(([, file]) => file ?? '');
  const workers = ['lead', 'helper', 'view'].map((it) => asset(new RegExp(`^${it}\\.worker-.*\\.js$`)));
  const loaded = [Buffer.from(html), ...named.map((it) => readFileSync(path.join(page, it))), ...workers];
  expect(loaded.some((it) => it.includes('WebGLRenderer'))).toBe(false);
  const total = loaded.reduce((sum, it) => sum + gzipped(it), 0);
  expect(total).toBeLessThan((900 - 700) * KIB);
});
