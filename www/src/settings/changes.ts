// What the user set differently from the defaults, by path.
import type { Field, Value } from './fields.ts';

export type Changes = Readonly<Record<string, Value>>;

/** The changes with one more; a value that is the default is no change. */
export function withChange(changes: Changes, field: Field, value: Value): Changes {
  const { [field.path]: _, ...others } = changes;
  return same(value, field.default) ? others : { ...others, [field.path]: value };
}

/** The changes as a nested settings file. */
export function asSettings(changes: Changes): string {
  const root: Record<string, unknown> = {};
  for (const [path, value] of Object.entries(changes)) {
    const names = path.split('.');
    const last = names.pop() ?? path;
    const group = names.reduce<Record<string, unknown>>((at, name) => {
      at[name] ??= {};
      return at[name] as Record<string, unknown>;
    }, root);
    group[last] = value;
  }
  return JSON.stringify(root);
}

/** The changes that a nested settings file makes; what it says of settings that are no fields is passed over. */
export function asChanges(settings: unknown, fields: readonly Field[]): Changes {
  return fields.reduce<Changes>((changes, field) => {
    const value = field.path.split('.').reduce<unknown>((at, name) => {
      return typeof at === 'object' && at !== null ? (at as Record<string, unknown>)[name] : undefined;
    }, settings);
    return value === undefined || value === null ? changes : withChange(changes, field, value as Value);
  }, {});
}

/** What an input's text means for its field; undefined when it means nothing. */
export function parse(field: Field, text: string): Value | undefined {
  switch (field.kind) {
    case 'number':
      return number(text);
    case 'numbers': {
      const values = text
        .split(/[;x×\s]+|,(?!\d)/)
        .filter((it) => it !== '')
        .map(number);
      return values.length === field.default.length && values.every((it) => it !== undefined) ? values : undefined;
    }
    case 'switch':
      return text === 'true';
    case 'choice':
    case 'text':
      return text;
    default:
      return field satisfies never;
  }
}

/** Why a value can't be: outside the field's limits, or not a whole number. Empty when it can. */
export function fault(field: Field, value: Value | undefined): 'range' | 'whole' | 'number' | undefined {
  if (field.kind !== 'number' && field.kind !== 'numbers') return undefined;
  if (value === undefined) return 'number';
  const values = Array.isArray(value) ? value.map(Number) : [Number(value)];
  if (field.kind === 'number' && field.whole && !values.every(Number.isInteger)) return 'whole';
  const { low = Number.NEGATIVE_INFINITY, high = Number.POSITIVE_INFINITY } = field;
  return values.every((it) => it >= low && it <= high) ? undefined : 'range';
}

function number(text: string): number | undefined {
  const value = Number(text.replace(',', '.'));
  return text.trim() === '' || !Number.isFinite(value) ? undefined : value;
}

/** Whether two things are the same as JSON. */
export const same = (a: unknown, b: unknown): boolean => a === b || JSON.stringify(a) === JSON.stringify(b);
