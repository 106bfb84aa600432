// Frames that the graphics card has been told to draw and has not finished: no more of them than it can take, and how
// long each one took.

/** Frames that may be under way: one is drawn while the next is told. */
const MOST = 2;

interface Frame {
  readonly began: number;
  readonly isUsual: boolean;
  /** Signalled when the card is done with the frame; null when its context is lost. */
  readonly done: WebGLSync | null;
}

export class FrameQueue {
  readonly #gl: WebGL2RenderingContext;
  #frames: Frame[] = [];
  /** When the last frame was seen to be done, ms. */
  #last = 0;

  constructor(gl: WebGL2RenderingContext) {
    this.#gl = gl;
  }

  isEmpty(): boolean {
    return this.#frames.length === 0;
  }

  isFull(): boolean {
    return this.#frames.length >= MOST;
  }

  /** A frame has been told at `began`, ms; its time is told later if it is a usual one. */
  add(began: number, isUsual: boolean): void {
    this.#frames.push({ began, isUsual, done: this.#gl.fenceSync(this.#gl.SYNC_GPU_COMMANDS_COMPLETE, 0) });
    this.#gl.flush();
  }

  /** Forgets the frames that are done at `now`, and tells the time of each, ms, without its wait for the one before. */
  settle(now: number, tell: (ms: number) => void): void {
    for (let frame = this.#frames[0]; frame !== undefined && this.#isDone(frame); frame = this.#frames[0]) {
      this.#frames.shift();
      this.#gl.deleteSync(frame.done);
      if (frame.isUsual) tell(now - Math.max(frame.began, this.#last));
      this.#last = now;
    }
  }

  #isDone({ done }: Frame): boolean {
    return done === null || this.#gl.getSyncParameter(done, this.#gl.SYNC_STATUS) !== this.#gl.UNSIGNALED;
  }
}
