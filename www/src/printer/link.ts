// Drives the engine's Printer: bytes from the port and timers in, bytes to the port and news out.
import type * as Engine from '../generated/link/foothold_link.js';
import type { Begin, Journal, PortInfo, PrinterEvent, PrinterState, PrintNews, PrintRequest } from './messages.ts';
import { type SerialPortLike, Wire } from './port.ts';
import type { Source } from './text.ts';

/** What the link needs of its thread. */
export interface Surroundings {
  readonly engine: Pick<typeof Engine, 'Printer' | 'Outline'>;
  news(news: PrintNews): void;
  /** The text of a job, to be read piece by piece. */
  source(text: Blob): Promise<Source>;
  /** The port that looks like this, if this thread can have it. */
  port(info: PortInfo): Promise<SerialPortLike | undefined>;
}

/** Time between two reports of progress, ms. */
const PROGRESS_EVERY = 250;

/** Tries of the handshake, 2 s each, where several speeds are tried. */
const QUICK_TRIES = 3;

/** Filament pushed out before a print goes on at a layer, mm. */
const PURGE = 20;

/** One printer. Requests may come at any time; what they lead to comes as news. */
export class Link {
  readonly #its: Surroundings;
  #port: SerialPortLike | undefined;
  #wire: Wire | undefined;
  #printer: Engine.Printer | undefined;
  #job: { source: Source; outline: Engine.Outline } | undefined;
  /** Speeds not tried yet. */
  #speeds: number[] = [];
  #speed = 0;
  #tries: number | undefined;
  #state: PrinterState = 'offline';
  #log = false;
  #deadline = Number.POSITIVE_INFINITY;
  #timer: ReturnType<typeof setTimeout> | undefined;
  #progressAt = 0;
  /** Why the text of the job could not be read on. */
  #unreadable: string | undefined;
  #last: Promise<void> = Promise.resolve();

  constructor(its: Surroundings) {
    this.#its = its;
  }

  /** Opening, reading and closing wait for each other; commands do not wait. */
  handle(request: PrintRequest): void {
    switch (request.kind) {
      case 'open':
        this.#inTurn(() => this.#open(request.info, request.speeds));
        return;
      case 'read':
        this.#inTurn(() => this.#read(request.text));
        return;
      case 'start':
        this.#inTurn(async () => this.#start(request.begin));
        return;
      case 'close':
        this.#inTurn(() => this.#close());
        return;
      case 'pause':
        this.#command((printer, now) => printer.pause(now));
        return;
      case 'resume':
        this.#command((printer, now) => printer.resume(now));
        return;
      case 'cancel':
        this.#command((printer, now) => printer.cancel(now));
        return;
      case 'stop':
        this.#command((printer, now) => printer.emergency_stop(now));
        return;
      case 'send':
        this.#command((printer, now) => printer.send_line(now, request.line));
        return;
      case 'speed':
        this.#command((printer, now) => printer.set_speed(now, request.percent));
        return;
      case 'flow':
        this.#command((printer, now) => printer.set_flow(now, request.percent));
        return;
      case 'log':
        this.#log = request.on;
        this.#printer?.log_everything(request.on);
        return;
      default:
        request satisfies never;
    }
  }

