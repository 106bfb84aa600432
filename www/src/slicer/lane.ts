// A lane runs one instance of the engine: in this thread or in another one.
import type {
  Failure,
  FromLane,
  HelperReply,
  HelperRequest,
  LeadReply,
  LeadRequest,
  ReplyTo,
  Tagged,
  ToLane,
  ViewReply,
  ViewRequest,
} from '../messages.ts';
import { EngineError, laneDied, toFailure } from './errors.ts';

export interface Lane<Q extends Tagged, A extends Tagged> {
  /** Requests are answered in order. Rejects with an EngineError. */
  call<R extends Q>(request: R, transfer?: Transferable[]): Promise<ReplyTo<A, R['kind']>>;
  /** Ends the lane at once; open and later calls reject. */
  close(): void;
}

export type LeadLane = Lane<LeadRequest, LeadReply>;
export type HelperLane = Lane<HelperRequest, HelperReply>;
export type ViewLane = Lane<ViewRequest, ViewReply>;

/** The end of a thread's message channel, page worker or Node worker. */
export interface Port {
  post(message: unknown, transfer: Transferable[]): void;
  listen(message: (data: unknown) => void, died: (reason: string) => void): void;
  close(): void;
}

interface Waiting {
  resolve(reply: Tagged): void;
  reject(error: Error): void;
}

/** A lane in another thread. */
export class ThreadLane<Q extends Tagged, A extends Tagged> implements Lane<Q, A> {
  readonly #port: Port;
  readonly #waiting = new Map<number, Waiting>();
  #next = 0;
  #dead: EngineError | undefined;

  constructor(port: Port, module: WebAssembly.Module, files?: string) {
    this.#port = port;
    port.listen(
      (data) => this.#receive(data as FromLane<A>),
      (reason) => this.#die(laneDied(reason)),
    );
    this.#post({ start: module, files }, []);
  }

  call<R extends Q>(request: R, transfer: Transferable[] = []): Promise<ReplyTo<A, R['kind']>> {
    return new Promise((resolve, reject) => {
      if (this.#dead !== undefined) return reject(this.#dead);
      const id = this.#next++;
      this.#waiting.set(id, { resolve: (reply) => resolve(reply as ReplyTo<A, R['kind']>), reject });
      this.#post({ id, request }, transfer);
    });
  }

  close(): void {
    this.#die(laneDied('the lane was closed'));
  }

  #post(message: ToLane<Q>, transfer: Transferable[]): void {
    this.#port.post(message, transfer);
  }

  #receive(message: FromLane<A>): void {
    const waiting = this.#waiting.get(message.id);
    this.#waiting.delete(message.id);
    if ('reply' in message) {
      waiting?.resolve(message.reply);
      return;
    }
    const error = new EngineError(message.failure);
    waiting?.reject(error);
    if (error.fatal) this.#die(error);
  }

  #die(error: EngineError): void {
    if (this.#dead !== undefined) return;
    this.#dead = error;
    this.#port.close();
    for (const waiting of this.#waiting.values()) waiting.reject(error);
    this.#waiting.clear();
  }
}

/** What answers requests inside a lane. */
export type Handler<Q extends Tagged, A extends Tagged> = (request: Q) => Promise<A> | A;

/** A lane in this thread; between two calls the thread's other work has its turn. */
export class LocalLane<Q extends Tagged, A extends Tagged> implements Lane<Q, A> {
  readonly #handler: Handler<Q, A>;
  readonly #pause: () => Promise<void>;
  #last: Promise<unknown> = Promise.resolve();
  #dead: EngineError | undefined;

  constructor(handler: Handler<Q, A>, pause: () => Promise<void>) {
    this.#handler = handler;
    this.#pause = pause;
  }

  call<R extends Q>(request: R): Promise<ReplyTo<A, R['kind']>> {
    const turn = this.#last.then(() => this.#run(request));
    this.#last = turn.catch(() => undefined);
    return turn as Promise<ReplyTo<A, R['kind']>>;
  }

  close(): void {
    this.#dead ??= laneDied('the lane was closed');
  }

  async #run(request: Q): Promise<A> {
    await this.#pause();
    if (this.#dead !== undefined) throw this.#dead;
    try {
      return await this.#handler(request);
    } catch (error) {
      const known = new EngineError(toFailure(error));
      if (known.fatal) this.#dead = known;
      throw known;
    }
  }
}

/** The inside of a lane in another thread: starts the engine, then answers requests one after another. */
export function serve<Q extends Tagged, A extends Tagged>(
  start: (module: WebAssembly.Module, files: string) => Handler<Q, A>,
  post: (message: FromLane<A>, transfer: Transferable[]) => void,
): (message: ToLane<Q>) => void {
  let handler: Handler<Q, A> | undefined;
  let broken: Failure | undefined;
  let last: Promise<void> = Promise.resolve();

  const answer = async (id: number, request: Q): Promise<void> => {
    if (broken !== undefined || handler === undefined) {
      post({ id, failure: broken ?? toFailure(new Error('the engine was not started')) }, []);
      return;
    }
    try {
      const reply = await handler(request);
      post({ id, reply }, transferables(reply));
    } catch (error) {
      const failure = toFailure(error);
      if (failure.fatal) broken = failure;
      post({ id, failure }, []);
    }
  };

  return (message) => {
    if ('start' in message) {
      try {
        handler = start(message.start, message.files ?? '');
      } catch (error) {
        broken = toFailure(error);
      }
      return;
    }
    last = last.then(() => answer(message.id, message.request));
  };
}

/** The buffers and bitmaps of a message, which move to the other side and are not copied. */
export function transferables(message: object): Transferable[] {
  return Object.values(message).flatMap((value: unknown): Transferable[] => {
    if (ArrayBuffer.isView(value) && value.buffer instanceof ArrayBuffer) return [value.buffer];
    if (typeof ImageBitmap !== 'undefined' && value instanceof ImageBitmap) return [value];
    return [];
  });
}
