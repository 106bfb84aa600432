// What the page knows. Elements draw it and send events; main.ts alone changes it.
import type { Report } from './generated/report.ts';
import type { Language } from './i18n/text.ts';
import type { LegendEntry, ModelSource, PictureView } from './messages.ts';
import type { ThemeChoice } from './preferences.ts';
import { type PrintState, printInitial } from './printer/print-state.ts';
import type { Changes } from './settings/changes.ts';
import type { Gcode } from './slicer/gcode.ts';
import type { Progress } from './slicer/pool.ts';

/** An error in words; `name` chooses the title and the advice. */
export interface Problem {
  readonly name: string;
  readonly message: string;
}

/** The facts about a model that the page shows. */
export interface ModelFacts {
  readonly triangles: number;
  readonly size: readonly number[];
  readonly volume_mm3: number;
  readonly warnings: readonly Remark[];
}

export interface Remark {
  readonly code: string;
  readonly message: string;
  readonly layer?: number | null;
}

export type ModelState =
  | { readonly kind: 'none' }
  | { readonly kind: 'reading'; readonly source: ModelSource }
  | { readonly kind: 'open'; readonly source: ModelSource; readonly facts: ModelFacts }
  | { readonly kind: 'failed'; readonly problem: Problem };

export interface Result {
  readonly gcode: Gcode;
  readonly report: Report;
  /** All settings it was made with, JSON. */
  readonly settings: string;
  /** The changes it was made with; when they differ from the form's, the result is stale. */
  readonly changes: Changes;
}

export type JobState =
  | { readonly kind: 'idle' }
  | { readonly kind: 'running'; readonly progress: Progress }
  | { readonly kind: 'cancelled' }
  | { readonly kind: 'failed'; readonly problem: Problem }
  | { readonly kind: 'done' };

/** What the visitor is at; the steps share one view. */
export type Step = 'prepare' | 'preview' | 'print' | 'learn';

export interface State {
  readonly engine: 'starting' | 'ready' | Problem;
  readonly model: ModelState;
  readonly job: JobState;
  readonly result: Result | undefined;
  readonly changes: Changes;
  readonly step: Step;
  readonly side: PictureView;
  /** The layer shown, from 0. */
  readonly layer: number;
  readonly legend: readonly LegendEntry[];
  readonly print: PrintState;
  readonly language: Language;
  readonly theme: ThemeChoice;
  /** Whether the page is dark now, by choice or as the system is. */
  readonly dark: boolean;
}

export const initial: State = {
  engine: 'starting',
  model: { kind: 'none' },
  job: { kind: 'idle' },
  result: undefined,
  changes: {},
  step: 'prepare',
  side: 'iso',
  layer: 0,
  legend: [],
  print: printInitial,
  language: 'en',
  theme: 'system',
  dark: false,
};

/** Holds the state and tells listeners of each change, once per frame's worth of changes. */
export class Store {
  #state: State = initial;
  #told = false;
  readonly #listeners = new Set<(state: State) => void>();

  get state(): State {
    return this.#state;
  }

  update(change: Partial<State>): void {
    this.#state = { ...this.#state, ...change };
    if (this.#told) return;
    this.#told = true;
    queueMicrotask(() => {
      this.#told = false;
      for (const listener of this.#listeners) listener(this.#state);
    });
  }

  listen(listener: (state: State) => void): void {
    this.#listeners.add(listener);
    listener(this.#state);
  }
}

/** Whether the form says something else than the result was made with. */
export function isStale({ result, changes }: State): boolean {
  return result !== undefined && JSON.stringify(result.changes) !== JSON.stringify(changes);
}

/** How far a job is, 0 to 1; the layers are nearly all of it. */
export function shareOf({ stage, done, total }: Progress): number {
  switch (stage) {
    case 'read':
      return 0;
    case 'orient':
      return 0.04 * (total === 0 ? 0 : done / total);
    case 'prepare':
      return 0.05;
    case 'layers':
      return 0.1 + 0.87 * (total === 0 ? 0 : done / total);
    case 'join':
      return 0.98;
    default:
      return stage satisfies never;
  }
}
