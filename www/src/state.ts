// What the page knows. Elements draw it and send events; main.ts alone changes it.
import type { Report } from './generated/report.ts';
import { type History, noHistory, planOf, recorded, samePlan } from './history.ts';
import type { Language } from './i18n/text.ts';
import { firstPlace, type Place } from './lesson/steps.ts';
import type { Edit, LegendEntry, ModelSource, PictureView } from './messages.ts';
import type { Part } from './parts.ts';
import type { ThemeChoice } from './preferences.ts';
import { hasJob } from './printer/link.ts';
import { type PrintState, printInitial } from './printer/print-state.ts';
import { type Changes, same } from './settings/changes.ts';
import type { Gcode } from './slicer/gcode.ts';
import type { Progress } from './slicer/pool.ts';
import type { ColourBy, RoleColour } from './view/colours.ts';

/** An error in words; `name` chooses the title and the advice. */
export interface Problem {
  readonly name: string;
  readonly message: string;
  /** The file that can't be read. */
  readonly file?: string;
  /** A change to every part that would mend it. */
  readonly fix?: Edit;
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
  /** Where on the bed, mm. */
  readonly at?: readonly number[] | null;
  /** Settings that would mend it, as `path=value` with the value in JSON. */
  readonly fix?: readonly string[];
}

/** An open model. */
export interface OpenModel {
  readonly source: ModelSource;
  readonly facts: ModelFacts;
}

export type ModelState =
  | { readonly kind: 'none' }
  | { readonly kind: 'reading'; readonly source: ModelSource }
  /** All models that were opened; `source` and `facts` are those of the first. */
  | ({ readonly kind: 'open'; readonly models: readonly OpenModel[] } & OpenModel)
  | { readonly kind: 'failed'; readonly problem: Problem };

/** What the page shows of a job, or of a G-code file that was opened. */
export interface Figures extends Pick<Report, 'layers' | 'time_s' | 'by_role' | 'filament'> {
  readonly model: Pick<Report['model'], 'bounds'>;
  readonly warnings: readonly Remark[];
}

export interface Result {
  readonly gcode: Gcode;
  readonly report: Figures;
  /** The whole report of what was sliced here; an opened file has none. */
  readonly sliced?: Report;
  /** All settings it was made with, JSON. */
  readonly settings: string;
  /** The changes it was made with; when they differ from the form's, the result is stale. */
  readonly changes: Changes;
  /** The parts it was made of. */
  readonly parts: readonly Part[];
}

export type JobState =
  | { readonly kind: 'idle' }
  | { readonly kind: 'running'; readonly progress: Progress }
  | { readonly kind: 'cancelled' }
  | { readonly kind: 'failed'; readonly problem: Problem }
  | { readonly kind: 'done' };

/** What the visitor is at; the steps share one view. */
export type Step = 'prepare' | 'preview' | 'print' | 'learn';

/** What the app stands in: a page of its own, another site's page, or one that has fixed model and settings. */
export type Frame = 'page' | 'embedded' | 'locked';

export interface State {
  readonly frame: Frame;
  readonly engine: 'starting' | 'ready' | Problem;
  /** A newer page waits to be loaded; "elsewhere": another tab's job keeps it waiting. */
  readonly newVersion: 'ready' | 'elsewhere' | undefined;
  readonly model: ModelState;
  readonly job: JobState;
  readonly result: Result | undefined;
  readonly changes: Changes;
  /** What an import of settings could not take over. */
  readonly settingsNotes: readonly string[];
  readonly parts: readonly Part[];
  /** The parts stand as the engine arranges them; nobody has moved one. */
  readonly arranged: boolean;
  /** The part chosen, by its number. */
  readonly selected: number | undefined;
  readonly history: History;
  /** Why the last change of the parts did not come about. */
  readonly trouble: Problem | undefined;
  readonly step: Step;
  /** Where the visitor is in the lessons. */
  readonly place: Place;
  readonly side: PictureView;
  /** The layer shown, from 0. */
  readonly layer: number;
  readonly legend: readonly LegendEntry[];
  readonly print: PrintState;
  /** The preview shows one layer flat, not all in space. */
  readonly flat: boolean;
  readonly colourBy: ColourBy;
  /** Roles that the preview in space leaves out. */
  readonly hidden: ReadonlySet<string>;
  /** Low and high end of the colours, where they mean a quantity. */
  readonly range: readonly [number, number] | undefined;
  /** Colours of all roles, from the engine. */
  readonly roles: readonly RoleColour[];
  /** The next click on a face lays it on the bed. */
  readonly laying: boolean;
  readonly language: Language;
  readonly theme: ThemeChoice;
  /** Whether the page is dark now, by choice or as the system is. */
  readonly dark: boolean;
}

export const initial: State = {
  frame: 'page',
  engine: 'starting',
  newVersion: undefined,
  model: { kind: 'none' },
  job: { kind: 'idle' },
  result: undefined,
  changes: {},
  settingsNotes: [],
  parts: [],
  arranged: true,
  selected: undefined,
  history: noHistory,
  trouble: undefined,
  step: 'prepare',
  place: firstPlace,
  side: 'iso',
  layer: 0,
  legend: [],
  print: printInitial,
  flat: false,
  colourBy: 'role',
  hidden: new Set(['travel']),
  range: undefined,
  roles: [],
  laying: false,
  language: 'en',
  theme: 'system',
  dark: false,
};

/** What a newly opened model begins with: settings stay, and nothing can be undone. */
export const noPlan = {
  parts: [],
  arranged: true,
  selected: undefined,
  history: noHistory,
  trouble: undefined,
} as const satisfies Partial<State>;

/** Holds the state and tells listeners of each change, once per frame's worth of changes. */
export class Store {
  #state: State = initial;
  #told = false;
  readonly #listeners = new Set<(state: State) => void>();

  get state(): State {
    return this.#state;
  }

  /** A change of parts or settings can be undone, unless it brings a history of its own. */
  update(change: Partial<State>): void {
    const before = this.#state;
    const after = { ...before, ...change };
    const isEdit = change.history === undefined && !samePlan(before, after);
    this.#state = isEdit ? { ...after, history: recorded(before.history, planOf(before)) } : after;
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

/** Whether a job runs that a reload would end. */
export function isBusy({ job, print }: State): boolean {
  return job.kind === 'running' || hasJob(print.printer) || print.upload.kind === 'running';
}

/** Whether the form says something else than the result was made with. */
export function isStale({ result, changes, parts }: State): boolean {
  if (result?.sliced === undefined) return false;
  return !same(result.changes, changes) || !same(result.parts, parts);
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
