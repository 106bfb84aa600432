// Runs a job over several lanes; used by the page and by the command line. The lead lane holds the models and
// the job; helper lanes slice the ranges of layers that the lead prepares for them. What comes out does not
// depend on how many lanes there are or on which of them sliced what.
import { isForeign, refuseTooLargeTogether } from '../files/files.ts';
import type {
  Bounds,
  CameraNumbers,
  Edit,
  Evaluation,
  GcodeIndex,
  ModelSource,
  PictureView,
  Range,
  Shape,
  SlicedRange,
  Standing,
  Theme,
  Up,
} from '../messages.ts';
import type { Question } from '../studies.ts';
import { EngineError } from './errors.ts';
import type { Gcode } from './gcode.ts';
import type { HelperLane, LeadLane } from './lane.ts';

/** Makes lanes; the two places that run a pool make them differently. */
export interface LaneMaker {
  lead(): LeadLane;
  helper(): HelperLane;
}

export type Stage = 'read' | 'orient' | 'prepare' | 'layers' | 'join';

/** How far a job is; `done` of `total` directions in the stage "orient", of layers in "layers". */
export interface Progress {
  readonly stage: Stage;
  readonly done: number;
  readonly total: number;
}

export interface JobOptions {
  /** All settings, as JSON. */
  readonly settings: string;
  readonly signal?: AbortSignal;
  readonly progress?: (progress: Progress) => void;
}

export interface SliceOptions extends JobOptions {
  /** Where the models stand; without it each open model is there once, and the engine arranges them. */
  readonly standing?: Standing | undefined;
}

export interface Opened {
  /** One inspection (JSON) per model. */
  readonly inspections: readonly string[];
  readonly parse_ms: number;
}

/** Layers in a range for a helper: its share is small beside its work, and many ranges even out the lanes. */
const HELPER_LAYERS = 24;
/** The lead takes fewer, so that a helper that waits for its share does not wait long. */
const LEAD_LAYERS = 16;
/** Towards the end ranges shrink to this share of what is left, so that no engine works on long alone. */
const LAST_SHARE = 1 / 6;
/** But not below this: every range cuts its neighbours' layers as well. */
const SMALLEST_RANGE = 4;
/** Ranges under way for one helper, so that it does not stand still while the lead is busy. */
const RANGES_PER_HELPER = 2;

export class Pool {
  readonly #make: LaneMaker;
  readonly #workers: number;
  #sources: readonly ModelSource[] = [];
  #lead: LeadLane | undefined;
  #loaded: Promise<Opened> | undefined;
  readonly #helpers = new Set<HelperLane>();
  #pictured: LeadLane | undefined;
  #generation = 0;

  /** `workers` engines in all, the lead included. */
  constructor(make: LaneMaker, workers: number) {
    this.#make = make;
    this.#workers = workers;
  }

  /** Reads models into a lead; they stay open until others are. */
  open(sources: readonly ModelSource[]): Promise<Opened> {
    this.#drop();
    this.#sources = sources;
    return this.ready();
  }

