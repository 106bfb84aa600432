// What the page and the print lane, which holds the link to the printer, say to each other.
import type { Event, Firmware, Journal, Temperatures } from '../generated/printer-event.ts';
import type { Outline } from '../generated/printer-outline.ts';

export type { Firmware, Journal, Outline, Temperatures };
export type PrinterEvent = Event;

/** What the event of a kind carries. */
export type DataOf<K extends PrinterEvent['kind']> = Extract<PrinterEvent, { readonly kind: K }>['data'];
export type PrinterState = DataOf<'state'>['to'];
export type StopReason = DataOf<'stopped'>['reason'];
export type PauseReason = DataOf<'paused'>;

/** What Web Serial tells of a port: nothing, where it is no USB device. */
export interface PortInfo {
  readonly usbVendorId?: number;
  readonly usbProductId?: number;
}

/** Where a job begins. */
export type Begin =
  | { readonly kind: 'start' }
  /** At this line (from 0), the printer being as it was left. */
  | { readonly kind: 'line'; readonly line: number }
  /** At this layer (from 0), the printer having forgotten all, its nozzle standing at height `z`, mm. */
  | { readonly kind: 'layer'; readonly layer: number; readonly z: number };

export type PrintRequest =
  /** Opens the port with the first of these speeds at which a printer answers. */
  | { readonly kind: 'open'; readonly info: PortInfo; readonly speeds: readonly number[] }
  /** Reads a job; what it holds comes as news. */
  | { readonly kind: 'read'; readonly text: Blob }
  /** Prints the job read last. */
  | { readonly kind: 'start'; readonly begin: Begin }
  | { readonly kind: 'pause' }
  | { readonly kind: 'resume' }
  | { readonly kind: 'cancel' }
  | { readonly kind: 'stop' }
  | { readonly kind: 'send'; readonly line: string }
  | { readonly kind: 'speed'; readonly percent: number }
  | { readonly kind: 'flow'; readonly percent: number }
  | { readonly kind: 'log'; readonly on: boolean }
  | { readonly kind: 'close' };

export type PrintNews =
  /** The port is tried at this speed. */
  | { readonly kind: 'trying'; readonly speed: number }
  /** A printer answers. */
  | { readonly kind: 'open'; readonly speed: number }
  /** This thread cannot have the port, or cannot tell it from others: another one has to open it. */
  | { readonly kind: 'elsewhere' }
  /** The port could not be opened, or nothing that answers like a printer is there. */
  | { readonly kind: 'not_open'; readonly why: 'refused' | 'silent'; readonly message: string }
  | { readonly kind: 'closed' }
  | { readonly kind: 'events'; readonly events: readonly PrinterEvent[] }
  | { readonly kind: 'progress'; readonly journal: Journal; readonly resends: number }
  | { readonly kind: 'outline'; readonly outline: Outline }
  /** The state does not allow this command, or its line cannot be sent. */
  | { readonly kind: 'refused'; readonly message: string }
  /** The file of the job cannot be read any more. */
  | { readonly kind: 'unreadable'; readonly message: string }
  /** The lane is broken: a fault of ours. The port is closed. */
  | { readonly kind: 'broken'; readonly message: string };

/** What goes to a lane in a worker. */
export type ToPrintLane = { readonly start: WebAssembly.Module } | { readonly request: PrintRequest };
