// The lead lane's side of the conversation: it holds the models and the job.
import { type LoadFiles, modelsIn, refuseTooLarge, stem } from '../files/files.ts';
import type { Chunk, Job, Model, Scene } from '../generated/engine/foothold.js';
import type {
  Bounds,
  CameraNumbers,
  Edit,
  GcodeIndex,
  Joined,
  LeadReply,
  LeadRequest,
  ModelSource,
  Shape,
  SlicedRange,
  Standing,
  Theme,
  Up,
} from '../messages.ts';
import { canvasSize } from '../view/camera.ts';
import { EngineError, toFailure } from './errors.ts';

export type Engine = typeof import('../generated/engine/foothold.js');

/** Bytes of a model file read at a time. */
const READ_BYTES = 4 << 20;

export class Lead {
  readonly #engine: Engine;
  readonly #loadFiles: LoadFiles;
  #models: Model[] = [];
  #names: string[] = [];
  #job: Job | undefined;
  #scene: Scene | undefined;

  /** `loadFiles` is called when a model is no STL. */
  constructor(engine: Engine, loadFiles: LoadFiles) {
    this.#engine = engine;
    this.#loadFiles = loadFiles;
  }

  async handle(request: LeadRequest): Promise<LeadReply> {
    switch (request.kind) {
      case 'open':
        return { kind: 'open', ...(await this.#open(request.sources, request.keep)) };
      case 'unpack':
        return { kind: 'unpack', sources: await this.#unpack(request.source) };
      case 'stl':
        return { kind: 'stl', stl: this.#stl(request.settings, request.standing) };
      case 'gcode':
        return { kind: 'gcode', ...(await this.#gcode(request.source, request.settings)) };
      case 'shape':
        return { kind: 'shape', ...shapeOf(this.#model(request.model)) };
      case 'edit':
        return { kind: 'edit', stand: this.#edit(request.model, request.matrix, request.edit) };
      case 'arrange':
        return { kind: 'arrange', placements: this.#arrange(request) };
      case 'settings':
        return { kind: 'settings', settings: this.#engine.resolve_settings([...request.files], [...request.sets]) };
      case 'own':
        return { kind: 'own', settings: this.#engine.resolve_own([...request.files], [...request.sets]) };
      case 'begin':
        return { kind: 'begin', partLayers: this.#begin(request.settings, request.standing) };
      case 'prepare':
        this.#current().prepare();
        return { kind: 'prepare', layers: this.#current().layer_count() };
      case 'share':
        return { kind: 'share', share: this.#current().share(request.range.first, request.range.last) };
      case 'slice':
        return { kind: 'slice', ...this.#slice(request.range.first, request.range.last) };
      case 'add':
        this.#current().add(request.meta);
        return { kind: 'add' };
      case 'finish':
        return { kind: 'finish', ...this.#finish() };
      case 'end':
        this.#end();
        return { kind: 'end' };
      case 'drawLayer':
        return { kind: 'drawLayer', svg: this.#current().draw_layer(request.layer) };
      case 'drawPlane':
        return { kind: 'drawPlane', svg: this.#current().draw_plane(request.spec) };
      case 'directions':
        return {
          kind: 'directions',
          ups: vectors(this.#model(request.model).directions(request.settings, request.all)),
        };
      case 'evaluate': {
        const { settings, id, up } = request;
        return { kind: 'evaluate', figures: this.#model(request.model).evaluate(settings, id, Float64Array.from(up)) };
      }
      case 'choose':
        return { kind: 'choose', report: this.#model(request.model).choose(request.settings, [...request.figures]) };
      case 'mesh':
        return { kind: 'mesh', mesh: this.#model(request.model).share() };
      case 'compare':
        return { kind: 'compare', report: this.#current().compare() };
      case 'study':
        return { kind: 'study', answer: this.#study(request) };
      case 'thumbnail':
        return {
          kind: 'thumbnail',
          pixels: this.#model(request.model).thumbnail(Float64Array.from(request.up), request.width, request.height),
        };
      case 'picture':
        return { kind: 'picture', bounds: this.#picture(request.view, request.standing) };
      case 'paint':
        return { kind: 'paint', bitmap: this.#paint(request.camera, request.theme) };
      default:
        return request satisfies never;
    }
  }

  async #open(sources: readonly ModelSource[], keep: number): Promise<{ inspections: string[]; parse_ms: number }> {
    this.#keep(keep);
    const started = performance.now();
    for (const source of sources.slice(keep)) {
      this.#models.push(await this.#read(source));
      this.#names.push(stem(source.name));
    }
    const parse_ms = performance.now() - started;
    return { inspections: this.#models.map((model) => model.inspect()), parse_ms };
  }

  async #unpack(source: ModelSource): Promise<readonly ModelSource[]> {
    try {
      return await modelsIn(source, this.#loadFiles);
    } catch (error) {
      throw new EngineError(toFailure(error, source.name));
    }
  }

  async #read({ name, file }: ModelSource): Promise<Model> {
    try {
      refuseTooLarge(file.size);
      const reader = new this.#engine.ModelReader(file.size);
      for await (const chunk of chunksOf(file)) reader.push(chunk);
      return reader.finish();
    } catch (error) {
      throw new EngineError(toFailure(error, name));
    }
  }

  async #gcode({ name, file }: ModelSource, settings: string): Promise<GcodeIndex> {
    const reader = new this.#engine.GcodeReader(settings);
    try {
      for await (const chunk of chunksOf(file)) reader.push(chunk);
      const found = reader.finish();
      const index = {
        figures: found.figures(),
        offsets: found.offsets(),
        heads: found.heads(),
        times: found.times(),
      };
      found.free();
      return index;
    } catch (error) {
      throw new EngineError(toFailure(error, name));
    }
  }

  #begin(settings: string, standing: Standing = this.#all()): number {
    this.#end();
    this.#job = this.#newJob(settings, standing);
    return this.#job.layer_count();
  }

  #newJob(settings: string, standing: Standing): Job {
    return new this.#engine.Job(
      this.#copies(standing),
      standing.models.map((model) => this.#names[model] ?? 'model'),
      settings,
      Float64Array.from(standing.placements),
      [...(standing.own ?? [])],
    );
  }

  #stl(settings: string, standing: Standing = this.#all()): Uint8Array<ArrayBuffer> {
    const job = this.#newJob(settings, standing);
    try {
      return job.stl() as Uint8Array<ArrayBuffer>;
    } finally {
      job.free();
    }
  }

  /** Answers from a job of its own, about all models together: the one that is sliced goes on. */
  #study({ settings, question, standing }: Extract<LeadRequest, { kind: 'study' }>): string {
    if (question.about === 'orientation') {
      return this.#model(0).orientation_lesson(question.side, question.dark);
    }
    const together = this.#engine.resolve_settings([settings], ['print.sequence=by_layer']);
    const { models, placements } = standing ?? this.#all();
    const job = this.#newJob(together, { models, placements });
    try {
      switch (question.about) {
        case 'baseLayers':
          return job.base_layers(question.side, question.dark);
        case 'plane':
          return job.plane(question.plane, question.side, question.dark);
        case 'sheets':
          return job.sheets();
        case 'lesson':
          return job.lesson(question.lesson, question.at, question.side, question.dark);
        default:
          return question satisfies never;
      }
    } finally {
      job.free();
    }
  }

  /** Every open model once, to be arranged. */
  #all(): Standing {
    return { models: this.#models.map((_, k) => k), placements: [] };
  }

  #copies({ models }: Standing): Model[] {
    return models.map((model) => this.#model(model).clone_model());
  }

  #edit(model: number, matrix: readonly number[], edit: Edit | undefined): Float64Array {
    const placement = Float64Array.from(matrix);
    if (edit === undefined) return this.#model(model).stand(placement);
    return this.#model(model).edit(placement, edit.kind, numbersOf(edit));
  }

  #arrange({ placements, boxes, settings, own }: Extract<LeadRequest, { kind: 'arrange' }>): Float64Array {
    return this.#engine.arrange_parts(Float64Array.from(placements), Float64Array.from(boxes), settings, [...own]);
  }

  #slice(first: number, last: number): SlicedRange {
    const chunk = this.#current().slice(first, last);
    this.#current().add(chunk.meta());
    return taken(chunk);
  }

  #finish(): Joined {
    const result = this.#current().finish();
    const joined = {
      report: result.report(),
      fileName: result.file_name(),
      glue: result.glue() as Uint8Array<ArrayBuffer>,
      pieces: result.pieces(),
      times: result.layer_times(),
      marks: result.marks(),
    };
    result.free();
    return joined;
  }

  #model(index: number): Model {
    const model = this.#models[index];
    if (model === undefined) throw new Error(`there is no model ${index}`);
    return model;
  }

  #picture(view: string, standing: Standing = this.#all()): Bounds {
    this.#scene?.free();
    this.#scene = undefined;
    const asInFile = standing.models.flatMap(() => IDENTITY);
    const placements = standing.placements.length === 0 ? asInFile : standing.placements;
    this.#scene = this.#engine.parts_picture(this.#copies(standing), Float64Array.from(placements), view);
    return boundsOf(this.#scene);
  }

  #paint(camera: CameraNumbers, theme: Theme): ImageBitmap {
    if (this.#scene === undefined) throw new Error('there is no picture to paint');
    const { width, height } = canvasSize(camera);
    const canvas = new OffscreenCanvas(width, height);
    const context = canvas.getContext('2d');
    if (context === null) throw new Error('this browser has no 2D canvas in workers');
    this.#scene.paint(context, Float64Array.from(camera), theme);
    return canvas.transferToImageBitmap();
  }

  #current(): Job {
    if (this.#job === undefined) throw new Error('no job was begun');
    return this.#job;
  }

  #end(): void {
    this.#job?.free();
    this.#job = undefined;
  }

  /** Lets all models but the first ones go, and what was made of them. */
  #keep(count: number): void {
    this.#end();
    this.#scene?.free();
    this.#scene = undefined;
    for (const model of this.#models.splice(count)) model.free();
    this.#names.splice(count);
  }
}

/** A matrix that leaves all where it is. */
const IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];

/** The numbers of a change in the order in which the engine's `Model.edit` takes them. */
function numbersOf(edit: Edit): Float64Array {
  switch (edit.kind) {
    case 'drop':
      return Float64Array.of();
    case 'turn':
      return Float64Array.of(edit.axis, edit.angle_deg);
    case 'scale':
      return Float64Array.from(edit.factors);
    case 'mirror':
      return Float64Array.of(edit.axis);
    case 'lay_flat':
      return Float64Array.of(edit.triangle);
    case 'turn_up':
      return Float64Array.from(edit.up);
    default:
      return edit satisfies never;
  }
}

function shapeOf(model: Model): Shape {
  return {
    positions: model.positions() as Float32Array<ArrayBuffer>,
    indices: model.indices() as Uint32Array<ArrayBuffer>,
  };
}

/** A file piece by piece; the next piece is read while one is worked on. */
async function* chunksOf(file: ModelSource['file']): AsyncGenerator<Uint8Array> {
  let next = read(file, 0);
  for (let from = 0; from < file.size; from += READ_BYTES) {
    const chunk = await next;
    next = read(file, from + READ_BYTES);
    yield chunk;
  }
}

/** The next bytes of a file; one that can't be read any more (moved, changed) is the model's fault, not ours. */
async function read(file: ModelSource['file'], from: number): Promise<Uint8Array> {
  if (from >= file.size) return new Uint8Array();
  try {
    return new Uint8Array(await file.slice(from, Math.min(from + READ_BYTES, file.size)).arrayBuffer());
  } catch (error) {
    const reason = error instanceof Error ? error.message : String(error);
    throw new EngineError({ name: 'ModelError', message: `can't be read: ${reason}`, fatal: false });
  }
}

/** The chunk's text, moved out of the engine. */
export function taken(chunk: Chunk): SlicedRange {
  const range = { offsets: chunk.layer_offsets(), text: chunk.text() as Uint8Array<ArrayBuffer> };
  chunk.free();
  return range;
}

/** Triples of numbers as vectors. */
function vectors(numbers: Float64Array): Up[] {
  return Array.from({ length: numbers.length / 3 }, (_, k) => {
    const [x = 0, y = 0, z = 0] = numbers.subarray(3 * k, 3 * k + 3);
    return [x, y, z];
  });
}

export function boundsOf(scene: Scene): Bounds {
  const [minX = 0, minY = 0, maxX = 0, maxY = 0] = scene.bounds();
  return [minX, minY, maxX, maxY];
}
