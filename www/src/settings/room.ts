// The settings that the page itself needs: how large the printer is, and where on its bed X0 Y0 is.
import settingsSchema from '../../../schema/settings.schema.json';
import type { Room } from '../parts.ts';
import type { Changes } from './changes.ts';
import { type Field, groupsOf, type Schema, type Value } from './fields.ts';

/** Every setting. */
export const allFields: readonly Field[] = groupsOf(settingsSchema as Schema).flatMap(({ fields }) => fields);

const defaults = new Map<string, Value>(allFields.map((field) => [field.path, field.default]));

/** The bed and the printer's height as the settings say. */
export function roomOf(changes: Changes): Room {
  const value = (path: string): Value => changes[path] ?? defaults.get(path) ?? 0;
  const bed = value('printer.bed_size');
  const [width = 0, depth = 0] = Array.isArray(bed) ? (bed as readonly number[]) : [];
  const [x, y] = value('printer.origin') === 'center' ? [-width / 2, -depth / 2] : [0, 0];
  return [width, depth, Number(value('printer.height')), x, y, value('printer.bed_shape') === 'round'];
}
