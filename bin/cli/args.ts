// Words of the command line -> a command. Wrong use is a UsageError.
import { availableParallelism } from 'node:os';
import { type ParseArgsConfig, parseArgs } from 'node:util';
import { ids, type Kind } from '../../www/src/profiles/catalog.ts';
import type { Layers } from '../../www/src/profiles/layers.ts';
import { hint } from './nearest.ts';

export class UsageError extends Error {
  override name = 'UsageError';
}

/** Settings as the user gave them: profiles first, then files, then single values. */
export interface SettingWords {
  readonly profiles: Layers;
  readonly files: readonly string[];
  readonly sets: readonly string[];
}

/** One setting of one model. */
export interface OwnWord {
  /** The model by its file's name, with or without ending. */
  readonly model: string;
  /** `path=value`. */
  readonly set: string;
}

/** A model whose possibilities are weighed against each other. */
export interface Weighing {
  readonly model: string;
  readonly settings: SettingWords;
  readonly report: string | undefined;
  readonly workers: number;
}

export type Command =
  | {
      readonly kind: 'slice';
      readonly models: readonly string[];
      readonly out: string | undefined;
      readonly settings: SettingWords;
      readonly own: readonly OwnWord[];
      readonly report: string | undefined;
      readonly workers: number;
      readonly scale: number | undefined;
    }
  | {
      readonly kind: 'place';
      readonly models: readonly string[];
      readonly out: string;
      readonly settings: SettingWords;
      readonly scale: number | undefined;
    }
  | { readonly kind: 'inspect'; readonly model: string; readonly report: string | undefined }
  | {
      readonly kind: 'draw';
      readonly model: string;
      readonly what: { readonly layer: number } | { readonly plane: string };
      readonly out: string;
      readonly settings: SettingWords;
    }
  | ({ readonly kind: 'orient' } & Weighing)
  | ({ readonly kind: 'compare' } & Weighing)
  | { readonly kind: 'settings'; readonly settings: SettingWords; readonly schema: boolean }
  | { readonly kind: 'profiles' }
  | { readonly kind: 'import'; readonly file: string; readonly out: string | undefined }
  | { readonly kind: 'help' }
  | { readonly kind: 'version' };

export const help = `Foothold: STL, 3MF or OBJ in, printable G-code out.

usage: foothold slice MODEL... [-o OUT.gcode] [--printer ID] [--material ID] [--quality ID]
                [--settings F.json] [--set path=value]... [--set-for MODEL:path=value]...
                [--report R.json] [--scale F] [--workers N]
       foothold inspect MODEL|FILE.gcode [--report R.json]
       foothold place MODEL... -o OUT.stl [--scale F] [--set path=value]...
       foothold draw MODEL (--layer K | --plane y=12.5) -o OUT.svg [--settings F.json] [--set path=value]...
       foothold orient MODEL [--report R.json] [--layer-height T] [--workers N]
       foothold compare MODEL [--report R.json]
       foothold settings [--schema] [--printer ID] ... [--settings F.json] [--set path=value]...
       foothold profiles
       foothold import PROFILE [-o SETTINGS.json]

  slice      writes G-code; several models are arranged on the bed; what may not print well is told with its
             place and with what mends it. Without -o the file gets a name of its own, such as
             cube_0.2mm_PLA_1h2m3s.gcode, in this folder
  inspect    counts triangles, shells and faults, and measures the model; of a G-code file of any slicer
             its layers, time, filament and lengths by role
  place      the models as they stand on the bed, scaled and turned, in one STL
  draw       one layer (K counts from 0) or one vertical plane as a picture
  orient     which way up needs the least support, with the figures of each direction
  compare    skirt, brim, raft and teeth side by side
  settings   all settings, or their JSON Schema
  profiles   the printers, materials and qualities that --printer, --material and --quality name; without
             --printer it is a Marlin printer of 220 x 220 x 250 mm with PLA
  import     a profile of PrusaSlicer (.ini), OrcaSlicer (.json) or Cura (.curaprofile), or the settings in
             G-code of theirs or of this program, and what became of each value; slice takes what -o writes
             with --settings

  -o, --output     file to write, whole or not at all; - is standard output
  --printer, --material, --quality
                   profiles, each over the one before; settings and single values lie over them
  --settings       settings as JSON; may be given again, the later one wins
  --set            one setting: JSON, else a plain word (--set adhesion.kind=skirt)
  --set-for        one setting of one model, named as its file (--set-for cube:infill.density=1)
  --report         what was made, as JSON
  --scale          every model F times as large as in its file (25.4 for inches)
  --workers        engines that work at the same time (default: processors, at most 4)
  --help, --version

  foothold slice part.stl --printer ender3 --material petg -o part.gcode
  foothold slice part.stl --set layers.height=0.3 --set support.method=plates

exit: 0 done; 1 a bug of ours; 2 wrong use or settings; 3 a model that can't be read or used;
      4 it does not fit the printer
`;

