// What a host page sees of <foothold-slicer>.
import type { Report } from './generated/report.ts';
import type { Settings } from './generated/settings.ts';
import type { SomeSettings } from './settings/some.ts';

export type { Report, Settings, SomeSettings };

/**
 * What went wrong, in words; `name` is ModelError, SettingsError, FitError (it does not fit the printer) or
 * InternalError (a fault of ours).
 */
export interface SlicerProblem {
  readonly name: string;
  readonly message: string;
}

/** A print over USB that began or ended; `name` is the file's. */
export interface PrintEvent {
  readonly state: 'started' | 'finished' | 'stopped';
  readonly name: string;
}

export interface FootholdSlicerEventMap extends HTMLElementEventMap {
  /** A job is done: its report, with which a shop can quote. */
  'foothold-sliced': CustomEvent<Report>;
  'foothold-error': CustomEvent<SlicerProblem>;
  'foothold-print': CustomEvent<PrintEvent>;
}

/** The element. Its attributes: src, printer, material, quality, locked, lang, theme. */
export interface FootholdSlicerElement extends HTMLElement {
  /** The settings over the profiles that the attributes name; setting them begins anew from those. */
  settings: SomeSettings;
  /** Opens a model instead of what was open. Rejects when it can't be read. */
  load(model: Blob | URL | string): Promise<void>;
  /** Slices what is open, or what is being loaded. Rejects with an Error named as in SlicerProblem, or AbortError. */
  slice(): Promise<Report>;
  /** The G-code of the last job, under the name to save it by; undefined before the first. */
  gcode(): File | undefined;
  addEventListener<K extends keyof FootholdSlicerEventMap>(
    type: K,
    listener: (this: FootholdSlicerElement, event: FootholdSlicerEventMap[K]) => unknown,
    options?: boolean | AddEventListenerOptions,
  ): void;
  addEventListener(
    type: string,
    listener: EventListenerOrEventListenerObject,
    options?: boolean | AddEventListenerOptions,
  ): void;
}

declare global {
  interface HTMLElementTagNameMap {
    'foothold-slicer': FootholdSlicerElement;
  }
}
