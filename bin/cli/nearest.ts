// What a misspelt word was probably meant to be.
import { readFileSync } from 'node:fs';
import { groupsOf, type Schema } from '../../www/src/settings/fields.ts';

/** Names told at most. */
const MOST = 3;

/** `; did you mean ...?` with the names most like `word`; nothing when none is. */
export function hint(word: string, names: readonly string[]): string {
  const near = nearest(word, names);
  return near.length === 0 ? '' : `; did you mean ${near.join(' or ')}?`;
}

/** `hint` for an error that says that a setting is not there; `asked` are the paths that were given. */
export function settingHint(message: string, asked: readonly string[]): string {
  const [, unknown] = /(?:^|: )([\w.]+): there is no such setting$/.exec(message) ?? [];
  if (unknown === undefined) return '';
  const word = asked.find((it) => it === unknown || it.startsWith(`${unknown}.`)) ?? unknown;
  return hint(word, settingPaths());
}

function settingPaths(): readonly string[] {
  const schema = JSON.parse(readFileSync(new URL('./settings.schema.json', import.meta.url), 'utf8')) as Schema;
  return groupsOf(schema).flatMap(({ fields }) => fields.map(({ path }) => path));
}

/** The names with the fewest slips from `word`, if these are few: no more than a third of its letters. */
export function nearest(word: string, names: readonly string[]): readonly string[] {
  const told = names.map((name) => ({ name, slips: slipsTo(word, name) }));
  const fewest = Math.min(...told.map(({ slips }) => slips));
  if (fewest > Math.max(1, word.length / 3)) return [];
  return told
    .filter(({ slips }) => slips === fewest)
    .slice(0, MOST)
    .map(({ name }) => name);
}

/** Slips between a word and a name; a word without dots may mean the last of a name's. */
function slipsTo(word: string, name: string): number {
  const plain = (it: string): string => it.toLowerCase().replaceAll(/[-.]/g, '_');
  const last = name.slice(name.lastIndexOf('.') + 1);
  const meant = word.includes('.') ? [name] : [name, last];
  return Math.min(...meant.map((it) => slips(plain(word), plain(it))));
}

/** Letters to change, put in or leave out to make `b` of `a` (Levenshtein's distance). */
function slips(a: string, b: string): number {
  let row = Array.from({ length: b.length + 1 }, (_, k) => k);
  for (const [i, letter] of [...a].entries()) {
    const next = [i + 1];
    for (let k = 0; k < b.length; k++) {
      const swapped = (row[k] ?? 0) + (letter === b[k] ? 0 : 1);
      next.push(Math.min(swapped, (row[k + 1] ?? 0) + 1, (next[k] ?? 0) + 1));
    }
    row = next;
  }
  return row[b.length] ?? 0;
}
