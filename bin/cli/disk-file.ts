// A model on disk in the shape that the lead reads.
import { closeSync, openSync, readSync, statSync } from 'node:fs';
import type { Bytes, ModelSource } from '../../www/src/messages.ts';
import { FileError, reasonOf } from './errors.ts';

/** Bytes of a file, read when asked for; it stays open until it is closed or the program ends. */
export class DiskFile implements Bytes {
  readonly size: number;
  readonly #file: number;

  constructor(name: string) {
    try {
      const found = statSync(name);
      if (!found.isFile()) throw new Error(found.isDirectory() ? 'is a folder' : 'is not a file');
      this.size = found.size;
      this.#file = openSync(name, 'r');
    } catch (error) {
      throw new FileError(name, `can't be read: ${reasonOf(error)}`, 3);
    }
  }

  slice(from: number, to: number): { arrayBuffer(): Promise<ArrayBuffer> } {
    return { arrayBuffer: async () => this.#read(from, to) };
  }

  close(): void {
    closeSync(this.#file);
  }

  #read(from: number, to: number): ArrayBuffer {
    const bytes = new Uint8Array(to - from);
    for (let got = 0; got < bytes.length; ) {
      const count = readSync(this.#file, bytes, got, bytes.length - got, from + got);
      if (count === 0) throw new Error('it became shorter while it was read');
      got += count;
    }
    return bytes.buffer;
  }
}

/** The model file `name`. */
export function openModel(name: string): ModelSource & { readonly file: DiskFile } {
  return { name, file: new DiskFile(name) };
}
