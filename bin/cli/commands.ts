// What each command does.
import { readFileSync, realpathSync } from 'node:fs';
import { type Imported, importProfile as importedFrom, isGcode, stem } from '../../www/src/files/files.ts';
import type { ModelSource, Standing } from '../../www/src/messages.ts';
import { standing as placedPart, UNMOVED } from '../../www/src/parts.ts';
import { ids, type Kind, settingsFiles } from '../../www/src/profiles/catalog.ts';
import { type Layers, parseSaved, type SavedSettings } from '../../www/src/profiles/layers.ts';
import { partsOf } from '../../www/src/slicer/gcode.ts';
import { Pool, type Progress } from '../../www/src/slicer/pool.ts';
import { type Command, type OwnWord, type SettingWords, UsageError, type Weighing } from './args.ts';
import { openModel } from './disk-file.ts';
import { FileError, reasonOf } from './errors.ts';
import { loadFiles } from './files.ts';
import { gcodeInWords, inWords } from './inspection.ts';
import { nodeLanes } from './lanes.ts';
import { Output } from './output.ts';
import { progressBar } from './progress.ts';
import { remarkLines } from './remarks.ts';
import { adhesionTable, directionTable, importTable, profileTable } from './tables.ts';

type Of<K extends Command['kind']> = Extract<Command, { kind: K }>;

export async function slice({ models, out, settings, own, report, workers, scale }: Of<'slice'>): Promise<void> {
  const sources = models.map(openModel);
  const outputs = [out, report].filter((it) => it !== undefined);
  refuseClash(outputs, models);
  const told = await withPool(workers, async (pool) => {
    const all = await resolve(pool, settings);
    const [gcodeOut, reportOut] = [maybe(out), maybe(report)];
    const progress = progressBar(process.stderr);
    try {
      const found = await pool.unpack(sources);
      await pool.open(found);
      const placed = await scaled(pool, found.length, scale, all);
      const standing = { ...(await standingOf(pool, found, settings, own)), ...placed };
      const gcode = await pool.slice({ settings: all, standing, progress: progress.show });
      const target = gcodeOut ?? new Output(gcode.joined.fileName);
      target.write(partsOf(gcode));
      reportOut?.write([gcode.joined.report, '\n']);
      target.finish();
      reportOut?.finish();
      const file = out === undefined ? [`wrote ${gcode.joined.fileName}`] : [];
      return [...remarkLines(gcode.joined.report), ...file];
    } finally {
      progress.clear();
    }
  });
  process.stderr.write(told.map((line) => `foothold: ${line}\n`).join(''));
}

export async function place({ models, out, settings, scale }: Of<'place'>): Promise<void> {
  const sources = models.map(openModel);
  refuseClash([out], models);
  await withPool(1, async (pool) => {
    const all = await resolve(pool, settings);
    const target = new Output(out);
    const { inspections } = await pool.open(await pool.unpack(sources));
    target.write([await pool.stl(all, await scaled(pool, inspections.length, scale, all))]);
    target.finish();
  });
}

/** All open models so many times as large, side by side; undefined leaves that to the engine. */
async function scaled(
  pool: Pool,
  count: number,
  scale: number | undefined,
  settings: string,
): Promise<Standing | undefined> {
  if (scale === undefined) return undefined;
  const models = Array.from({ length: count }, (_, k) => k);
  const edit = { kind: 'scale', factors: [scale, scale, scale] } as const;
  const parts = await Promise.all(
    models.map(async (model) => placedPart(model, model, await pool.edit(model, UNMOVED, edit))),
  );
  const matrices = parts.flatMap(({ matrix }) => matrix);
  const boxes = parts.flatMap(({ box }) => box);
  return { models, placements: [...(await pool.arrange(matrices, boxes, settings))] };
}

export async function inspect({ model, report }: Of<'inspect'>): Promise<void> {
  const source = openModel(model);
  refuseClash(report === undefined ? [] : [report], [model]);
  await withPool(1, async (pool) => {
    const reportOut = maybe(report);
    if (isGcode(source)) {
      const { figures } = await pool.gcode(source, await pool.settings([], []));
      reportOut?.write([figures, '\n']);
      reportOut?.finish();
      if (report !== '-') new Output('-').write([gcodeInWords(figures)]);
      return;
    }
    const { inspections } = await pool.open(await pool.unpack([source]));
    // A file of several parts has as many inspections.
    reportOut?.write([inspections.length === 1 ? (inspections[0] ?? '{}') : `[${inspections.join(',')}]`, '\n']);
    reportOut?.finish();
    if (report !== '-') new Output('-').write([inspections.map(inWords).join('\n')]);
  });
}

export async function draw({ model, what, out, settings }: Of<'draw'>): Promise<void> {
  const source = openModel(model);
  refuseClash([out], [model]);
  await withPool(1, async (pool) => {
    const all = await resolve(pool, settings);
    const target = new Output(out);
    await pool.open(await pool.unpack([source]));
    target.write([await pool.draw(all, what)]);
    target.finish();
  });
}

export function orient(command: Weighing): Promise<void> {
  return weigh(command, (pool, settings, progress) => pool.orient({ settings, progress }), directionTable);
}

export function compare(command: Weighing): Promise<void> {
  return weigh(command, (pool, all) => pool.compare(all), adhesionTable);
}