const settingOptions = {
  printer: { type: 'string' },
  material: { type: 'string' },
  quality: { type: 'string' },
  settings: { type: 'string', multiple: true },
  set: { type: 'string', multiple: true },
} as const;
const output = { output: { type: 'string', short: 'o' } } as const;
const report = { report: { type: 'string' } } as const;
const workers = { workers: { type: 'string' } } as const;
const scale = { scale: { type: 'string' } } as const;

/** The command that `words` (without node and the script) ask for. */
export function parseCommand(words: readonly string[]): Command {
  const [name, ...rest] = words;
  if (name === undefined) throw new UsageError('no command: try foothold --help');
  if (name === 'help' || words.includes('--help') || words.includes('-h')) return { kind: 'help' };
  if (name === '--version' || name === '-V') return { kind: 'version' };
  switch (name) {
    case 'slice':
      return slice(rest);
    case 'place':
      return place(rest);
    case 'inspect':
      return inspect(rest);
    case 'draw':
      return draw(rest);
    case 'orient':
      return orient(rest);
    case 'compare':
      return compare(rest);
    case 'settings':
      return settings(rest);
    case 'import':
      return importOf(rest);
    case 'profiles':
      parsed({ args: rest, options: {}, allowPositionals: false });
      return { kind: 'profiles' };
    default:
      throw new UsageError(
        `no command "${name}": slice, place, inspect, draw, orient, compare, settings, profiles and import are there`,
      );
  }
}

function slice(words: readonly string[]): Command {
  const setFor = { 'set-for': { type: 'string', multiple: true } } as const;
  const options = { ...settingOptions, ...setFor, ...output, ...report, ...workers, ...scale } as const;
  const { values, positionals } = parsed({ args: [...words], options, allowPositionals: true });
  if (positionals.length === 0) throw new UsageError('slice needs a model');
  return {
    kind: 'slice',
    models: positionals,
    out: values.output,
    settings: settingWords(values),
    own: (values['set-for'] ?? []).map(ownWord),
    report: values.report,
    workers: workerCount(values.workers),
    scale: scaleOf(values.scale),
  };
}

/** A path has no colon, names of files may have some. */
function ownWord(word: string): OwnWord {
  const [, model, set] = /^(.+?):([\w.]+=.*)$/s.exec(word) ?? [];
  if (model === undefined || set === undefined) {
    throw new UsageError(`--set-for ${word}: expected MODEL:path=value`);
  }
  return { model, set };
}

function place(words: readonly string[]): Command {
  const options = { ...settingOptions, ...output, ...scale } as const;
  const { values, positionals } = parsed({ args: [...words], options, allowPositionals: true });
  if (positionals.length === 0) throw new UsageError('place needs a model');
  if (values.output === undefined) throw new UsageError('place needs -o OUT.stl');
  return {
    kind: 'place',
    models: positionals,
    out: values.output,
    settings: settingWords(values),
    scale: scaleOf(values.scale),
  };
}

function scaleOf(word: string | undefined): number | undefined {
  if (word === undefined) return undefined;
  const factor = Number(word);
  if (!(factor > 0 && factor <= 1e6)) throw new UsageError(`--scale ${word}: expected a number above 0`);
  return factor;
}

function inspect(words: readonly string[]): Command {
  const { values, positionals } = parsed({ args: [...words], options: report, allowPositionals: true });
  return { kind: 'inspect', model: oneModel('inspect', positionals), report: values.report };
}

function importOf(words: readonly string[]): Command {
  const { values, positionals } = parsed({ args: [...words], options: output, allowPositionals: true });
  const [file, ...more] = positionals;
  if (file === undefined || more.length > 0) throw new UsageError('import takes one profile');
  return { kind: 'import', file, out: values.output };
}

function draw(words: readonly string[]): Command {
  const options = { ...settingOptions, ...output, layer: { type: 'string' }, plane: { type: 'string' } } as const;
  const { values, positionals } = parsed({ args: [...words], options, allowPositionals: true });
  const model = oneModel('draw', positionals);
  if (values.output === undefined) throw new UsageError('draw needs -o OUT.svg');
  return {
    kind: 'draw',
    model,
    what: drawn(values.layer, values.plane),
    out: values.output,
    settings: settingWords(values),
  };
}

