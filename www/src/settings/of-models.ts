// Settings of single models in a settings file: the file names models, on the bed each part has its own.
import { stem } from '../files/files.ts';
import { hasOwn, type Part } from '../parts.ts';
import { asSettings, type Changes } from './changes.ts';

/** What the parts have of their own, by the models' names; `unlike` are models whose parts differ, which no name tells apart. */
export interface OfModels {
  readonly models: Readonly<Record<string, object>>;
  readonly unlike: readonly string[];
}

/** The own settings of the parts as a file holds them; `files` are the names of the open models' files. */
export function ofModels(parts: readonly Part[], files: readonly string[]): OfModels {
  const named = new Map<string, Part[]>();
  for (const part of parts) {
    const name = nameIn(files, part.model);
    named.set(name, [...(named.get(name) ?? []), part]);
  }
  const alike = [...named].filter(([, all]) => new Set(all.map(({ own = {} }) => sorted(own))).size === 1);
  const models: Record<string, object> = {};
  for (const [name, [part]] of alike) {
    if (part?.own !== undefined && hasOwn(part)) models[name] = JSON.parse(asSettings(part.own)) as object;
  }
  return {
    models,
    unlike: [...named.keys()].filter((name) => !alike.some(([it]) => it === name)),
  };
}

/** The parts with the own settings that a file gives their models; `unknown` are the names of no open model. */
export function withModels(
  parts: readonly Part[],
  files: readonly string[],
  models: Readonly<Record<string, Changes>>,
): { readonly parts: readonly Part[]; readonly unknown: readonly string[] } {
  const isNamed = (name: string, file: string): boolean => name === file || name === stem(file);
  const given = ({ model }: Part): Changes | undefined => {
    const found = Object.entries(models).filter(([name]) => isNamed(name, files[model] ?? ''));
    return found.length === 0 ? undefined : Object.assign({}, ...found.map(([, own]) => own));
  };
  const all = parts.map((part) => {
    const own = given(part);
    return own === undefined ? part : { ...part, own };
  });
  return { parts: all, unknown: Object.keys(models).filter((name) => !files.some((file) => isNamed(name, file))) };
}

/** The name without its ending, unless another file has the same one with another ending. */
function nameIn(files: readonly string[], model: number): string {
  const file = files[model] ?? '';
  const same = new Set(files.filter((it) => stem(it) === stem(file)));
  return same.size > 1 ? file : stem(file);
}

const sorted = (own: Changes): string => JSON.stringify(Object.entries(own).toSorted(([a], [b]) => (a < b ? -1 : 1)));
