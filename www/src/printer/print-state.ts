// What the page knows of the printer and its job.
import type { Standing } from './journal.ts';
import type {
  DataOf,
  Firmware,
  Journal,
  Outline,
  PauseReason,
  PrinterState,
  StopReason,
  Temperatures,
} from './messages.ts';
import type { UploadFault } from './upload.ts';

/** How the port stands. */
export type PortState =
  | { readonly kind: 'closed' }
  | { readonly kind: 'trying'; readonly speed: number | undefined }
  | { readonly kind: 'open'; readonly speed: number };

/** Why there is no link, or what else went wrong beside the job. */
export type PrintProblem =
  | { readonly kind: 'refused' | 'silent' | 'unreadable' | 'broken' | 'command'; readonly message: string }
  | { readonly kind: 'lost'; readonly reason: StopReason };

/** A temperature report and when it came, ms. */
export interface Sample {
  readonly at: number;
  readonly temperatures: Temperatures;
}

export interface LogLine {
  readonly from: 'user' | 'printer' | 'warning' | 'sent' | 'received';
  readonly text: string;
}

/** The job that prints, or that did. */
export interface PrintJob {
  readonly name: string;
  readonly outline: Outline;
  /** When it began, ms. */
  readonly began: number;
  /** The result it was made from, if the page has it: its layers can be shown. */
  readonly result: unknown;
}

export type JobEnd =
  | { readonly kind: 'finished'; readonly at: number }
  | { readonly kind: 'stopped'; readonly reason: StopReason; readonly journal: Journal };

export type UploadState =
  | { readonly kind: 'idle' }
  | { readonly kind: 'running'; readonly share: number }
  | { readonly kind: 'done' }
  | { readonly kind: 'failed'; readonly fault: UploadFault };

export interface PrintState {
  /** The browser has Web Serial. */
  readonly supported: boolean;
  readonly port: PortState;
  readonly printer: PrinterState;
  readonly firmware: Firmware | undefined;
  readonly problem: PrintProblem | undefined;
  readonly samples: readonly Sample[];
  readonly log: readonly LogLine[];
  /** Every line sent and received is logged. */
  readonly logAll: boolean;
  readonly job: PrintJob | undefined;
  readonly journal: Journal | undefined;
  readonly resends: number;
  readonly paused: PauseReason | undefined;
  readonly end: JobEnd | undefined;
  /** A job that began and has not ended well. */
  readonly standing: Standing | undefined;
  /** Whether the printer is as it was left; undefined until it is known. */
  readonly kept: boolean | undefined;
  /** The file wants a firmware with macros, and this one has none: print it all the same? */
  readonly doubt: NonNullable<Outline['macro_line']> | undefined;
  /** Percent. */
  readonly speed: number;
  readonly flow: number;
  readonly upload: UploadState;
}

export const printInitial: PrintState = {
  supported: false,
  port: { kind: 'closed' },
  printer: 'offline',
  firmware: undefined,
  problem: undefined,
  samples: [],
  log: [],
  logAll: false,
  job: undefined,
  journal: undefined,
  resends: 0,
  paused: undefined,
  end: undefined,
  standing: undefined,
  kept: undefined,
  doubt: undefined,
  speed: 100,
  flow: 100,
  upload: { kind: 'idle' },
};

/** Reports kept for the chart: ten minutes of one in two seconds. */
const MAX_SAMPLES = 300;

/** Lines kept in the console. */
const MAX_LOG = 400;

export function withSample(state: PrintState, temperatures: Temperatures, at: number): Partial<PrintState> {
  return { samples: [...state.samples.slice(1 - MAX_SAMPLES), { at, temperatures }] };
}

export function withLog(state: PrintState, line: LogLine): Partial<PrintState> {
  return { log: [...state.log.slice(1 - MAX_LOG), line] };
}

/** Whether a job that stopped for this reason may be gone on with. */
export function canGoOn(reason: DataOf<'stopped'>['reason']): boolean {
  switch (reason.kind) {
    case 'cancelled':
    case 'cancelled_by_printer':
    case 'emergency_in_job':
    case 'bad_job_line':
    case 'no_greeting':
      return false;
    case 'emergency_stop':
    case 'board_reset':
    case 'printer_error':
    case 'resend_impossible':
    case 'resend_loop':
    case 'no_answer':
    case 'port_closed':
      return true;
    default:
      return reason satisfies never;
  }
}

/** Heaters that the job had on and the printer has off: it forgot, or gave up waiting. */
export function isCold(standing: Standing, { tools }: Temperatures): boolean {
  const line = standing.journal.acked_line ?? 0;
  const begun = standing.outline.layers.filter((layer) => layer.line <= line);
  const wanted = begun.at(-1)?.heat.nozzle ?? 0;
  return wanted > 0 && tools.every(({ target }) => target === 0);
}

/** How far a job is: share of its lines, and seconds left as the file says (`M73`), where it says. */
export function progressOf(
  outline: Outline,
  journal: Journal | undefined,
): { share: number; left: number | undefined } {
  const line = journal?.acked_line ?? -1;
  const passed = outline.times.filter((mark) => mark.line <= line).at(-1) ?? outline.times[0];
  return {
    share: outline.lines === 0 ? 0 : Math.min(1, (line + 1) / outline.lines),
    left: passed === undefined ? undefined : 60 * passed.minutes,
  };
}
