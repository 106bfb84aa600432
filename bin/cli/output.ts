// Files that are written whole or not at all: a temporary file beside the target, then a rename.
import {
  closeSync,
  existsSync,
  openSync,
  realpathSync,
  renameSync,
  rmSync,
  statSync,
  writeSync,
  writevSync,
} from 'node:fs';
import path from 'node:path';
import { FileError, reasonOf } from './errors.ts';

/** Buffers in one system call; Linux takes 1024. */
const PARTS_PER_WRITE = 1000;

/** Temporary files that are there now; removed when the program is stopped. */
const temporary = new Set<string>();

/** Removes what is half written. */
export function removeTemporary(): void {
  for (const file of temporary) rmSync(file, { force: true });
  temporary.clear();
}

/** One output of a command. Opened before the work, so that a folder that can't be written is found at once. */
export class Output {
  readonly #name: string;
  readonly #target: string;
  readonly #temporary: string | undefined;
  #file: number;

  /** `name` is a file, or - for standard output. */
  constructor(name: string) {
    this.#name = name;
    this.#target = existsSync(name) ? realpathSync(name) : path.resolve(name);
    const direct = name === '-' || isSpecial(this.#target, name);
    this.#temporary = direct ? undefined : `${this.#target}.${process.pid}.part`;
    this.#file = name === '-' ? 1 : this.#open(this.#temporary ?? this.#target);
    if (this.#temporary !== undefined) temporary.add(this.#temporary);
  }

  /** Writes the parts, in order. */
  write(parts: readonly (Uint8Array | string)[]): void {
    const buffers = parts
      .map((part) => (typeof part === 'string' ? Buffer.from(part) : part))
      .filter((it) => it.length > 0);
    this.#attempt(() => {
      for (let k = 0; k < buffers.length; k += PARTS_PER_WRITE) {
        writeAll(this.#file, buffers.slice(k, k + PARTS_PER_WRITE));
      }
    });
  }

  /** Puts the file in its place. */
  finish(): void {
    if (this.#file === 1) return;
    const [from, to] = [this.#temporary, this.#target];
    this.#attempt(() => {
      closeSync(this.#file);
      if (from !== undefined) renameSync(from, to);
    });
    if (from !== undefined) temporary.delete(from);
  }

  #open(file: string): number {
    return this.#attempt(() => openSync(file, this.#temporary === undefined ? 'w' : 'wx'));
  }

  #attempt<T>(work: () => T): T {
    try {
      return work();
    } catch (error) {
      throw new FileError(this.#name, `can't be written: ${reasonOf(error)}`, 2);
    }
  }
}

/** A device or a pipe is written to directly; a folder is no place for a file. */
function isSpecial(target: string, name: string): boolean {
  if (!existsSync(target)) return false;
  const found = statSync(target);
  if (found.isDirectory()) throw new FileError(name, "can't be written: is a folder", 2);
  return !found.isFile();
}

/** Writes all bytes, also when the system takes fewer at a time, as a full pipe does. */
function writeAll(file: number, buffers: readonly Uint8Array[]): void {
  let written = attemptWrite(() => writevSync(file, buffers));
  for (const buffer of buffers) {
    const from = Math.min(written, buffer.length);
    written -= from;
    writeRest(file, buffer.subarray(from));
  }
}

function writeRest(file: number, buffer: Uint8Array): void {
  for (let rest = buffer; rest.length > 0; ) {
    const now = rest;
    rest = rest.subarray(attemptWrite(() => writeSync(file, now)));
  }
}

/** A pipe that is full now takes the bytes later. */
function attemptWrite(write: () => number): number {
  try {
    return write();
  } catch (error) {
    if (!(error instanceof Error && 'code' in error && error.code === 'EAGAIN')) throw error;
    Atomics.wait(new Int32Array(new SharedArrayBuffer(4)), 0, 0, 5);
    return 0;
  }
}
