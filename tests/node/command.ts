// Runs the command line as a user does.
import { spawn } from 'node:child_process';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { fileURLToPath } from 'node:url';

export const root = fileURLToPath(new URL('../..', import.meta.url));

export interface Ended {
  readonly code: number | null;
  readonly signal: NodeJS.Signals | null;
  readonly out: Buffer;
  readonly err: string;
}

/** Runs `foothold` with these words; `stop` is a signal to send after so many ms. */
export function foothold(
  words: readonly string[],
  cwd: string,
  stop?: { signal: NodeJS.Signals; after: number },
): Promise<Ended> {
  return new Promise((resolve) => {
    const child = spawn(process.execPath, [path.join(root, 'bin/foothold.mjs'), ...words], {
      cwd,
      stdio: ['ignore', 'pipe', 'pipe'],
    });
    const out: Buffer[] = [];
    let err = '';
    child.stdout.on('data', (bytes: Buffer) => out.push(bytes));
    child.stderr.setEncoding('utf8').on('data', (text: string) => {
      err += text;
    });
    if (stop !== undefined) setTimeout(() => child.kill(stop.signal), stop.after);
    child.on('close', (code, signal) => resolve({ code, signal, out: Buffer.concat(out), err }));
  });
}

/** A folder for one test file. */
export function temporaryFolder(): { folder: string; remove: () => void } {
  const folder = mkdtempSync(path.join(tmpdir(), 'foothold-test-'));
  return { folder, remove: () => rmSync(folder, { recursive: true, force: true }) };
}
