// Settings that a part has of its own: which there can be, by the engine's schema, and how they lie over the plate's.
import settingsSchema from '../../../schema/settings.schema.json';
import type { Changes } from './changes.ts';
import { type Field, type Group, groupsOf, type Schema } from './fields.ts';

const groups = groupsOf(settingsSchema as Schema);
const paths = settingsSchema['x-of-model'];

/** The groups of settings that a part can have of its own; each field's default is what the plate has. */
export function ownGroups(plate: Changes): readonly Group[] {
  const possible = new Set(plate['print.sequence'] === 'by_object' ? paths.by_object : paths.by_layer);
  const ofPlate = (field: Field): Field => ({ ...field, default: plate[field.path] ?? field.default }) as Field;
  return groups
    .map((group) => ({ ...group, fields: group.fields.filter(({ path }) => possible.has(path)).map(ofPlate) }))
    .filter(({ fields }) => fields.length > 0);
}
