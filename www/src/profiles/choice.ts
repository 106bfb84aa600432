// Profiles as changes of the form: choosing one writes its settings, and one is chosen while all of its settings hold.
import { type Changes, same } from '../settings/changes.ts';
import type { Value } from '../settings/fields.ts';
import { allFields } from '../settings/room.ts';
import { type Kind, materials, type Profile, printers, qualities } from './catalog.ts';
import type { Layers } from './layers.ts';

/** What the page offers. */
export const offered: Readonly<Record<Kind, readonly Profile[]>> = {
  printer: printers,
  material: materials,
  quality: qualities,
};

/** From the lowest: each lies over those before. */
const kinds: readonly Kind[] = ['printer', 'material', 'quality'];

const fields = new Map(allFields.map((field) => [field.path, field]));

/** The profiles whose settings all hold, but for those that a profile above them sets. */
export function chosenIn(changes: Changes): Layers {
  const above = new Set<string>();
  const chosen: Record<string, string> = {};
  for (const kind of kinds.toReversed()) {
    const found = offered[kind].find((it) => holds(changes, it, above));
    if (found === undefined) continue;
    chosen[kind] = found.id;
    for (const [path] of valuesOf(found)) above.add(path);
  }
  return chosen;
}

/** The changes with another profile of this kind, or with none of it. */
export function withProfile(changes: Changes, kind: Kind, id: string | undefined): Changes {
  const layers = { ...chosenIn(changes), [kind]: id };
  const own = new Set(offered[kind].flatMap(valuesOf).map(([path]) => path));
  const left = Object.fromEntries(Object.entries(changes).filter(([path]) => !own.has(path)));
  const values = kinds.flatMap((it) => offered[it].filter((profile) => profile.id === layers[it]).flatMap(valuesOf));
  const set = new Map(values);
  const others = Object.entries(left).filter(([path]) => !set.has(path));
  const unlike = [...set].filter(([path, value]) => !same(fields.get(path)?.default, value));
  return Object.fromEntries([...others, ...unlike]);
}

/** Whether a profile sets exactly this; some set what is no field of the form, such as forbidden zones. */
export function isOfProfile(path: string, value: Value): boolean {
  const all = Object.values(offered).flatMap((profiles) => profiles.flatMap(valuesOf));
  return all.some(([its, set]) => its === path && same(set, value));
}

/** Of all settings those that a profile has set and the form does not show. */
export function besideForm(settings: object): Changes {
  return Object.fromEntries(
    leaves(settings, '').filter(([path, value]) => !fields.has(path) && isOfProfile(path, value)),
  );
}

function holds(changes: Changes, profile: Profile, above: ReadonlySet<string>): boolean {
  return valuesOf(profile).every(
    ([path, value]) => above.has(path) || same(changes[path] ?? fields.get(path)?.default, value),
  );
}

function valuesOf({ settings }: Profile): [string, Value][] {
  return leaves(settings, '');
}

/** Nested settings as values by path. */
export function flattened(settings: object): Changes {
  return Object.fromEntries(leaves(settings, ''));
}

function leaves(settings: object, path: string): [string, Value][] {
  return Object.entries(settings).flatMap(([name, value]: [string, unknown]): [string, Value][] => {
    const here = path === '' ? name : `${path}.${name}`;
    const isGroup = typeof value === 'object' && value !== null && !Array.isArray(value);
    return isGroup ? leaves(value, here) : [[here, value as Value]];
  });
}
