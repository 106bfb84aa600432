#!/usr/bin/env node
// The command line; its source is bin/cli, built by `npm run build`.
import { existsSync } from 'node:fs';

const built = new URL('../dist/node/cli.mjs', import.meta.url);
if (existsSync(built)) {
  const { main } = await import(built.href);
  await main(process.argv.slice(2));
} else {
  console.error('foothold: not built yet: run `npm run build` first');
  process.exitCode = 1;
}
