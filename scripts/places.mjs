// Where things are: the one list of folders that the scripts share.
import { homedir } from 'node:os';
import path from 'node:path';
import { fileURLToPath } from 'node:url';

export const root = path.dirname(path.dirname(fileURLToPath(import.meta.url)));
/** A path inside the checkout. */
export const at = (...parts) => path.join(root, ...parts);

/** Tools built from source are kept here, outside the checkout. */
export const cache =
  process.env.FOOTHOLD_CACHE ?? path.join(process.env.XDG_CACHE_HOME ?? path.join(homedir(), '.cache'), 'foothold');

export const wasmTarget = 'wasm32-unknown-unknown';
/** What the build writes for the page: types, and the wasm modules with their JavaScript. */
export const generated = at('www', 'src', 'generated');
export const schema = at('schema');
