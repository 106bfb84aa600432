// The flow of printing, as plain functions over the state: connect, print, go on, send to a server.

import { PrintJournal } from './journal.ts';
import { PrintLane } from './lane.ts';
import { hasJob } from './link.ts';
import type { Begin, DataOf, Journal, Outline, PrinterEvent, PrintNews } from './messages.ts';
import { isAlike, type SerialPortLike, serial } from './port.ts';
import { canGoOn, isCold, type PrintState, withLog, withSample } from './print-state.ts';
import { type PrintServer, UploadError, upload } from './upload.ts';
import { Vigil } from './vigil.ts';

/** Speeds tried one after another where none is chosen, the most common first, baud. */
const AUTO_SPEEDS = [115200, 250000, 500000, 1000000, 230400, 57600];

/** Where the speed at which a kind of port last answered is kept. */
const SPEED_KEY = 'foothold-speed';

/** The journal of a job that begins. */
const NOTHING_YET: Journal = { acked_line: null, z: null, layer: 0 };

/** A file to print. */
export interface PrintFile {
  readonly name: string;
  readonly text: Blob;
  readonly result: unknown;
}

/** The page's state of printing, wherever it is kept. */
export interface PrintStore {
  readonly state: PrintState;
  update(change: Partial<PrintState>): void;
}

export class PrintSession {
  readonly #store: PrintStore;
  readonly #lane: PrintLane;
  readonly #journal = new PrintJournal();
  readonly #vigil = new Vigil();
  #port: SerialPortLike | undefined;
  /** The file that was read or is being read, and where it shall begin. */
  #wanted: { file: PrintFile; begin: Begin } | undefined;
  #outline: Outline | undefined;
  /** The job waits, or is on its way into or out of a pause. */
  #parked = false;
  #uploading: AbortController | undefined;

  constructor(store: PrintStore) {
    this.#store = store;
    this.#lane = new PrintLane((news) => this.#hear(news));
    store.update({ supported: serial() !== undefined });
  }

  /** Looks for a job that stands since the last visit. */
  async start(): Promise<void> {
    const standing = await this.#journal.standing();
    if (standing !== undefined) this.#store.update({ standing });
  }

