// While a job prints: the screen stays on, and leaving the page asks first.

export class Vigil {
  #on = false;
  #lock: WakeLockSentinel | undefined;
  readonly #end = new AbortController();

  constructor() {
    const { signal } = this.#end;
    // The browser takes the lock away from a hidden page; it is asked for again when the page comes back.
    document.addEventListener('visibilitychange', () => void this.#ask(), { signal });
    const guard = (event: Event): void => {
      if (this.#on) event.preventDefault();
    };
    addEventListener('beforeunload', guard, { signal });
  }

  keep(on: boolean): void {
    if (on === this.#on) return;
    this.#on = on;
    if (on) void this.#ask();
    else void this.#lock?.release().catch(() => undefined);
  }

  /** Watches nothing any more. */
  close(): void {
    this.keep(false);
    this.#end.abort();
  }

  /** Refused at low battery, or where there is no such lock: printing goes on all the same. */
  async #ask(): Promise<void> {
    if (!this.#on || document.visibilityState !== 'visible' || !('wakeLock' in navigator)) return;
    if (this.#lock !== undefined && !this.#lock.released) return;
    this.#lock = await navigator.wakeLock.request('screen').catch(() => undefined);
    if (!this.#on) await this.#lock?.release();
  }
}