function drawn(layer: string | undefined, plane: string | undefined): { layer: number } | { plane: string } {
  if (layer !== undefined && plane !== undefined) throw new UsageError('draw takes --layer or --plane, not both');
  if (layer !== undefined) return { layer: wholeNumber('--layer', layer, 0, 1_000_000) };
  if (plane === undefined) throw new UsageError('draw needs --layer K or --plane y=12.5');
  if (!/^[xy]=[-+]?(\d+\.?\d*|\.\d+)$/.test(plane)) {
    throw new UsageError(`--plane ${plane}: expected x or y, = and a number of mm, such as y=12.5`);
  }
  return { plane };
}

function orient(words: readonly string[]): Command {
  const options = { ...settingOptions, ...report, ...workers, 'layer-height': { type: 'string' } } as const;
  const { values, positionals } = parsed({ args: [...words], options, allowPositionals: true });
  const height = values['layer-height'];
  const { profiles, files, sets } = settingWords(values);
  return {
    kind: 'orient',
    model: oneModel('orient', positionals),
    settings: { profiles, files, sets: height === undefined ? sets : [...sets, `orientation.layer_height=${height}`] },
    report: values.report,
    workers: workerCount(values.workers),
  };
}

function compare(words: readonly string[]): Command {
  const options = { ...settingOptions, ...report } as const;
  const { values, positionals } = parsed({ args: [...words], options, allowPositionals: true });
  return {
    kind: 'compare',
    model: oneModel('compare', positionals),
    settings: settingWords(values),
    report: values.report,
    workers: 1,
  };
}

function settings(words: readonly string[]): Command {
  const options = { ...settingOptions, schema: { type: 'boolean' } } as const;
  const { values } = parsed({ args: [...words], options, allowPositionals: false });
  return { kind: 'settings', settings: settingWords(values), schema: values.schema ?? false };
}

/** `parseArgs`, with its errors as ours: one short line. */
function parsed<T extends ParseArgsConfig>(config: T): ReturnType<typeof parseArgs<T>> {
  try {
    return parseArgs<T>(config);
  } catch (error) {
    const [first = ''] = (error instanceof Error ? error.message : String(error)).split(/\. |\n/);
    throw new UsageError(first.charAt(0).toLowerCase() + first.slice(1) + optionHint(first, config));
  }
}

/** What an unknown option was meant to be: one that is there, or a setting. */
function optionHint(message: string, { options = {} }: ParseArgsConfig): string {
  const [, option] = /^Unknown option '(-[^']+)'/.exec(message) ?? [];
  if (option === undefined) return '';
  const near = hint(
    option,
    Object.keys(options).map((name) => `--${name}`),
  );
  return near === '' ? ': settings are given as --set path=value, see --help' : near;
}

interface SettingValues {
  readonly settings?: string[];
  readonly set?: string[];
  readonly printer?: string;
  readonly material?: string;
  readonly quality?: string;
}

function settingWords(values: SettingValues): SettingWords {
  for (const word of values.set ?? []) {
    if (!/^[^=]+=/.test(word)) throw new UsageError(`--set ${word}: expected path=value`);
  }
  return { profiles: layers(values), files: values.settings ?? [], sets: values.set ?? [] };
}

/** The profiles named, each of which must be there. */
function layers(values: SettingValues): Layers {
  const named: { [K in Kind]?: string } = {};
  for (const kind of ['printer', 'material', 'quality'] as const) {
    const id = values[kind];
    if (id === undefined) continue;
    if (!ids(kind).includes(id)) throw new UsageError(`--${kind} ${id}: there are ${ids(kind).join(', ')}`);
    named[kind] = id;
  }
  return named;
}

function oneModel(command: string, positionals: readonly string[]): string {
  const [model, ...more] = positionals;
  if (model === undefined) throw new UsageError(`${command} needs a model`);
  if (more.length > 0) throw new UsageError(`${command} takes one model, not ${positionals.length}`);
  return model;
}

/** As many engines as asked for, else as there are processors, at most 4. */
function workerCount(word: string | undefined): number {
  if (word === undefined) return Math.min(availableParallelism(), 4);
  return wholeNumber('--workers', word, 1, 64);
}

function wholeNumber(option: string, word: string, low: number, high: number): number {
  const value = Number(word);
  if (!/^\d+$/.test(word) || value < low || value > high) {
    throw new UsageError(`${option} ${word}: expected a whole number from ${low} to ${high}`);
  }
  return value;
}
