// Loads the module for files of other programs, in the page and its workers.
import type { Files } from './files.ts';

let loaded: Promise<Files> | undefined;

/** `wasm` is the address of the module's code. */
export function loadFiles(wasm: string): Promise<Files> {
  loaded ??= start(wasm);
  return loaded;
}

async function start(wasm: string): Promise<Files> {
  const files = await import('../generated/files/foothold_files.js');
  await files.default({ module_or_path: wasm });
  return files;
}
