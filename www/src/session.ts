// The flow of work, as plain functions over the state: open, place, slice, cancel, show, download.
import { type Imported, importProfile, isGcode, readGcode, stem } from './files/files.ts';
import { loadFiles } from './files/load.ts';
import type { GcodeFigures } from './generated/gcode-figures.ts';
import type { OrientationReport, Report } from './generated/report.ts';
import { planOf, redone, undone } from './history.ts';
import { t } from './i18n/text.ts';
import type { Kept } from './keep.ts';
import { placeIn } from './lesson/steps.ts';
import type { Edit, ModelSource, Up } from './messages.ts';
import { asStanding, atFreeSpot, freeId, movedTo, type Part, standing, UNMOVED } from './parts.ts';
import { settingsFiles } from './profiles/catalog.ts';
import { besideForm, flattened } from './profiles/choice.ts';
import { parseSaved, type SavedSettings } from './profiles/layers.ts';
import { asChanges, asSettings, type Changes, same, withChange } from './settings/changes.ts';
import type { Value } from './settings/fields.ts';
import { ofModels, withModels } from './settings/of-models.ts';
import { ownGroups } from './settings/own.ts';
import { allFields, roomOf } from './settings/room.ts';
import { EngineError, isCancel } from './slicer/errors.ts';
import { partsOf } from './slicer/gcode.ts';
import type { Opened, Pool } from './slicer/pool.ts';
import { filesUrl } from './slicer/threads.ts';
import { fetched, lastPart, namedModel, SAMPLE } from './source.ts';
import {
  type ModelFacts,
  noPlan,
  type OpenModel,
  type Problem,
  type Remark,
  type State,
  type Step,
  type Store,
} from './state.ts';
import type { Lesson, LessonStep, Question } from './studies.ts';
import { canDrawSpace } from './view/webgl.ts';

/** Faces to choose from that lie on the bed, besides the six sides of a box. */
const FACES = 12;

export class Session {
  readonly #store: Store;
  readonly #pool: Pool;
  #job: AbortController | undefined;
  /** Changes of the parts, one after another: each looks at what the one before left. */
  #edits: Promise<unknown> = Promise.resolve();

  constructor(store: Store, pool: Pool) {
    this.#store = store;
    this.#pool = pool;
    let ground = groundOf(store.state.changes);
    store.listen(({ changes }) => {
      const now = groundOf(changes);
      if (now === ground) return;
      ground = now;
      // That follows from the settings: it is undone with them.
      if (store.state.arranged) void this.#edit(this.#arrangement, 'follows');
    });
  }

