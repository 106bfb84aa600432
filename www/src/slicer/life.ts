// Whether a worker still lives: a browser that ends one does not say so. The worker holds a lock while it lives, and
// the page, which waits for that lock, gets it when the worker has ended in whatever way.

/** What a worker says once it holds its lock. */
export interface Alive {
  /** The lock's name. */
  readonly alive: string;
}

/** In a worker: holds a lock as long as it lives. Pages that have no locks (insecure ones) do without. */
export function live(post: (message: Alive) => void): void {
  const alive = `foothold ${Math.random()}`;
  const hold = (): Promise<never> => {
    post({ alive });
    return new Promise(() => undefined);
  };
  navigator.locks?.request(alive, hold).catch(() => undefined);
}

export const isAlive = (message: unknown): message is Alive =>
  typeof message === 'object' && message !== null && 'alive' in message;

/** In the page: calls `ended` when the worker that said so has ended. */
export function watch({ alive }: Alive, ended: () => void): void {
  navigator.locks.request(alive, ended).catch(() => undefined);
}
