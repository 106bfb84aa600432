// Loads the module for files of other programs, from beside the command line.
import { readFileSync } from 'node:fs';
import type { Files } from '../../www/src/files/files.ts';

export async function loadFiles(): Promise<Files> {
  const files = await import('../../www/src/generated/files/foothold_files.js');
  const wasm = readFileSync(new URL('./foothold_files_bg.wasm', import.meta.url));
  files.initSync({ module: new WebAssembly.Module(wasm) });
  return files;
}
