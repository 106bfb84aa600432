// The page's end of the print lane: a worker that has the port, or the same module in the page.
import wasmUrl from '../generated/link/foothold_link_bg.wasm?url';
import { compiledOnce } from '../slicer/compile.ts';
import { startWorker } from '../slicer/start-worker.ts';
import type { Link } from './link.ts';
import type { PrintNews, PrintRequest, ToPrintLane } from './messages.ts';
import type { SerialPortLike } from './port.ts';
import script from './print.worker.ts?worker&url';

/** Fetches and compiles the serial protocol. */
const compileLink = compiledOnce(wasmUrl);

export class PrintLane {
  readonly #news: (news: PrintNews) => void;
  #worker: Promise<Worker> | undefined;
  #local: Promise<Link> | undefined;
  #open: Extract<PrintRequest, { kind: 'open' }> | undefined;
  #port: SerialPortLike | undefined;

  constructor(news: (news: PrintNews) => void) {
    this.#news = news;
  }

  /** Opens this port: in the worker, if it can have it. */
  open(port: SerialPortLike, speeds: readonly number[]): void {
    this.#port = port;
    this.#open = { kind: 'open', info: port.getInfo(), speeds };
    this.#local = undefined;
    this.send(this.#open);
  }

  send(request: PrintRequest): void {
    if (this.#local !== undefined) {
      void this.#local.then((link) => link.handle(request));
      return;
    }
    this.#worker ??= this.#start();
    void this.#worker.then(
      (worker) => worker.postMessage({ request } satisfies ToPrintLane),
      (error: Error) => this.#hear({ kind: 'broken', message: error.message }),
    );
  }

  /** Ends the lane at once; the port closes with it. */
  close(): void {
    void this.#local?.then((link) => link.handle({ kind: 'close' }));
    this.#end();
  }

  async #start(): Promise<Worker> {
    const worker = startWorker(script);
    worker.onmessage = ({ data }: MessageEvent<PrintNews>) => this.#hear(data);
    worker.onerror = (event) => this.#hear({ kind: 'broken', message: event.message });
    worker.postMessage({ start: await compileLink() } satisfies ToPrintLane);
    return worker;
  }

  #hear(news: PrintNews): void {
    if (news.kind === 'elsewhere' && this.#open !== undefined) {
      this.#local = this.#here();
      this.send(this.#open);
      return;
    }
    if (news.kind === 'broken') this.#end();
    this.#news(news);
  }

  /** A broken lane is not trusted any more; the next request starts a new one. */
  #end(): void {
    void this.#worker?.then((worker) => worker.terminate());
    this.#worker = undefined;
    this.#local = undefined;
  }

  async #here(): Promise<Link> {
    const [{ linkInPage }, module] = await Promise.all([import('./page-link.ts'), compileLink()]);
    return linkInPage(
      module,
      () => this.#port,
      (news) => this.#hear(news),
    );
  }
}
