import { expect, test } from 'vitest';
import { asSettings, fault, parse, withChange } from '../../www/src/settings/changes.ts';
import { type Field, groupsOf, type Schema } from '../../www/src/settings/fields.ts';

const schema: Schema = {
  properties: {
    walls: { $ref: '#/$defs/Walls', default: { count: 3, width: 0.45, skirt: { loops: 1 } } },
    printer: { $ref: '#/$defs/Printer' },
  },
  $defs: {
    Walls: {
      type: 'object',
      properties: {
        count: {
          type: 'integer',
          title: 'Walls',
          description: 'Number of\nloops.',
          minimum: 0,
          maximum: 50,
          'x-unit': '',
        },
        width: { type: 'number', title: 'Line width', minimum: 0.1, maximum: 2, 'x-unit': 'mm' },
        skirt: { $ref: '#/$defs/Skirt' },
      },
    },
    Skirt: { type: 'object', properties: { loops: { type: 'integer', title: 'Loops' } } },
    Printer: {
      type: 'object',
      properties: {
        bed_size: {
          type: 'array',
          items: { type: 'number' },
          title: 'Bed',
          default: [220, 220],
          minimum: 10,
          maximum: 999,
        },
        flavor: { $ref: '#/$defs/Flavor', default: 'marlin' },
        fan: { type: 'boolean', default: true },
        start_gcode: { type: 'string', default: 'G28' },
      },
    },
    Flavor: { oneOf: [{ const: 'marlin', description: 'Marlin' }, { enum: ['klipper', 'prusa'] }] },
  },
};

const fields = groupsOf(schema).flatMap((group) => group.fields);
const field = (path: string): Field => {
  const found = fields.find((it) => it.path === path);
  if (found === undefined) throw new Error(`no field ${path}`);
  return found;
};

test('groups follow the schema, nested ones after their stage', () => {
  expect(groupsOf(schema).map((it) => [it.label, it.fields.length])).toEqual([
    ['Walls', 2],
    ['Skirt', 1],
    ['Printer', 4],
  ]);
});

test('a field has its label, limits, unit, help and default', () => {
  expect(field('walls.count')).toEqual({
    kind: 'number',
    path: 'walls.count',
    label: 'Walls',
    help: 'Number of loops.',
    whole: true,
    unit: '',
    low: 0,
    high: 50,
    default: 3,
  });
  expect(field('walls.skirt.loops').default).toBe(1);
  expect(field('printer.bed_size')).toMatchObject({ kind: 'numbers', default: [220, 220], high: 999 });
  expect(field('printer.fan')).toMatchObject({ kind: 'switch', default: true });
  expect(field('printer.flavor')).toMatchObject({ label: 'Flavor', default: 'marlin' });
  expect(field('printer.flavor')).toHaveProperty('choices.length', 3);
});

test('changes nest by path, and a default is no change', () => {
  let changes = withChange({}, field('walls.count'), 2);
  changes = withChange(changes, field('printer.bed_size'), [100, 120]);
  expect(JSON.parse(asSettings(changes))).toEqual({ walls: { count: 2 }, printer: { bed_size: [100, 120] } });
  expect(withChange(changes, field('walls.count'), 3)).toEqual({ 'printer.bed_size': [100, 120] });
});

test('texts become values, a decimal comma too', () => {
  expect(parse(field('walls.width'), '0,4')).toBe(0.4);
  expect(parse(field('walls.width'), 'wide')).toBeUndefined();
  expect(parse(field('walls.width'), '')).toBeUndefined();
  expect(parse(field('printer.bed_size'), '100 x 120')).toEqual([100, 120]);
  expect(parse(field('printer.bed_size'), '100, 120')).toEqual([100, 120]);
  expect(parse(field('printer.bed_size'), '100')).toBeUndefined();
  expect(parse(field('printer.fan'), 'false')).toBe(false);
});

test('faults: outside the limits, not whole, not a number', () => {
  expect(fault(field('walls.count'), 51)).toBe('range');
  expect(fault(field('walls.count'), 2.5)).toBe('whole');
  expect(fault(field('walls.width'), undefined)).toBe('number');
  expect(fault(field('walls.width'), 0.1)).toBeUndefined();
  expect(fault(field('printer.bed_size'), [100, 5])).toBe('range');
});
