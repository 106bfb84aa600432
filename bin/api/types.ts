// What the package offers in Node.
import type { Report } from '../../www/src/generated/report.ts';
import type { Settings } from '../../www/src/generated/settings.ts';
import type { SomeSettings } from '../../www/src/settings/some.ts';

export type { Report, Settings, SomeSettings };

/** A file's path, or its bytes under a name, whose ending tells STL, 3MF or OBJ. */
export type Model = string | URL | { readonly name: string; readonly bytes: Uint8Array };

export interface SliceOptions {
  /** Profiles by their id, each over the one before. */
  readonly printer?: string | undefined;
  readonly material?: string | undefined;
  readonly quality?: string | undefined;
  /** Settings over the profiles. */
  readonly settings?: SomeSettings | undefined;
  /** Engines that work at the same time; default: processors, at most 4. The result does not depend on it. */
  readonly workers?: number | undefined;
  readonly signal?: AbortSignal | undefined;
  readonly progress?: ((progress: Progress) => void) | undefined;
}

/** How far a job is; `done` of `total` directions in the stage "orient", of layers in "layers". */
export interface Progress {
  readonly stage: 'read' | 'orient' | 'prepare' | 'layers' | 'join';
  readonly done: number;
  readonly total: number;
}

export interface Sliced {
  readonly gcode: Uint8Array;
  /** A name to save the G-code by. */
  readonly fileName: string;
  readonly report: Report;
}

/**
 * Slices models, arranged on one bed. Rejects with an Error whose name is FileError or ModelError (it can't be read
 * or used), SettingsError, FitError (it does not fit the printer), AbortError or InternalError (a bug of ours).
 */
export type Slice = (models: Model | readonly Model[], options?: SliceOptions) => Promise<Sliced>;

export declare const slice: Slice;

/** Ids of the profiles that there are. */
export declare const profiles: Readonly<Record<'printer' | 'material' | 'quality', readonly string[]>>;
