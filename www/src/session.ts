// The flow of work, as plain functions over the state: open, slice, cancel, show, download.
import type { Report } from './generated/report.ts';
import { t } from './i18n/text.ts';
import type { ModelSource } from './messages.ts';
import { asSettings } from './settings/changes.ts';
import { EngineError, isCancel } from './slicer/errors.ts';
import { partsOf } from './slicer/gcode.ts';
import type { Pool } from './slicer/pool.ts';
import { fetched, lastPart, namedModel } from './source.ts';
import type { ModelFacts, Problem, Remark, State, Step, Store } from './state.ts';

export class Session {
  readonly #store: Store;
  readonly #pool: Pool;
  #job: AbortController | undefined;

  constructor(store: Store, pool: Pool) {
    this.#store = store;
    this.#pool = pool;
  }

  /** Opens what the page's address names, or the sample; the sample is sliced at once. */
  async start(address: string): Promise<void> {
    try {
      const named = namedModel(address);
      if (named !== undefined) return await this.open(await fetched(named, lastPart(named)));
      // The visitor may be at another step by now, and stays there.
      await this.#open(await fetched('sample.stl', 'sample.stl'), this.#store.state.step);
      await this.#slice(() => this.#store.state.step);
    } catch (error) {
      this.#store.update({ model: { kind: 'failed', problem: problemOf(error) } });
    }
  }

  /** Opens a model; a job under way is cancelled. */
  open(source: ModelSource): Promise<void> {
    return this.#open(source, 'prepare');
  }

  async #open(source: ModelSource, step: Step): Promise<void> {
    this.#job?.abort();
    this.#job = undefined;
    this.#store.update({
      model: { kind: 'reading', source },
      job: { kind: 'idle' },
      result: undefined,
      step,
    });
    const isCurrent = (): boolean => {
      const { model } = this.#store.state;
      return model.kind === 'reading' && model.source === source;
    };
    try {
      const { inspections } = await this.#pool.open([source]);
      if (isCurrent()) this.#store.update({ model: { kind: 'open', source, facts: factsOf(inspections[0] ?? '{}') } });
    } catch (error) {
      if (isCurrent()) this.#store.update({ model: { kind: 'failed', problem: problemOf(error) } });
    }
  }

  /** Slices the open model with the settings of the form, and goes on to Preview. */
  slice(): Promise<void> {
    return this.#slice(() => 'preview');
  }

  async #slice(next: () => Step): Promise<void> {
    if (this.#store.state.model.kind !== 'open') return;
    this.#job?.abort();
    const job = new AbortController();
    this.#job = job;
    const update = (change: Partial<State>): void => {
      if (this.#job === job) this.#store.update(change);
    };
    update({ job: { kind: 'running', progress: { stage: 'read', done: 0, total: 0 } } });
    try {
      const sliced = await this.#sliced(job.signal, (progress) => update({ job: { kind: 'running', progress } }));
      update({ ...sliced, step: next() });
    } catch (error) {
      update({ job: isCancel(error) ? { kind: 'cancelled' } : { kind: 'failed', problem: problemOf(error) } });
    } finally {
      // After a cancel or a crash a new lead reads the model again while nobody waits for it.
      this.#pool.ready().catch(() => undefined);
    }
  }

  cancel(): void {
    this.#job?.abort();
  }

  /** Hands the G-code to the browser as a file. */
  download(): void {
    const { result } = this.#store.state;
    if (result === undefined) return;
    const address = URL.createObjectURL(new Blob(partsOf(result.gcode), { type: 'text/x.gcode' }));
    const link = document.createElement('a');
    link.href = address;
    link.download = result.gcode.joined.fileName;
    link.click();
    setTimeout(() => URL.revokeObjectURL(address), 60_000);
  }

  showLayer(layer: number): void {
    const { result, step } = this.#store.state;
    if (result === undefined) return;
    const last = result.gcode.layers.length - 1;
    this.#store.update({ step: step === 'prepare' ? 'preview' : step, layer: Math.min(Math.max(layer, 0), last) });
  }

  async #sliced(
    signal: AbortSignal,
    progress: NonNullable<Parameters<Pool['slice']>[0]['progress']>,
  ): Promise<Partial<State>> {
    const { changes } = this.#store.state;
    const settings = await this.#pool.settings([asSettings(changes)], []);
    const gcode = await this.#pool.slice({ settings, signal, progress });
    const report = JSON.parse(gcode.joined.report) as Report;
    return { job: { kind: 'done' }, result: { gcode, report, settings, changes }, layer: 0 };
  }
}

export function problemOf(error: unknown): Problem {
  const known = error instanceof EngineError || (error instanceof Error && error.name in t.problem);
  return {
    name: known ? (error as Error).name : 'InternalError',
    message: error instanceof Error ? error.message : String(error),
  };
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
