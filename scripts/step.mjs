// A build step that is skipped while nothing it reads has changed.
import { createHash } from 'node:crypto';
import { existsSync, mkdirSync, readdirSync, readFileSync, rmSync, statSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { at, root } from './places.mjs';

/**
 * Runs `work` unless the contents of `inputs` (files and folders, relative to the checkout) are those of
 * the last run, and so is `variant`, and every one of `outputs` is there. Resolves to whether it ran.
 */
export async function step(name, { inputs, outputs, ignore = [], variant = '' }, work) {
  const stamp = at('dist', '.steps', name);
  const now = digest(inputs, ignore) + variant;
  const fresh = existsSync(stamp) && readFileSync(stamp, 'utf8') === now;
  if (fresh && outputs.every((it) => existsSync(at(it)))) return false;
  console.log(`build: ${name}`);
  rmSync(stamp, { force: true });
  await work();
  mkdirSync(path.dirname(stamp), { recursive: true });
  writeFileSync(stamp, now);
  return true;
}

function digest(inputs, ignore) {
  const hash = createHash('sha256');
  for (const file of inputs.flatMap((it) => filesBelow(at(it)))) {
    const name = path.relative(root, file);
    if (ignore.some((it) => name.startsWith(it))) continue;
    hash.update(`${name}\0`).update(readFileSync(file)).update('\0');
  }
  return hash.digest('hex');
}

function filesBelow(place) {
  if (!existsSync(place)) return [];
  if (!statSync(place).isDirectory()) return [place];
  return readdirSync(place)
    .sort()
    .flatMap((name) => filesBelow(path.join(place, name)));
}