  /** Opens the port used last, or lets the user choose one; `speed` in baud, or undefined to try all. */
  async connect(speed: number | undefined, anew = false): Promise<void> {
    const port = await this.#choose(anew);
    if (port === undefined) return;
    this.#port = port;
    this.#store.update({
      port: { kind: 'trying', speed: undefined },
      problem: undefined,
      kept: undefined,
      samples: [],
    });
    this.#lane.open(port, speed === undefined ? speedsFor(port) : [speed]);
  }

  disconnect(): void {
    this.#lane.send({ kind: 'close' });
  }

  /** Ends the link; a job that prints stands as after a closed tab. */
  close(): void {
    this.#uploading?.abort();
    this.#lane.close();
    this.#vigil.close();
  }

  print(file: PrintFile, begin: Begin = { kind: 'start' }): void {
    this.#wanted = { file, begin };
    this.#store.update({ problem: undefined, doubt: undefined });
    this.#lane.send({ kind: 'read', text: file.text });
  }

  /** Goes on with the job that stands. */
  goOn(begin: Begin): void {
    const { standing } = this.#store.state;
    if (standing !== undefined) this.print({ ...standing, result: undefined }, begin);
  }

  /** Prints although the file is for another firmware. */
  printAnyway(): void {
    this.#begin();
  }

  dropDoubt(): void {
    this.#store.update({ doubt: undefined });
  }

  forgetStanding(): void {
    this.#store.update({ standing: undefined, end: undefined });
    void this.#journal.ended();
  }

  pause(): void {
    this.#lane.send({ kind: 'pause' });
  }

  resume(): void {
    this.#lane.send({ kind: 'resume' });
  }

  cancel(): void {
    this.#lane.send({ kind: 'cancel' });
  }

  emergencyStop(): void {
    this.#lane.send({ kind: 'stop' });
  }

  /** Sends commands one after another; the last one is shown in the console where `shown` is set. */
  send(lines: readonly string[], shown = true): void {
    for (const line of lines) {
      if (shown) this.#store.update(withLog(this.#store.state, { from: 'user', text: line }));
      this.#lane.send({ kind: 'send', line });
    }
  }

  setSpeed(percent: number): void {
    this.#store.update({ speed: percent });
    this.#lane.send({ kind: 'speed', percent });
  }

  setFlow(percent: number): void {
    this.#store.update({ flow: percent });
    this.#lane.send({ kind: 'flow', percent });
  }

  logAll(on: boolean): void {
    this.#store.update({ logAll: on });
    this.#lane.send({ kind: 'log', on });
  }

  /** Sends a file to a print server. */
  async upload(server: PrintServer, file: PrintFile, print: boolean): Promise<void> {
    const job = new AbortController();
    this.#uploading = job;
    this.#store.update({ upload: { kind: 'running', share: 0 } });
    try {
      await upload(server, { ...file, print }, job.signal, (share) =>
        this.#store.update({ upload: { kind: 'running', share } }),
      );
      this.#store.update({ upload: { kind: 'done' } });
    } catch (error) {
      if (!(error instanceof UploadError)) throw error;
      const { fault } = error;
      this.#store.update({ upload: fault.kind === 'cancelled' ? { kind: 'idle' } : { kind: 'failed', fault } });
    }
  }

  cancelUpload(): void {
    this.#uploading?.abort();
  }

  /** The permitted port of the last time, if it is still there; else the browser's own dialogue. */
  async #choose(anew: boolean): Promise<SerialPortLike | undefined> {
    const last = this.#port?.getInfo();
    const permitted = (await serial()?.getPorts()) ?? [];
    const again = permitted.filter((port) => last !== undefined && isAlike(port.getInfo(), last));
    if (!anew && again.length === 1) return again[0];
    // Rejects when the user chooses none.
    return serial()
      ?.requestPort()
      .catch(() => undefined);
  }

  // ---- news ----

  #hear(news: PrintNews): void {
    const { update } = this;
    switch (news.kind) {
      case 'trying':
        update({ port: { kind: 'trying', speed: news.speed } });
        return;
      case 'open':
        if (this.#port !== undefined) keepSpeed(this.#port, news.speed);
        update({ port: { kind: 'open', speed: news.speed }, speed: 100, flow: 100 });
        return;
      case 'not_open':
        update({ port: { kind: 'closed' }, problem: { kind: news.why, message: news.message } });
        return;
      case 'closed':
        this.#closed();
        return;
      case 'events':
        for (const event of news.events) this.#follow(event);
        return;
      case 'progress':
        this.#reached(news.journal, news.resends);
        return;
      case 'outline':
        this.#read(news.outline);
        return;
      case 'refused':
        update({ problem: { kind: 'command', message: news.message } });
        return;
      case 'unreadable':
        update({ problem: { kind: 'unreadable', message: news.message } });
        return;
      case 'broken':
        this.#closed();
        update({ problem: { kind: 'broken', message: news.message } });
        return;
      case 'elsewhere':
        return;
      default:
        news satisfies never;
    }
  }

  readonly update = (change: Partial<PrintState>): void => this.#store.update(change);

  #closed(): void {
    this.#vigil.keep(false);
    this.update({ port: { kind: 'closed' }, printer: 'offline', paused: undefined });
  }

  #follow(event: PrinterEvent): void {
    const { state } = this.#store;
    switch (event.kind) {
      case 'state':
        this.#entered(event.data.to);
        return;
      case 'connected':
        this.update({ kept: event.data.board_started ? false : undefined });
        return;
      case 'firmware':
        this.update({ firmware: event.data });
        return;
      case 'temperatures':
        this.update(withSample(state, event.data, Date.now()));
        if (state.standing === undefined || state.kept === false) return;
        this.update({ kept: !state.standing.parked && !isCold(state.standing, event.data) });
        return;
      case 'message':
        this.update(withLog(state, { from: 'printer', text: event.data }));
        return;
      case 'warning':
        this.update(withLog(state, { from: 'warning', text: event.data }));
        return;
      case 'sent':
      case 'received':
        this.update(withLog(state, { from: event.kind, text: event.data }));
        return;
      case 'paused':
        this.update({ paused: event.data });
        return;
      case 'finished':
        this.update({ end: { kind: 'finished', at: Date.now() }, journal: event.data, standing: undefined });
        void this.#journal.ended();
        return;
      case 'stopped':
        this.#stopped(event.data);
        return;
      default:
        event satisfies never;
    }
  }

  #entered(printer: PrintState['printer']): void {
    this.#vigil.keep(hasJob(printer));
    if (hasJob(printer)) this.#parked = printer !== 'printing' && printer !== 'finishing';
    const waits = printer === 'parking' || printer === 'paused';
    this.update(waits ? { printer } : { printer, paused: undefined });
  }

  #stopped({ reason, journal }: DataOf<'stopped'>): void {
    if (journal === null || journal === undefined) {
      if (reason.kind !== 'port_closed') this.update({ problem: { kind: 'lost', reason } });
      return;
    }
    this.update({ end: { kind: 'stopped', reason, journal }, journal });
    const wanted = this.#wanted;
    const outline = this.#outline;
    if (!canGoOn(reason) || wanted === undefined || outline === undefined) {
      this.update({ standing: undefined });
      void this.#journal.ended();
      return;
    }
    this.update({
      standing: { name: wanted.file.name, text: wanted.file.text, outline, journal, parked: this.#parked },
    });
    void this.#journal.reached(journal, this.#parked);
  }

  #reached(journal: Journal, resends: number): void {
    this.update({ journal, resends });
    void this.#journal.reached(journal, this.#parked);
  }

  #read(outline: Outline): void {
    this.#outline = outline;
    const { firmware } = this.#store.state;
    const foreign = outline.macro_line;
    if (foreign !== null && foreign !== undefined && firmware?.macros !== true) this.update({ doubt: foreign });
    else this.#begin();
  }

  #begin(): void {
    const wanted = this.#wanted;
    const outline = this.#outline;
    if (wanted === undefined || outline === undefined) return;
    const { file, begin } = wanted;
    const { standing } = this.#store.state;
    const journal: Journal = begin.kind === 'start' || standing === undefined ? NOTHING_YET : standing.journal;
    const job = { name: file.name, outline, began: Date.now(), result: file.result };
    this.update({ job, journal, end: undefined, standing: undefined, doubt: undefined, resends: 0 });
    void this.#journal.begin({ name: file.name, text: file.text, outline }, journal);
    this.#lane.send({ kind: 'start', begin });
  }
}

function portName(port: SerialPortLike): string {
  const { usbVendorId, usbProductId } = port.getInfo();
  return `${usbVendorId ?? ''}:${usbProductId ?? ''}`;
}

function keptSpeeds(): Record<string, number> {
  try {
    return JSON.parse(localStorage.getItem(SPEED_KEY) ?? '{}') as Record<string, number>;
  } catch {
    return {};
  }
}

/** All speeds, the one that this kind of port last answered at first. */
function speedsFor(port: SerialPortLike): readonly number[] {
  const last = keptSpeeds()[portName(port)];
  return typeof last === 'number' ? [last, ...AUTO_SPEEDS.filter((speed) => speed !== last)] : AUTO_SPEEDS;
}

function keepSpeed(port: SerialPortLike, speed: number): void {
  try {
    localStorage.setItem(SPEED_KEY, JSON.stringify({ ...keptSpeeds(), [portName(port)]: speed }));
  } catch {
    // A browser that keeps nothing: the speeds are tried anew next time.
  }
}
