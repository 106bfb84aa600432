// The words of the page in the chosen language. `t` is a live binding: read it where it is shown, never keep it.
import { de } from './de.ts';
import { en, type Words } from './en.ts';
import { zh } from './zh.ts';

/** All languages, by the code that a browser names them with; each is named in its own words. */
export const tables = { en, de, zh } as const satisfies Readonly<Record<string, Words>>;

export type Language = keyof typeof tables;

export const languages = Object.keys(tables) as readonly Language[];

export let t: Words = en;

let language: Language = 'en';

/** The language that `t` speaks. */
export const spoken = (): Language => language;

const listeners = new Set<() => void>();

/** Changes the language; whoever listens draws anew. */
export function speak(chosen: Language): void {
  language = chosen;
  t = tables[chosen];
  for (const listener of listeners) listener();
}

/** Calls `listener` at every change of language, until the function returned is called. */
export function onLanguage(listener: () => void): () => void {
  listeners.add(listener);
  return () => listeners.delete(listener);
}

/** The first of the wished languages (`de-AT`, `fr`) that the page speaks; English when it speaks none. */
export function closest(wished: readonly string[]): Language {
  const codes = wished.map((it) => it.toLowerCase().split('-')[0]);
  return codes.map((code) => languages.find((it) => it === code)).find((it) => it !== undefined) ?? 'en';
}
