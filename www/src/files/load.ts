// Loads the module for files of other programs, in the page and its workers.
import type { Files } from './files.ts';

let loaded: Promise<Files> | undefined;

export function loadFiles(): Promise<Files> {
  loaded ??= start();
  return loaded;
}

async function start(): Promise<Files> {
  const files = await import('../generated/files/foothold_files.js');
  await files.default();
  return files;
}
