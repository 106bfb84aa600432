import { expect, test } from 'vitest';
import { hint, nearest } from '../../bin/cli/nearest.ts';

const paths = [
  'layers.height',
  'layers.first_height',
  'printer.height',
  'infill.density',
  'walls.count',
  'orientation.layer_height',
];

test.each([
  ['layer.height', ['layers.height']],
  ['layers.hieght', ['layers.height']],
  ['infil_density', ['infill.density']],
  ['height', ['layers.height', 'printer.height']],
  ['Walls.Count', ['walls.count']],
  ['colour', []],
  ['x', []],
])('%s', (word, names) => {
  expect(nearest(word, paths)).toEqual(names);
});

test('a hint names what is near, or nothing', () => {
  expect(hint('height', paths)).toBe('; did you mean layers.height or printer.height?');
  expect(hint('colour', paths)).toBe('');
});