  /** Reads more models beside the open ones; resolves to the inspections of all. */
  async add(sources: readonly ModelSource[]): Promise<Opened> {
    await this.ready();
    const all = [...this.#sources, ...sources];
    refuseTooLargeTogether(all);
    const keep = this.#sources.length;
    const { inspections, parse_ms } = await this.#guard(this.#someLead().call({ kind: 'open', sources: all, keep }));
    const opened = { inspections, parse_ms };
    this.#sources = all;
    this.#loaded = Promise.resolve(opened);
    return opened;
  }

  /** The models in files of any format, as sources to be opened: STL as they are, others part by part. */
  async unpack(sources: readonly ModelSource[]): Promise<readonly ModelSource[]> {
    refuseTooLargeTogether(sources);
    const models = async (source: ModelSource): Promise<readonly ModelSource[]> => {
      if (!(await isForeign(source))) return [source];
      return (await this.#guard(this.#someLead().call({ kind: 'unpack', source }))).sources;
    };
    return (await Promise.all(sources.map(models))).flat();
  }

  /** The open models as they stand on the bed, in one STL. */
  async stl(settings: string, standing?: Standing): Promise<Uint8Array<ArrayBuffer>> {
    await this.ready();
    return (await this.#guard(this.#someLead().call({ kind: 'stl', settings, standing }))).stl;
  }

  /** Reads a G-code file of any slicer; open models stay. */
  async gcode(source: ModelSource, settings: string): Promise<GcodeIndex> {
    return await this.#guard(this.#someLead().call({ kind: 'gcode', source, settings }));
  }

  /** The triangles of an open model. */
  async shape(model: number): Promise<Shape> {
    await this.ready();
    return this.#guard(this.#someLead().call({ kind: 'shape', model }));
  }

  /** Where a part stands after `edit`, or as `matrix` says: its matrix (16 numbers) and its box (6 numbers). */
  async edit(model: number, matrix: readonly number[], edit?: Edit): Promise<Float64Array> {
    await this.ready();
    const request = { kind: 'edit', model, matrix, ...(edit === undefined ? {} : { edit }) } as const;
    return (await this.#guard(this.#someLead().call(request))).stand;
  }

  /**
   * Placements that stand parts side by side; `boxes` are their boxes as `placements` leave them, `own` their own
   * settings as in a Standing.
   */
  async arrange(
    placements: readonly number[],
    boxes: readonly number[],
    settings: string,
    own: readonly string[] = [],
  ): Promise<Float64Array> {
    const arranged = this.#someLead().call({ kind: 'arrange', placements, boxes, settings, own });
    return (await this.#guard(arranged)).placements;
  }

  /** The models' reading; starts a new lead with them when the last one ended. */
  ready(): Promise<Opened> {
    this.#loaded ??= this.#load();
    return this.#loaded;
  }

  /** All settings as JSON, from settings files and `path=value` words. */
  async settings(files: readonly string[], sets: readonly string[]): Promise<string> {
    return (await this.#guard(this.#someLead().call({ kind: 'settings', files, sets }))).settings;
  }

  /** Own settings of a model as JSON, from settings files and `path=value` words, without those of the plate. */
  async own(files: readonly string[], sets: readonly string[]): Promise<string> {
    return (await this.#guard(this.#someLead().call({ kind: 'own', files, sets }))).settings;
  }

  /** Slices the open models. Rejects with an EngineError, or an AbortError once `signal` says so. */
  slice({ settings, standing, signal, progress }: SliceOptions): Promise<Gcode> {
    return this.#cancellable(this.#slice(settings, standing, progress ?? (() => undefined)), signal);
  }

  /** Begins a job and gives `draw` its lead; for pictures of layers and planes. */
  async draw(settings: string, what: { layer: number } | { plane: string }): Promise<string> {
    await this.ready();
    const lead = this.#someLead();
    await this.#guard(lead.call({ kind: 'begin', settings }));
    await this.#guard(lead.call({ kind: 'prepare' }));
    const request =
      'layer' in what
        ? ({ kind: 'drawLayer', layer: what.layer } as const)
        : ({ kind: 'drawPlane', spec: what.plane } as const);
    const { svg } = await this.#guard(lead.call(request));
    await lead.call({ kind: 'end' });
    return svg;
  }

  /**
   * Which way up the first model needs the least support: an OrientationReport as JSON. Rejects with an
   * EngineError, or an AbortError once `signal` says so.
   */
  orient({ settings, signal, progress }: JobOptions): Promise<string> {
    return this.#cancellable(this.#orient(settings, progress ?? (() => undefined)), signal);
  }

  /** What each kind of base layer comes to: a list of AdhesionReports as JSON. */
  async compare(settings: string): Promise<string> {
    await this.ready();
    const lead = this.#someLead();
    await this.#guard(lead.call({ kind: 'begin', settings }));
    const { report } = await this.#guard(lead.call({ kind: 'compare' }));
    await lead.call({ kind: 'end' });
    return report;
  }

  /** Answers a question about the models as they lie with these settings; a job under way goes on. */
  async study(settings: string, question: Question, standing?: Standing): Promise<string> {
    await this.ready();
    return (await this.#guard(this.#someLead().call({ kind: 'study', settings, question, standing }))).answer;
  }

  /** Ways up that lay a model's largest faces on the bed, the axes first. */
  async faces(model: number, settings: string): Promise<readonly Up[]> {
    await this.ready();
    return (await this.#guard(this.#someLead().call({ kind: 'directions', model, settings, all: true }))).ups;
  }

  /** A model with `up` turned up, as RGBA pixels. */
  async thumbnail(up: readonly number[], width: number, height: number, model: number): Promise<Uint8Array> {
    await this.ready();
    return (await this.#guard(this.#someLead().call({ kind: 'thumbnail', model, up, width, height }))).pixels;
  }

  /** Makes a picture of the parts on the bed, to be painted; resolves to what it covers. */
  async picture(view: PictureView, standing?: Standing): Promise<Bounds> {
    const lead = this.#someLead();
    await this.ready();
    const { bounds } = await this.#guard(lead.call({ kind: 'picture', view, standing }));
    this.#pictured = lead;
    return bounds;
  }

  /** Paints the last picture; undefined when its lead has ended since: ask for the picture again. */
  async paint(camera: CameraNumbers, theme: Theme): Promise<ImageBitmap | undefined> {
    const lead = this.#pictured;
    if (lead === undefined || lead !== this.#lead) return undefined;
    return (await this.#guard(lead.call({ kind: 'paint', camera, theme }))).bitmap;
  }

  /** Ends all lanes. */
  close(): void {
    this.#drop();
    this.#sources = [];
  }

  async #slice(
    settings: string,
    standing: Standing | undefined,
    progress: (progress: Progress) => void,
  ): Promise<Gcode> {
    progress({ stage: 'read', done: 0, total: 0 });
    // This job talks to this lead only: a cancel closes it, and the job ends at its next word.
    const lead = this.#someLead();
    await this.ready();
    const models = new Set(standing?.models ?? this.#sources.keys());
    if (turnsModels(settings)) await this.#turnModels(lead, models, settings, progress);
    progress({ stage: 'prepare', done: 0, total: 0 });
    const { partLayers } = await lead.call({ kind: 'begin', settings, standing });
    const helpers = this.#startHelpers(Math.ceil(partLayers / HELPER_LAYERS) - 1);
    let layers: number;
    let texts: Uint8Array<ArrayBuffer>[];
    try {
      ({ layers } = await lead.call({ kind: 'prepare' }));
      texts = await sliceLayers(lead, helpers, layers, progress);
    } finally {
      this.#closeHelpers(helpers);
    }
    progress({ stage: 'join', done: layers, total: layers });
    const joined = await lead.call({ kind: 'finish' });
    await lead.call({ kind: 'end' });
    return { layers: texts, joined };
  }

  async #orient(settings: string, progress: (progress: Progress) => void): Promise<string> {
    progress({ stage: 'read', done: 0, total: 0 });
    const lead = this.#someLead();
    await this.ready();
    return await this.#compareDirections(lead, { model: 0, settings, all: true }, progress);
  }

  /** Chooses the directions that the job will turn the models by; what can't be turned is the job's to tell. */
  async #turnModels(
    lead: LeadLane,
    models: Iterable<number>,
    settings: string,
    progress: (progress: Progress) => void,
  ): Promise<void> {
    for (const model of models) {
      try {
        await this.#compareDirections(lead, { model, settings, all: false }, progress);
      } catch (error) {
        if (!(error instanceof EngineError) || error.fatal) throw error;
      }
    }
  }

  /** Evaluates the directions of a model in all engines, and lets the lead choose. */
  async #compareDirections(
    lead: LeadLane,
    what: { readonly model: number; readonly settings: string; readonly all: boolean },
    progress: (progress: Progress) => void,
  ): Promise<string> {
    const { ups } = await lead.call({ kind: 'directions', ...what });
    const helpers = this.#startHelpers(ups.length - 1);
    try {
      const figures = await evaluateAll(lead, helpers, what, ups, progress);
      const { model, settings } = what;
      return (await lead.call({ kind: 'choose', model, settings, figures })).report;
    } finally {
      this.#closeHelpers(helpers);
    }
  }

  /** Starts as many engines as are `useful` and allowed; they start while the lead prepares. */
  #startHelpers(useful: number): readonly HelperLane[] {
    const count = Math.max(0, Math.min(this.#workers - 1, useful));
    const helpers = Array.from({ length: count }, () => this.#make.helper());
    for (const helper of helpers) this.#helpers.add(helper);
    return helpers;
  }

  #closeHelpers(helpers: Iterable<HelperLane>): void {
    for (const helper of helpers) {
      helper.close();
      this.#helpers.delete(helper);
    }
  }

  #someLead(): LeadLane {
    this.#lead ??= this.#make.lead();
    return this.#lead;
  }

  async #load(): Promise<Opened> {
    const { inspections, parse_ms } = await this.#guard(
      this.#someLead().call({ kind: 'open', sources: this.#sources, keep: 0 }),
    );
    return { inspections, parse_ms };
  }

  /** The work's result, unless `signal` ends it before. */
  async #cancellable<T>(work: Promise<T>, signal: AbortSignal | undefined): Promise<T> {
    const cancelled = cancellation(signal);
    try {
      return await this.#guard(Promise.race([work, cancelled.promise]));
    } finally {
      cancelled.forget();
    }
  }

  /**
   * Passes a result on. An expected error leaves the lanes as they were; anything else (a cancel, a broken
   * engine) ends those that were there when the work began, so that the next request starts new ones.
   */
  async #guard<T>(work: Promise<T>): Promise<T> {
    const generation = this.#generation;
    try {
      return await work;
    } catch (error) {
      const expected = error instanceof EngineError && !error.fatal;
      if (!expected && generation === this.#generation) this.#drop();
      throw error;
    }
  }

  #drop(): void {
    this.#generation++;
    this.#closeHelpers(this.#helpers);
    this.#lead?.close();
    this.#lead = undefined;
    this.#loaded = undefined;
  }
}

/** The layers that nobody has taken yet, from the first. */
export class LayerQueue {
  readonly #total: number;
  #next = 0;

  constructor(total: number) {
    this.#total = total;
  }

  /** The next layers, `count` or fewer towards the end; undefined when there are none. */
  take(count: number): Range | undefined {
    if (this.#next >= this.#total) return undefined;
    const first = this.#next;
    const fair = Math.max(SMALLEST_RANGE, Math.ceil((this.#total - first) * LAST_SHARE));
    this.#next = Math.min(first + Math.min(count, fair), this.#total);
    return { first, last: this.#next };
  }

  /** Hands out nothing more. */
  stop(): void {
    this.#next = this.#total;
  }
}

async function sliceLayers(
  lead: LeadLane,
  helpers: readonly HelperLane[],
  total: number,
  progress: (progress: Progress) => void,
): Promise<Uint8Array<ArrayBuffer>[]> {
  const texts = new Array<Uint8Array<ArrayBuffer>>(total);
  let done = 0;
  const keep = (range: Range, sliced: SlicedRange): void => {
    layersOf(sliced).forEach((text, k) => {
      texts[range.first + k] = text;
    });
    done += range.last - range.first;
    progress({ stage: 'layers', done, total });
  };
  const queue = new LayerQueue(total);
  const helping = helpers.flatMap((helper) =>
    Array.from({ length: RANGES_PER_HELPER }, () => helperWork(lead, helper, queue, keep)),
  );
  try {
    await Promise.all([leadWork(lead, queue, keep), ...helping]);
  } finally {
    queue.stop();
  }
  return texts;
}

type Keep = (range: Range, sliced: SlicedRange) => void;

async function leadWork(lead: LeadLane, queue: LayerQueue, keep: Keep): Promise<void> {
  for (let range = queue.take(LEAD_LAYERS); range !== undefined; range = queue.take(LEAD_LAYERS)) {
    keep(range, await lead.call({ kind: 'slice', range }));
  }
}

async function helperWork(lead: LeadLane, helper: HelperLane, queue: LayerQueue, keep: Keep): Promise<void> {
  for (let range = queue.take(HELPER_LAYERS); range !== undefined; range = queue.take(HELPER_LAYERS)) {
    const { share } = await lead.call({ kind: 'share', range });
    const { meta, ...sliced } = await helper.call({ kind: 'slice', share }, [share.buffer as ArrayBuffer]);
    await lead.call({ kind: 'add', meta }, [meta.buffer as ArrayBuffer]);
    keep(range, sliced);
  }
}

/** Whether a job with these settings chooses which way up models are printed. */
function turnsModels(settings: string): boolean {
  const { orientation } = JSON.parse(settings) as { orientation?: { mode?: string } };
  return orientation?.mode === 'auto';
}

/** Figures of all directions, in their order, whoever evaluated them. */
async function evaluateAll(
  lead: LeadLane,
  helpers: readonly HelperLane[],
  { model, settings }: { readonly model: number; readonly settings: string },
  ups: readonly Up[],
  progress: (progress: Progress) => void,
): Promise<Uint8Array[]> {
  const figures = new Array<Uint8Array>(ups.length);
  const total = ups.length;
  progress({ stage: 'orient', done: 0, total });
  const left = ups.entries();
  let done = 0;
  const work = async (evaluate: (evaluation: Evaluation) => Promise<{ readonly figures: Uint8Array }>) => {
    for (const [k, up] of left) {
      figures[k] = (await evaluate({ settings, id: k + 1, up })).figures;
      done++;
      progress({ stage: 'orient', done, total });
    }
  };
  const helping = async (helper: HelperLane, mesh: Uint8Array): Promise<void> => {
    await helper.call({ kind: 'mesh', mesh });
    await work((evaluation) => helper.call({ kind: 'evaluate', ...evaluation }));
  };
  const shared = helpers.length > 0 ? (await lead.call({ kind: 'mesh', model })).mesh : new Uint8Array();
  const own = work((evaluation) => lead.call({ kind: 'evaluate', model, ...evaluation }));
  await Promise.all([own, ...helpers.map((helper) => helping(helper, shared))]);
  return figures;
}

function layersOf({ text, offsets }: SlicedRange): Uint8Array<ArrayBuffer>[] {
  return Array.from({ length: offsets.length - 1 }, (_, k) => text.subarray(offsets[k], offsets[k + 1]));
}

/** A promise that rejects when `signal` aborts, and a way to stop listening. */
function cancellation(signal: AbortSignal | undefined): { promise: Promise<never>; forget(): void } {
  let listener: (() => void) | undefined;
  const promise = new Promise<never>((_, reject) => {
    listener = () => reject(new DOMException('cancelled', 'AbortError'));
    if (signal?.aborted === true) listener();
    signal?.addEventListener('abort', listener);
  });
  return { promise, forget: () => listener !== undefined && signal?.removeEventListener('abort', listener) };
}