/** Opens the model, asks the engine to weigh possibilities, and shows them as a table. */
async function weigh(
  { model, settings: words, report, workers }: Weighing,
  ask: (pool: Pool, settings: string, progress: (progress: Progress) => void) => Promise<string>,
  table: (figures: string) => string,
): Promise<void> {
  const source = openModel(model);
  refuseClash(report === undefined ? [] : [report], [model]);
  await withPool(workers, async (pool) => {
    const all = await resolve(pool, words);
    const reportOut = maybe(report);
    await pool.open(await pool.unpack([source]));
    const progress = progressBar(process.stderr);
    const figures = await ask(pool, all, progress.show).finally(progress.clear);
    reportOut?.write([figures, '\n']);
    reportOut?.finish();
    if (report !== '-') new Output('-').write([table(figures)]);
  });
}

export async function settings({ settings: words, schema }: Of<'settings'>): Promise<void> {
  const text = schema
    ? readFileSync(new URL('./settings.schema.json', import.meta.url), 'utf8')
    : await withPool(1, async (pool) => JSON.stringify(JSON.parse(await resolve(pool, words)), undefined, 2));
  new Output('-').write([`${text.trimEnd()}\n`]);
}

export function profiles(): void {
  new Output('-').write([profileTable()]);
}

/** Writes what was taken over as a settings file, and says what became of each value. */
export async function importProfile({ file, out }: Of<'import'>): Promise<void> {
  const profile = readProfile(file);
  refuseClash(out === undefined ? [] : [out], [file]);
  let found: Imported;
  try {
    found = await importedFrom(profile, loadFiles);
  } catch (error) {
    throw new FileError(file, error instanceof Error ? error.message : String(error), 2);
  }
  const target = maybe(out);
  target?.write([`${JSON.stringify(found.settings, undefined, 2)}\n`]);
  target?.finish();
  if (out !== '-') new Output('-').write([importTable(found)]);
}

function readProfile(file: string): Uint8Array {
  try {
    return readFileSync(file);
  } catch (error) {
    throw new FileError(file, `can't be read: ${reasonOf(error)}`, 2);
  }
}

/** Standard output for one thing only, and never a model's own file. */
function refuseClash(outputs: readonly string[], models: readonly string[]): void {
  if (new Set(outputs).size < outputs.length) throw new UsageError(`${outputs[0]} can't hold two outputs`);
  const inputs = new Set(models.map((model) => realpathSync(model)));
  const clash = outputs.find((out) => inputs.has(realPath(out)));
  if (clash !== undefined) throw new UsageError(`${clash} is the model itself`);
}

function realPath(file: string): string {
  try {
    return realpathSync(file);
  } catch {
    return file;
  }
}

const maybe = (name: string | undefined): Output | undefined => (name === undefined ? undefined : new Output(name));

async function withPool<T>(workers: number, work: (pool: Pool) => Promise<T>): Promise<T> {
  const pool = new Pool(nodeLanes(), workers);
  try {
    return await work(pool);
  } finally {
    pool.close();
  }
}

/** Profiles, then files, then single values. A file may choose profiles itself; those named here win. */
function resolve(pool: Pool, words: SettingWords): Promise<string> {
  const files = words.files.map(readSettings);
  const layers = Object.assign({}, ...files.map((it) => it.profiles), words.profiles) as Layers;
  const changes = files.map((it) => JSON.stringify(it.settings));
  return pool.settings([...settingsFiles(layers), ...changes], words.sets);
}

/** Every model once, to be arranged, with the settings that are its own; the files name models as --set-for does. */
async function standingOf(
  pool: Pool,
  sources: readonly ModelSource[],
  words: SettingWords,
  own: readonly OwnWord[],
): Promise<Standing> {
  const files = words.files.flatMap((file) => Object.entries(readSettings(file).models));
  const isNamed = (name: string, source: ModelSource): boolean => name === source.name || name === stem(source.name);
  for (const name of [...files.map(([name]) => name), ...own.map(({ model }) => model)]) {
    if (sources.some((source) => isNamed(name, source))) continue;
    throw new UsageError(`there is no model "${name}": there are ${sources.map(({ name }) => stem(name)).join(', ')}`);
  }
  const ownOf = (source: ModelSource): Promise<string> =>
    pool.own(
      files.filter(([name]) => isNamed(name, source)).map(([, settings]) => JSON.stringify(settings)),
      own.filter(({ model }) => isNamed(model, source)).map(({ set }) => set),
    );
  return { models: [...sources.keys()], placements: [], own: await Promise.all(sources.map(ownOf)) };
}

function readSettings(file: string): SavedSettings {
  let text: string;
  try {
    text = readFileSync(file, 'utf8');
  } catch (error) {
    throw new FileError(file, `can't be read: ${reasonOf(error)}`, 2);
  }
  const said = (error: unknown): string => (error instanceof Error ? error.message : String(error));
  let found: SavedSettings;
  try {
    found = parseSaved(text);
  } catch (error) {
    const what = error instanceof SyntaxError ? 'not JSON: ' : '';
    throw new FileError(file, `${what}${said(error)}`, 2);
  }
  for (const [kind, id] of Object.entries(found.profiles)) {
    if (!ids(kind as Kind).includes(id)) throw new FileError(file, `there is no ${kind} profile "${id}"`, 2);
  }
  return found;
}
