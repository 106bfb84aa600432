// The settings form's fields, read from the engine's JSON Schema: the page knows no setting by itself.

/** The part of JSON Schema that the engine's settings use. */
export interface Schema {
  readonly $ref?: string;
  readonly $defs?: Readonly<Record<string, Schema>>;
  readonly allOf?: readonly Schema[];
  readonly type?: string | readonly string[];
  readonly title?: string;
  readonly description?: string;
  readonly default?: unknown;
  readonly minimum?: number;
  readonly maximum?: number;
  readonly enum?: readonly unknown[];
  readonly const?: unknown;
  readonly oneOf?: readonly Schema[];
  readonly items?: Schema;
  readonly properties?: Readonly<Record<string, Schema>>;
  readonly 'x-unit'?: string;
}

export type Value = string | number | boolean | readonly number[];

interface Common {
  /** Dotted path, such as `walls.count`. */
  readonly path: string;
  readonly label: string;
  readonly help: string;
}

export interface Choice {
  readonly value: string;
  readonly help: string;
}

export type Field =
  | (Common & { readonly kind: 'number'; readonly whole: boolean; readonly default: number } & Limits)
  | (Common & { readonly kind: 'numbers'; readonly default: readonly number[] } & Limits)
  | (Common & { readonly kind: 'choice'; readonly choices: readonly Choice[]; readonly default: string })
  | (Common & { readonly kind: 'switch'; readonly default: boolean })
  | (Common & { readonly kind: 'text'; readonly default: string });

interface Limits {
  readonly unit: string;
  readonly low: number | undefined;
  readonly high: number | undefined;
}

/** A stage's fields, or those of a group inside it. */
export interface Group {
  readonly path: string;
  readonly label: string;
  readonly fields: readonly Field[];
}

/** All groups that have fields, in the schema's order. */
export function groupsOf(schema: Schema): Group[] {
  return walk(schema, '', schema.default, schema.$defs ?? {}).filter(({ fields }) => fields.length > 0);
}

type Definitions = Readonly<Record<string, Schema>>;

function walk(schema: Schema, path: string, defaults: unknown, definitions: Definitions): Group[] {
  const entries = Object.entries(schema.properties ?? {}).map(([name, raw]) => {
    const it = resolved(raw, definitions);
    const value = raw.default ?? it.default ?? member(defaults, name);
    return { schema: it, path: path === '' ? name : `${path}.${name}`, value };
  });
  const fields = entries.map((it) => fieldOf(it.schema, it.path, it.value)).filter((it) => it !== undefined);
  const inner = entries
    .filter((it) => it.schema.properties !== undefined)
    .flatMap((it) => walk(it.schema, it.path, it.value, definitions));
  return [{ path, label: words(path), fields }, ...inner];
}

/** The schema with its references followed; what stands beside a reference wins. */
function resolved(schema: Schema, definitions: Definitions): Schema {
  const reference = schema.$ref ?? schema.allOf?.[0]?.$ref;
  if (reference === undefined) return schema;
  const target = definitions[reference.replace('#/$defs/', '')];
  return target === undefined ? schema : { ...resolved(target, definitions), ...schema };
}

function fieldOf(schema: Schema, path: string, value: unknown): Field | undefined {
  const common = { path, label: schema.title ?? words(path), help: tidy(schema.description) };
  const choices = choicesOf(schema);
  if (choices !== undefined) return { ...common, kind: 'choice', choices, default: String(value ?? '') };
  switch (schema.type) {
    case 'number':
    case 'integer':
      return {
        ...common,
        ...limits(schema),
        kind: 'number',
        whole: schema.type === 'integer',
        default: Number(value ?? 0),
      };
    case 'array':
      // Lists of groups and of lists, such as events at layers and forbidden zones, are edited in a settings file.
      if (schema.items?.$ref !== undefined || schema.items?.type === 'array') return undefined;
      return { ...common, ...limits(schema), kind: 'numbers', default: Array.isArray(value) ? value.map(Number) : [] };
    case 'boolean':
      return { ...common, kind: 'switch', default: value === true };
    case 'string':
      return { ...common, kind: 'text', default: String(value ?? '') };
    default:
      return undefined;
  }
}

function choicesOf({ enum: words, oneOf }: Schema): Choice[] | undefined {
  if (words !== undefined) return words.map((value) => ({ value: String(value), help: '' }));
  return oneOf?.flatMap((it) => {
    if (it.const !== undefined) return [{ value: String(it.const), help: tidy(it.description) }];
    return (it.enum ?? []).map((value) => ({ value: String(value), help: tidy(it.description) }));
  });
}

function limits(schema: Schema): Limits {
  const inner = schema.items;
  return {
    unit: schema['x-unit'] ?? '',
    low: schema.minimum ?? inner?.minimum,
    high: schema.maximum ?? inner?.maximum,
  };
}

/** The path of the setting that an error of the engine is about: its message begins with it. */
export function pathIn(message: string): string | undefined {
  return /^([a-z]\w*(?:\.[a-z]\w*)+): /.exec(message)?.[1];
}

/** The last part of a path as a label: `first_layer` -> "First layer". */
export function words(path: string): string {
  const last = path.split('.').at(-1)?.replaceAll('_', ' ') ?? '';
  return last.charAt(0).toUpperCase() + last.slice(1);
}

const tidy = (text: string | undefined): string => (text ?? '').replaceAll(/\s+/g, ' ').replaceAll('`', '').trim();

function member(value: unknown, name: string): unknown {
  return typeof value === 'object' && value !== null ? (value as Record<string, unknown>)[name] : undefined;
}
