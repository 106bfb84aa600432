// What an element asks the engine for, again whenever the question changes; only the last answer counts.
import type { ReactiveController, ReactiveControllerHost } from 'lit';
import { problemOf } from '../session.ts';
import type { Problem } from '../state.ts';

/** While a person drags a slider, questions are held back this long, ms. */
const PAUSE = 90;

export class Asked<T> implements ReactiveController {
  /** The last answer; it stays while the next one is worked out. */
  answer: T | undefined;
  problem: Problem | undefined;
  waiting = false;
  readonly #host: ReactiveControllerHost;
  #key: string | undefined;
  #timer: ReturnType<typeof setTimeout> | undefined;

  constructor(host: ReactiveControllerHost) {
    this.#host = host;
    host.addController(this);
  }

  hostDisconnected(): void {
    clearTimeout(this.#timer);
    this.#key = undefined;
  }

  /** Asks when `key` is another one than the last time; an undefined key forgets the answer. */
  want(key: string | undefined, ask: () => Promise<T>): void {
    if (key === this.#key) return;
    this.#key = key;
    clearTimeout(this.#timer);
    this.waiting = key !== undefined;
    if (key === undefined) {
      this.answer = undefined;
      this.problem = undefined;
      return;
    }
    this.#timer = setTimeout(() => void this.#ask(key, ask), PAUSE);
  }

  async #ask(key: string, ask: () => Promise<T>): Promise<void> {
    const told = (change: { answer?: T; problem?: Problem }): void => {
      if (this.#key !== key) return;
      this.waiting = false;
      this.problem = change.problem;
      if (change.problem === undefined) this.answer = change.answer;
      this.#host.requestUpdate();
    };
    try {
      told({ answer: await ask() });
    } catch (error) {
      told({ problem: problemOf(error) });
    }
  }
}

let counted = 0;
const numbers = new WeakMap<object, number>();

/** A number for an object, so that it can be part of a key. */
export function numberOf(it: object): number {
  const known = numbers.get(it);
  if (known !== undefined) return known;
  counted += 1;
  numbers.set(it, counted);
  return counted;
}
