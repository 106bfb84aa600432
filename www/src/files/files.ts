// Files of other programs, read by a second wasm module that is loaded when such a file is opened: models in 3MF and
// OBJ, profiles of other slicers.
import type { Bytes, GcodeIndex, ModelSource } from '../messages.ts';
import { suited } from '../profiles/suits.ts';
import { EngineError, toFailure } from '../slicer/errors.ts';
import { type Gcode, openedGcode } from '../slicer/gcode.ts';

export type Files = typeof import('../generated/files/foothold_files.js');
export type LoadFiles = () => Promise<Files>;

/** Larger files are refused: a binary STL of this size holds eight million triangles, which take 1 GB to slice. */
const LARGEST = 400 * 1024 * 1024;

/** The models in a file that is no STL, as one STL for each part. Throws a ModelError. */
export async function modelsIn({ name, file }: ModelSource, load: LoadFiles): Promise<readonly ModelSource[]> {
  try {
    refuseTooLarge(file.size);
    const files = await load();
    const parts = new files.Parts(name, await bytes(file, file.size));
    const count = parts.count();
    const models = Array.from({ length: count }, (_, k) => ({
      name: count === 1 ? name : `${stem(name)}_${parts.name(k) || k + 1}`,
      file: new Blob([parts.stl(k) as Uint8Array<ArrayBuffer>]),
    }));
    parts.free();
    return models;
  } catch (error) {
    throw new EngineError(toFailure(error, name));
  }
}

/** Whether a file is G-code, by its name. */
export function isGcode({ name }: ModelSource): boolean {
  return /\.(gcode|gco|g|nc|bgcode)$/i.test(name);
}

/** A G-code file with what the engine finds in it. Throws a ModelError. */
export async function readGcode(
  { name, file }: ModelSource,
  index: (source: ModelSource) => Promise<GcodeIndex>,
): Promise<Gcode> {
  refuseTooLarge(file.size);
  const found = await index({ name, file });
  return openedGcode(new Uint8Array(await file.slice(0, file.size).arrayBuffer()), name, found);
}

/** What became of a profile of another slicer; the engine's `Imported`. */
export interface Imported {
  readonly slicer: string;
  readonly settings: object;
  readonly mapped: readonly Entry[];
  readonly changed: readonly Entry[];
  readonly unknown: readonly Entry[];
}

export interface Entry {
  readonly key: string;
  readonly value: string;
  readonly path?: string;
  readonly to?: string;
  readonly why?: string;
}

/** Reads a profile of PrusaSlicer, OrcaSlicer or Cura. Throws a SettingsError. */
export async function importProfile(profile: Uint8Array, load: LoadFiles): Promise<Imported> {
  const files = await load();
  const found = JSON.parse(files.import_profile(profile)) as Imported;
  return { ...found, settings: suited(found.settings) };
}

/** Whether a file is no STL: a ZIP archive by its first bytes, or by its name; the module looks closer. */
export async function isForeign({ name, file }: ModelSource): Promise<boolean> {
  // What cannot be read is told when the model is.
  const beginning = await bytes(file, 4).catch(() => new Uint8Array());
  const isZip = beginning[0] === 0x50 && beginning[1] === 0x4b && (beginning[2] ?? 0) < 8;
  return isZip || /\.(obj|3mf)$/i.test(name);
}

async function bytes(file: Bytes, to: number): Promise<Uint8Array> {
  return new Uint8Array(await file.slice(0, Math.min(to, file.size)).arrayBuffer());
}

/** Throws a ModelError when a file has more bytes than can be worked with. */
export function refuseTooLarge(size: number): void {
  if (size > LARGEST) throw tooLarge('too large', size);
}

/** Throws a ModelError when files, each small enough, have too many bytes together. */
export function refuseTooLargeTogether(sources: readonly ModelSource[]): void {
  const size = sources.reduce((sum, { file }) => sum + file.size, 0);
  if (sources.length > 1 && size > LARGEST) throw tooLarge(`${sources.length} files are too large together`, size);
}

function tooLarge(what: string, size: number): EngineError {
  const mib = (n: number): string => `${Math.ceil(n / 1024 / 1024)} MiB`;
  return new EngineError({
    name: 'ModelError',
    message: `${what}: ${mib(size)}, the limit is ${mib(LARGEST)}`,
    fatal: false,
  });
}

/** A file's name without folders and ending. */
export function stem(name: string): string {
  const base = name.split(/[/]/).at(-1) ?? name;
  return base.replace(/\.(stl|3mf|obj)$/i, '') || 'model';
}