  #inTurn(work: () => Promise<void>): void {
    this.#last = this.#last.then(work).catch((error: unknown) => this.#broken(error));
  }

  async #open(info: PortInfo, speeds: readonly number[]): Promise<void> {
    await this.#close();
    this.#port = await this.#its.port(info);
    if (this.#port === undefined) return this.#its.news({ kind: 'elsewhere' });
    this.#speeds = [...speeds];
    this.#tries = speeds.length > 1 ? QUICK_TRIES : undefined;
    await this.#tryNext();
  }

  /** Opens the port at the next speed and begins the handshake. */
  async #tryNext(): Promise<void> {
    const speed = this.#speeds.shift();
    if (this.#port === undefined || speed === undefined) return;
    this.#speed = speed;
    this.#its.news({ kind: 'trying', speed });
    try {
      this.#wire = await Wire.open(
        this.#port,
        speed,
        (bytes) => this.#safely(() => this.#received(bytes)),
        () => this.#safely(() => this.#gone()),
      );
    } catch (error) {
      await this.#close();
      this.#its.news({ kind: 'not_open', why: 'refused', message: messageOf(error) });
      return;
    }
    this.#printer = new this.#its.engine.Printer(this.#tries);
    this.#printer.log_everything(this.#log);
    this.#printer.connect(performance.now());
    this.#drive();
  }

  #received(bytes: Uint8Array): void {
    this.#printer?.handle_bytes(performance.now(), bytes);
    this.#drive();
  }

  /** The port is gone without our doing. */
  #gone(): void {
    this.#printer?.handle_closed(performance.now());
    this.#drive();
    this.#inTurn(() => this.#close());
  }

  async #close(): Promise<void> {
    clearTimeout(this.#timer);
    this.#timer = undefined;
    this.#deadline = Number.POSITIVE_INFINITY;
    const wire = this.#wire;
    this.#wire = undefined;
    if (this.#printer !== undefined) {
      this.#printer.handle_closed(performance.now());
      this.#tell(this.#printer);
      this.#printer.free();
      this.#printer = undefined;
    }
    if (wire === undefined) return;
    await wire.close();
    this.#its.news({ kind: 'closed' });
  }

  async #read(text: Blob): Promise<void> {
    try {
      const source = await this.#its.source(text);
      const outline = new this.#its.engine.Outline(this.#watched(source()));
      if (this.#unreadable !== undefined) throw new Error(this.#unreadable);
      this.#job?.outline.free();
      this.#job = { source, outline };
      this.#its.news({ kind: 'outline', outline: JSON.parse(outline.json()) });
    } catch (error) {
      this.#unreadable = undefined;
      this.#its.news({ kind: 'unreadable', message: messageOf(error) });
    }
  }

  #start(begin: Begin): void {
    const job = this.#job;
    if (job === undefined) return;
    this.#command((printer, now) => {
      const pull = this.#watched(job.source());
      switch (begin.kind) {
        case 'start':
          printer.start(now, pull, 0);
          return;
        case 'line':
          printer.start(now, pull, begin.line);
          return;
        case 'layer':
          printer.start_at_layer(now, pull, job.outline, begin.layer, begin.z, PURGE);
          return;
        default:
          return begin satisfies never;
      }
    });
  }

  /** A text that cannot be read on ends for the engine; `#drive` then cancels what would look finished. */
  #watched(pull: () => Uint8Array | undefined): () => Uint8Array | undefined {
    return () => {
      try {
        return pull();
      } catch (error) {
        this.#unreadable = messageOf(error);
        return undefined;
      }
    };
  }

  #command(act: (printer: Engine.Printer, now: number) => void): void {
    const printer = this.#printer;
    if (printer === undefined) return;
    this.#safely(() => {
      try {
        act(printer, performance.now());
      } catch (error) {
        if (!(error instanceof Error && error.name === 'CommandError')) throw error;
        this.#its.news({ kind: 'refused', message: error.message });
      }
      this.#drive();
    });
  }

  /** Polls until empty: the printer's contract. */
  #drive(): void {
    const printer = this.#printer;
    if (printer === undefined) return;
    if (this.#unreadable !== undefined) this.#cancelUnreadable(printer, this.#unreadable);
    this.#transmit(printer);
    this.#tell(printer);
    this.#progress(printer);
    this.#setTimer(printer);
  }

  #transmit(printer: Engine.Printer): void {
    for (let bytes = printer.poll_transmit(); bytes !== undefined; bytes = printer.poll_transmit()) {
      this.#wire?.write(bytes);
    }
  }

  #cancelUnreadable(printer: Engine.Printer, message: string): void {
    this.#unreadable = undefined;
    this.#its.news({ kind: 'unreadable', message });
    printer.cancel(performance.now());
  }

  #tell(printer: Engine.Printer): void {
    const text = printer.poll_events();
    if (text === undefined) return;
    const events = (JSON.parse(text) as PrinterEvent[]).filter((event) => this.#follow(event));
    if (events.length > 0) this.#its.news({ kind: 'events', events });
  }

  /** What an event means for the port; whether the page should hear of it. */
  #follow(event: PrinterEvent): boolean {
    if (event.kind === 'state') this.#state = event.data.to;
    if (event.kind === 'connected') {
      this.#speeds = [];
      this.#its.news({ kind: 'open', speed: this.#speed });
    }
    if (event.kind !== 'stopped' || this.#wire === undefined) return true;
    const { reason } = event.data;
    if (reason.kind === 'no_greeting') {
      this.#inTurn(() => this.#silent());
      return false;
    }
    // Nothing can follow: the port is not left open after an error.
    if (this.#state === 'offline' || this.#state === 'halted') this.#inTurn(() => this.#close());
    return true;
  }

  /** Nothing answered at this speed. */
  async #silent(): Promise<void> {
    const [speeds, port] = [this.#speeds, this.#port];
    await this.#close();
    if (speeds.length === 0 || port === undefined) {
      this.#its.news({ kind: 'not_open', why: 'silent', message: '' });
      return;
    }
    this.#speeds = speeds;
    await this.#tryNext();
  }

  #progress(printer: Engine.Printer): void {
    if (!hasJob(this.#state)) return;
    const now = performance.now();
    if (now - this.#progressAt < PROGRESS_EVERY) return;
    this.#progressAt = now;
    const journal = JSON.parse(printer.journal()) as Journal;
    this.#its.news({ kind: 'progress', journal, resends: printer.resends() });
  }

  /** A timer that comes too early does no harm: it is moved only when it would come too late. */
  #setTimer(printer: Engine.Printer): void {
    const next = printer.poll_timeout() ?? Number.POSITIVE_INFINITY;
    if (next >= this.#deadline || next === Number.POSITIVE_INFINITY) return;
    clearTimeout(this.#timer);
    this.#deadline = next;
    this.#timer = setTimeout(() => this.#safely(() => this.#timeout()), Math.max(0, next - performance.now()));
  }

  #timeout(): void {
    this.#deadline = Number.POSITIVE_INFINITY;
    this.#printer?.handle_timeout(performance.now());
    this.#drive();
  }

  #safely(work: () => void): void {
    try {
      work();
    } catch (error) {
      this.#broken(error);
    }
  }

  /** The engine panicked: it is not called again, and the port does not stay open. */
  #broken(error: unknown): void {
    clearTimeout(this.#timer);
    const wire = this.#wire;
    this.#wire = undefined;
    this.#printer = undefined;
    this.#its.news({ kind: 'broken', message: messageOf(error) });
    void wire?.close();
  }
}

/** A job is under way in this state. */
export function hasJob(state: PrinterState): boolean {
  switch (state) {
    case 'printing':
    case 'finishing':
    case 'parking':
    case 'paused':
    case 'returning':
    case 'cancelling':
      return true;
    case 'offline':
    case 'connecting':
    case 'ready':
    case 'halted':
      return false;
    default:
      return state satisfies never;
  }
}

function messageOf(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}
