// While a job prints: the screen stays on, and leaving the page asks first.

export class Vigil {
  #on = false;
  #lock: WakeLockSentinel | undefined;

  constructor() {
    // The browser takes the lock away from a hidden page; it is asked for again when the page comes back.
    document.addEventListener('visibilitychange', () => void this.#ask());
    addEventListener('beforeunload', (event) => {
      if (this.#on) event.preventDefault();
    });
  }

  keep(on: boolean): void {
    if (on === this.#on) return;
    this.#on = on;
    if (on) void this.#ask();
    else void this.#lock?.release().catch(() => undefined);
  }

  /** Refused at low battery, or where there is no such lock: printing goes on all the same. */
  async #ask(): Promise<void> {
    if (!this.#on || document.visibilityState !== 'visible' || !('wakeLock' in navigator)) return;
    if (this.#lock !== undefined && !this.#lock.released) return;
    this.#lock = await navigator.wakeLock.request('screen').catch(() => undefined);
    if (!this.#on) await this.#lock?.release();
  }
}