  /** Opens what the page's address names, or what was open last, or the sample; the sample is sliced at once. */
  async start(address: string, kept: Kept | undefined): Promise<void> {
    try {
      const linked = placeIn(address);
      if (linked !== undefined) this.#store.update(linked);
      const named = namedModel(address) ?? (linked === undefined ? undefined : SAMPLE);
      if (named !== undefined) {
        await this.#open([await fetched(named, lastPart(named))], this.#store.state.step);
        if (linked !== undefined) this.#store.update({ step: 'learn' });
        return;
      }
      // The visitor may be at another step by now, and stays there.
      if (kept !== undefined) await this.#open(kept.sources, this.#store.state.step, kept);
      if (this.#store.state.model.kind === 'open') return;
      await this.#open([await fetched(SAMPLE, SAMPLE)], this.#store.state.step);
      await this.#slice(() => this.#store.state.step);
    } catch (error) {
      this.#store.update({ model: { kind: 'failed', problem: problemOf(error) } });
    }
  }

  /**
   * Opens models instead of those that were open; a job under way is cancelled. Those that were open come back when
   * the new ones can't be read.
   */
  async open(sources: readonly ModelSource[]): Promise<void> {
    const before = this.#store.state;
    await this.#open(sources, 'prepare');
    const { model } = this.#store.state;
    if (model.kind !== 'failed' || before.model.kind !== 'open') return;
    const isCurrent = (): boolean => this.#store.state.model === model;
    await this.#pool.open(before.model.models.map(({ source }) => source)).catch(() => undefined);
    const { parts, arranged, selected, history, result } = before;
    const job = { kind: result === undefined ? 'idle' : 'done' } as const;
    const plan = { model: before.model, parts, arranged, selected, history, result, job };
    if (isCurrent()) this.#store.update({ ...plan, trouble: model.problem });
  }

  /**
   * Opens models instead of those that were open, which don't come back. Whoever is at another step before the first
   * ones are there stays at it.
   */
  replace(sources: readonly ModelSource[]): Promise<void> {
    const { model, step } = this.#store.state;
    return this.#open(sources, model.kind === 'none' ? step : 'prepare');
  }

  async #open(sources: readonly ModelSource[], step: Step, kept?: Kept): Promise<void> {
    const [source] = sources;
    if (source === undefined) return;
    if (isGcode(source)) return this.#showGcode(source);
    this.#job?.abort();
    this.#job = undefined;
    this.#store.update({
      model: { kind: 'reading', source },
      job: { kind: 'idle' },
      result: undefined,
      step,
      ...noPlan,
    });
    const isCurrent = (): boolean => {
      const { model } = this.#store.state;
      return model.kind === 'reading' && model.source === source;
    };
    try {
      const all = await this.#pool.unpack(sources);
      if (!isCurrent()) return;
      const models = openModels(all, await this.#pool.open(all));
      const parts = kept?.parts ?? (await this.#arranged(await this.#standing(models.map((_, model) => model))));
      const [first] = models;
      if (!isCurrent() || first === undefined) return;
      this.#store.update({
        model: { kind: 'open', ...first, models },
        ...noPlan,
        parts,
        arranged: kept?.arranged ?? true,
      });
    } catch (error) {
      if (isCurrent()) this.#store.update({ model: { kind: 'failed', problem: problemOf(error) } });
    }
  }

  /** Shows a G-code file of any slicer in Preview; models that are open stay so. */
  async #showGcode(source: ModelSource): Promise<void> {
    const { update } = this.#begin();
    try {
      // The lanes of a job that was cancelled end in a moment: what is asked before would end with them.
      await new Promise((resolve) => setTimeout(resolve));
      const settings = await this.#settings();
      const gcode = await readGcode(source, (it) => this.#pool.gcode(it, settings));
      const found = JSON.parse(gcode.joined.report) as GcodeFigures;
      const { changes, parts } = this.#store.state;
      update({
        job: { kind: 'done' },
        result: {
          gcode,
          report: { ...found, by_role: { ...found.by_role }, model: { bounds: found.bounds } },
          settings: await this.#pool.settings([settings], [`filament.diameter=${found.filament.diameter_mm}`]),
          changes,
          parts,
        },
        layer: canDrawSpace() && !this.#store.state.flat ? gcode.layers.length - 1 : 0,
        step: 'preview',
      });
    } catch (error) {
      update({ job: { kind: 'failed', problem: problemOf(error) } });
    }
  }

  /** Opens models beside those that are open. */
  async add(sources: readonly ModelSource[]): Promise<void> {
    const [gcode] = sources.filter(isGcode);
    if (gcode !== undefined) return this.#showGcode(gcode);
    if (this.#store.state.model.kind !== 'open') return this.open(sources);
    await this.#edit(async ({ model, parts, arranged, changes }) => {
      if (model.kind !== 'open') return {};
      const more = await this.#pool.unpack(sources);
      const opened = await this.#pool.add(more);
      const models = openModels([...model.models.map((it) => it.source), ...more], opened);
      const added = await this.#standing(
        more.map((_, k) => model.models.length + k),
        freeId(parts),
      );
      const all = arranged ? await this.#arranged([...parts, ...added]) : withAdded(parts, added, roomOf(changes));
      return { model: { ...model, models }, parts: all, selected: added[0]?.id, step: 'prepare' };
    });
  }

  select(selected: number | undefined): void {
    // What is chosen can be dragged.
    if (this.#store.state.frame === 'locked') return;
    if (selected !== this.#store.state.selected) this.#store.update({ selected });
  }

  /** Turns, scales, mirrors, lays flat or drops a part. */
  async change(id: number, edit: Edit): Promise<void> {
    await this.#edit(async ({ parts }) => {
      const part = parts.find((it) => it.id === id);
      if (part === undefined) return {};
      const stand = await this.#pool.edit(part.model, part.matrix, edit);
      return { parts: replaced(parts, { ...part, ...standing(id, part.model, stand) }), arranged: false };
    });
  }

  /** Changes every part in the same way, or those of one model, and arranges them. */
  async changeAll(edit: Edit, model?: number): Promise<void> {
    await this.#edit(async ({ parts }) => {
      const changed = parts.map(async (part) => {
        if (model !== undefined && part.model !== model) return part;
        const stand = await this.#pool.edit(part.model, part.matrix, edit);
        return { ...part, ...standing(part.id, part.model, stand) };
      });
      return { parts: await this.#arranged(await Promise.all(changed)), arranged: false };
    });
  }

  /** Changes every part so that the job can be done, and slices. */
  async mend(edit: Edit): Promise<void> {
    await this.changeAll(edit);
    await this.slice();
  }

  /** Moves all parts out of the bed's forbidden zones, and slices. */
  async moveAside(): Promise<void> {
    await this.#edit(async ({ parts, changes }) => {
      const zones = changes['printer.forbidden'] ?? [];
      const blocks = (Array.isArray(zones) ? (zones as unknown as number[][]) : []).map(
        ([x0 = 0, y0 = 0, x1 = 0, y1 = 0]): Part => ({ id: 0, model: 0, matrix: UNMOVED, box: [x0, y0, 0, x1, y1, 0] }),
      );
      const clear = withAdded(blocks, parts, roomOf(changes));
      return { parts: clear.slice(blocks.length), arranged: false };
    });
    await this.slice();
  }

  /** Hands the parts as they stand to the browser as one STL. */
  async exportStl(): Promise<void> {
    await this.#edit(async ({ model, parts, arranged }) => {
      if (model.kind !== 'open') return {};
      const stl = await this.#pool.stl(await this.#settings(), asStanding(parts, arranged));
      saveFile(new Blob([stl], { type: 'model/stl' }), `${stem(model.source.name)}_placed.stl`);
      return {};
    });
  }

  /** Moves a part's middle to a point of the bed, mm. */
  async moveTo(id: number, x: number, y: number): Promise<void> {
    await this.#edit(async ({ parts }) => {
      const part = parts.find((it) => it.id === id);
      return part === undefined ? {} : { parts: replaced(parts, movedTo(part, x, y)), arranged: false };
    });
  }

  /** Gives a part settings of its own instead of those it has. */
  async giveOwn(id: number, own: Changes): Promise<void> {
    await this.#edit(async ({ parts, arranged }) => {
      const part = parts.find((it) => it.id === id);
      if (part === undefined) return {};
      const all = replaced(parts, { ...part, own });
      return { parts: arranged ? await this.#arranged(all) : all };
    });
  }

  async duplicate(id: number): Promise<void> {
    await this.#edit(async ({ parts, arranged, changes }) => {
      const part = parts.find((it) => it.id === id);
      if (part === undefined) return {};
      const copy = { ...part, id: freeId(parts) };
      const all = arranged ? await this.#arranged([...parts, copy]) : withAdded(parts, [copy], roomOf(changes));
      return { parts: all, selected: copy.id };
    });
  }

  async remove(id: number): Promise<void> {
    await this.#edit(async ({ parts, arranged }) => {
      const left = parts.filter((it) => it.id !== id);
      return { parts: arranged ? await this.#arranged(left) : left, selected: left.at(-1)?.id };
    });
  }

  /** Stands all parts side by side. */
  async arrange(): Promise<void> {
    await this.#edit(this.#arrangement);
  }

  #arrangement = async ({ parts }: State): Promise<Partial<State>> => ({ parts: await this.#arranged(parts) });

  undo(): void {
    const { state } = this.#store;
    if (state.frame === 'locked') return;
    const change = undone(state.history, planOf(state));
    if (change !== undefined) this.#store.update({ ...change, trouble: undefined });
  }

  redo(): void {
    const { state } = this.#store;
    if (state.frame === 'locked') return;
    const change = redone(state.history, planOf(state));
    if (change !== undefined) this.#store.update({ ...change, trouble: undefined });
  }

  /** Slices the parts with the settings of the form, and goes on to Preview. */
  slice(): Promise<void> {
    return this.#slice(() => 'preview');
  }

  /** Begins a job and ends the one before, whose updates do not count any more. */
  #begin(): { signal: AbortSignal; update: (change: Partial<State>) => void } {
    this.#job?.abort();
    const job = new AbortController();
    this.#job = job;
    const update = (change: Partial<State>): void => {
      if (this.#job === job) this.#store.update(change);
    };
    update({ job: { kind: 'running', progress: { stage: 'read', done: 0, total: 0 } } });
    return { signal: job.signal, update };
  }

  async #slice(next: () => Step): Promise<void> {
    if (this.#store.state.model.kind !== 'open') return;
    const { signal, update } = this.#begin();
    try {
      const sliced = await this.#sliced(signal, (progress) => update({ job: { kind: 'running', progress } }));
      update({ ...sliced, step: next() });
    } catch (error) {
      update({ job: isCancel(error) ? { kind: 'cancelled' } : { kind: 'failed', problem: problemOf(error) } });
    } finally {
      // After a cancel or a crash a new lead reads the models again while nobody waits for it.
      this.#pool.ready().catch(() => undefined);
    }
  }

  /**
   * Takes settings from a file instead of those of the form; the engine says what is wrong with them. A profile of
   * another slicer keeps the chosen printer and what else it does not speak of.
   */
  async importSettings(file: File): Promise<void> {
    await this.#edit(async ({ changes, parts, model }) => {
      const content = new Uint8Array(await file.arrayBuffer());
      const own = ownSettings(content);
      const found = own === undefined ? await importProfile(content, () => loadFiles(filesUrl)) : undefined;
      const below = own === undefined ? [asSettings(changes)] : settingsFiles(own.profiles);
      const above = JSON.stringify(own?.settings ?? found?.settings ?? {});
      const all = JSON.parse(await this.#pool.settings([...below, above], [])) as object;
      const plate = { ...asChanges(all, allFields), ...besideForm(all) };
      const given = withModels(parts, filesOf(model), await this.#ownChanges(own?.models ?? {}, plate));
      const settingsNotes = found === undefined ? leftOut(given.unknown) : notesOf(found, file.name);
      return { changes: plate, parts: given.parts, settingsNotes };
    });
  }

  /** Hands the settings to the browser as a file, with those that single models have of their own. */
  exportSettings(): void {
    const { changes, parts, model } = this.#store.state;
    const { models, unlike } = ofModels(parts, filesOf(model));
    const plate = JSON.parse(asSettings(changes)) as object;
    const all = Object.keys(models).length === 0 ? plate : { ...plate, models };
    saveFile(new Blob([`${JSON.stringify(all, null, 2)}\n`], { type: 'application/json' }), 'foothold-settings.json');
    this.#store.update({ settingsNotes: leftOut(unlike) });
  }

  /** Asks the engine about the open models with the settings of the form; the answer is JSON. */
  async study<T>(question: Question): Promise<T> {
    const settings = await this.#settings();
    const { parts, arranged } = this.#store.state;
    return JSON.parse(await this.#pool.study(settings, question, asStanding(parts, arranged))) as T;
  }

  /** The steps of a lesson on the open model; the one about orientation compares the six directions first. */
  async lesson(lesson: Lesson, at: string, side: number, dark: boolean): Promise<readonly LessonStep[]> {
    if (lesson !== 'orientation') return await this.study({ about: 'lesson', lesson, at, side, dark });
    const settings = await this.#settings({ 'orientation.hull_directions': 0 });
    await this.#pool.orient({ settings });
    return await this.study({ about: 'orientation', side, dark });
  }

  /** Compares the directions of the first model; undefined when `signal` ends it. */
  async orient(
    signal: AbortSignal,
    progress: (done: number, total: number) => void,
  ): Promise<OrientationReport | Problem | undefined> {
    try {
      const settings = await this.#settings();
      const report = await this.#pool.orient({
        settings,
        signal,
        progress: ({ done, total }) => progress(done, total),
      });
      return JSON.parse(report) as OrientationReport;
    } catch (error) {
      return isCancel(error) ? undefined : problemOf(error);
    } finally {
      this.#pool.ready().catch(() => undefined);
    }
  }

  /** Ways up of a model that lay its largest faces on the bed. */
  async faces(model: number): Promise<readonly Up[]> {
    return await this.#pool.faces(model, await this.#settings({ 'orientation.hull_directions': FACES }));
  }

  /** A model, or the first, with `up` turned up. */
  async thumbnail(up: readonly number[], width: number, height: number, model = 0): Promise<ImageData> {
    const pixels = await this.#pool.thumbnail(up, width, height, model);
    return new ImageData(new Uint8ClampedArray(pixels), width, height);
  }

  cancel(): void {
    this.#job?.abort();
  }

  /** Hands the G-code to the browser as a file. */
  download(): void {
    const { result } = this.#store.state;
    if (result === undefined) return;
    saveFile(new Blob(partsOf(result.gcode), { type: 'text/x.gcode' }), result.gcode.joined.fileName);
  }

  /** Takes over the settings that a remark proposes, as `path=value` with the value in JSON, and slices again. */
  async fix(settings: readonly string[]): Promise<void> {
    const mended = (changes: Changes, it: string): Changes => {
      const at = it.indexOf('=');
      const field = allFields.find(({ path }) => path === it.slice(0, at));
      return field === undefined ? changes : withChange(changes, field, JSON.parse(it.slice(at + 1)) as Value);
    };
    this.#store.update({ changes: settings.reduce(mended, this.#store.state.changes) });
    await this.slice();
  }

  showLayer(layer: number): void {
    const { result, step } = this.#store.state;
    if (result === undefined) return;
    const last = result.gcode.layers.length - 1;
    this.#store.update({ step: step === 'prepare' ? 'preview' : step, layer: Math.min(Math.max(layer, 0), last) });
  }

  /** Settings of single models as the engine reads them, as far as the plate does not have them. */
  async #ownChanges(models: SavedSettings['models'], plate: Changes): Promise<Record<string, Changes>> {
    const defaults = new Map(
      ownGroups(plate).flatMap(({ fields }) => fields.map((it) => [it.path, it.default] as const)),
    );
    const changes: Record<string, Changes> = {};
    for (const [name, settings] of Object.entries(models)) {
      const found = flattened(JSON.parse(await this.#pool.own([JSON.stringify(settings)], [])) as object);
      changes[name] = Object.fromEntries(Object.entries(found).filter(([path, it]) => !same(it, defaults.get(path))));
    }
    return changes;
  }

  /** All settings of the form as JSON, with what else is to be changed. */
  #settings(changes: Changes = {}): Promise<string> {
    return this.#pool.settings([asSettings({ ...this.#store.state.changes, ...changes })], []);
  }

  async #sliced(
    signal: AbortSignal,
    progress: NonNullable<Parameters<Pool['slice']>[0]['progress']>,
  ): Promise<Partial<State>> {
    const { changes, parts, arranged } = this.#store.state;
    const settings = await this.#settings();
    const gcode = await this.#pool.slice({ settings, standing: asStanding(parts, arranged), signal, progress });
    const report = JSON.parse(gcode.joined.report) as Report;
    // In space all layers are seen at once; flat the first is the one to look at.
    const layer = canDrawSpace() && !this.#store.state.flat ? gcode.layers.length - 1 : 0;
    return { job: { kind: 'done' }, result: { gcode, report, sliced: report, settings, changes, parts }, layer };
  }

  /**
   * Runs a change of the parts after those before it; what it cannot do is said beside the parts. One that follows
   * from another is no step of its own to be undone.
   */
  #edit(change: (state: State) => Promise<Partial<State>>, kind: 'step' | 'follows' = 'step'): Promise<void> {
    const edit = async (): Promise<void> => {
      if (this.#store.state.frame === 'locked') return;
      try {
        const changed = { ...(await change(this.#store.state)), trouble: undefined };
        const { history } = this.#store.state;
        this.#store.update(kind === 'step' ? changed : { ...changed, history });
      } catch (error) {
        this.#store.update({ trouble: problemOf(error) });
      }
    };
    const done = this.#edits.then(edit);
    this.#edits = done;
    return done;
  }

  /** Models as they are in their files, as parts numbered from `id`. */
  async #standing(models: readonly number[], id = 1): Promise<Part[]> {
    const stands = await Promise.all(models.map((model) => this.#pool.edit(model, UNMOVED)));
    return stands.map((stand, k) => standing(id + k, models[k] ?? 0, stand));
  }

  /** The parts side by side in the middle of the bed; each in its middle when there is no room for all. */
  async #arranged(parts: readonly Part[]): Promise<readonly Part[]> {
    const { changes } = this.#store.state;
    const settings = await this.#settings();
    const boxes = parts.flatMap(({ box }) => box);
    const matrices = await this.#pool
      .arrange(
        parts.flatMap(({ matrix }) => matrix),
        boxes,
        settings,
        asStanding(parts, true).own,
      )
      .catch((error: unknown) => {
        if (error instanceof EngineError && error.name === 'FitError') return undefined;
        throw error;
      });
    if (matrices === undefined) return withAdded([], await this.#dropped(parts), roomOf(changes));
    const stands = parts.map(({ model }, k) => this.#pool.edit(model, [...matrices.subarray(16 * k, 16 * k + 16)]));
    return (await Promise.all(stands)).map((stand, k) => ({ ...standing(0, 0, stand), ...named(parts[k]) }));
  }

  async #dropped(parts: readonly Part[]): Promise<Part[]> {
    const stands = parts.map(({ model, matrix }) => this.#pool.edit(model, matrix, { kind: 'drop' }));
    return (await Promise.all(stands)).map((stand, k) => ({ ...standing(0, 0, stand), ...named(parts[k]) }));
  }
}

/** All that the engine arranges parts by, as text. */
function groundOf(changes: Changes): string {
  const spacing = /^(print\.|printer\.extruder_clearance|adhesion\.|first_layer\.line_width)/;
  return JSON.stringify([roomOf(changes), Object.entries(changes).filter(([path]) => spacing.test(path))]);
}

/** Settings in our own form; undefined when they are another program's. */
function ownSettings(content: Uint8Array): SavedSettings | undefined {
  try {
    const found = parseSaved(new TextDecoder('utf-8', { fatal: true }).decode(content));
    const groups = Object.values(found.settings);
    // Other slicers' JSON holds words and lists, ours holds groups.
    return groups.every((it) => typeof it === 'object' && it !== null && !Array.isArray(it)) ? found : undefined;
  } catch (error) {
    // What is not JSON is perhaps another slicer's; JSON of ours with a fault is told.
    if (error instanceof SyntaxError || error instanceof TypeError) return undefined;
    throw error;
  }
}

/** That settings of single models were left out: no open model is called so, or its parts differ. */
function leftOut(names: readonly string[]): readonly string[] {
  return names.length === 0 ? [] : [t.profiles.ofModels(names.join(', '))];
}

/** The names of the open models' files. */
function filesOf(model: State['model']): readonly string[] {
  return model.kind === 'open' ? model.models.map(({ source }) => source.name) : [];
}

/** What became of another slicer's profile. */
function notesOf({ mapped, changed, unknown }: Imported, name: string): readonly string[] {
  const taken = mapped.length + changed.filter((it) => it.path !== undefined).length;
  return [
    t.profiles.imported(name, taken),
    ...changed.map(({ key, why }) => `${key}: ${why ?? ''}`),
    ...(unknown.length === 0 ? [] : [t.profiles.unknown(unknown.map(({ key }) => key).join(', '))]),
  ];
}

export function problemOf(error: unknown): Problem {
  const known = error instanceof EngineError || (error instanceof Error && error.name in t.problem);
  const fix = error instanceof EngineError && error.fix !== undefined ? { fix: JSON.parse(error.fix) as Edit } : {};
  const file = error instanceof EngineError && error.source !== undefined ? { file: error.source } : {};
  return {
    name: known ? (error as Error).name : 'InternalError',
    message: error instanceof Error ? error.message : String(error),
    ...fix,
    ...file,
  };
}

/** Hands a file to the browser. */
export function saveFile(content: Blob, name: string): void {
  const address = URL.createObjectURL(content);
  const link = document.createElement('a');
  link.href = address;
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(address), 60_000);
}

/** All of a part but where it stands. */
function named(part: Part | undefined): Omit<Part, 'matrix' | 'box'> {
  const { id = 0, model = 0, own } = part ?? {};
  return own === undefined ? { id, model } : { id, model, own };
}

function replaced(parts: readonly Part[], part: Part): readonly Part[] {
  return parts.map((it) => (it.id === part.id ? part : it));
}

/** Parts added to others, each at a free spot. */
function withAdded(parts: readonly Part[], added: readonly Part[], room: ReturnType<typeof roomOf>): readonly Part[] {
  const all = [...parts];
  for (const part of added) all.push(atFreeSpot(part, all, room));
  return all;
}

function openModels(sources: readonly ModelSource[], { inspections }: Opened): readonly OpenModel[] {
  return sources.map((source, k) => ({ source, facts: factsOf(inspections[k] ?? '{}') }));
}

/** What the page shows of the engine's inspection. */
function factsOf(inspection: string): ModelFacts {
  const found = JSON.parse(inspection) as {
    triangles: number;
    bounds: { min: number[]; max: number[] } | number[][];
    volume_mm3: number;
    warnings?: Remark[];
  };
  const [min = [], max = []] = Array.isArray(found.bounds) ? found.bounds : [found.bounds.min, found.bounds.max];
  return {
    triangles: found.triangles,
    size: max.map((high, k) => high - (min[k] ?? 0)),
    volume_mm3: found.volume_mm3,
    warnings: found.warnings ?? [],
  };
}
