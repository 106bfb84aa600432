// Settings of single models: from the parts to a settings file and back; how large files may be together.
import { expect, test } from 'vitest';
import { refuseTooLargeTogether } from '../../www/src/files/files.ts';
import { type Part, UNMOVED } from '../../www/src/parts.ts';
import { parseSaved } from '../../www/src/profiles/layers.ts';
import type { Changes } from '../../www/src/settings/changes.ts';
import { ofModels, withModels } from '../../www/src/settings/of-models.ts';

const part = (id: number, model: number, own?: Changes): Part => {
  const bare = { id, model, matrix: UNMOVED, box: [0, 0, 0, 1, 1, 1] };
  return own === undefined ? bare : { ...bare, own };
};
const files = ['cube.stl', 'round.stl', 'cube.obj'];

test('what parts have of their own comes back from a file', () => {
  const parts = [part(1, 0, { 'walls.count': 5, 'infill.density': 1 }), part(2, 1), part(3, 2, { 'walls.count': 2 })];
  const { models, unlike } = ofModels(parts, files);
  expect(models).toEqual({
    'cube.stl': { walls: { count: 5 }, infill: { density: 1 } },
    'cube.obj': { walls: { count: 2 } },
  });
  expect(unlike).toEqual([]);
  const read = parseSaved(JSON.stringify({ walls: { width: 0.5 }, models }));
  expect(read.models).toEqual(models);
  const flat = {
    'cube.stl': { 'walls.count': 5, 'infill.density': 1 },
    'cube.obj': { 'walls.count': 2 },
  };
  const bare = parts.map(({ id, model }) => part(id, model));
  expect(withModels(bare, files, flat)).toEqual({ parts, unknown: [] });
});

test('parts of one model that differ are named, and models that are not open', () => {
  const copies = [part(1, 1, { 'walls.count': 5 }), part(2, 1, { 'walls.count': 6 })];
  expect(ofModels(copies, files)).toEqual({ models: {}, unlike: ['round'] });
  const alike = [part(1, 1, { 'walls.count': 5 }), part(2, 1, { 'walls.count': 5 })];
  expect(ofModels(alike, files)).toEqual({ models: { round: { walls: { count: 5 } } }, unlike: [] });
  expect(withModels(copies, files, { moon: { 'walls.count': 1 } })).toEqual({ parts: copies, unknown: ['moon'] });
});

test('files may have 400 MiB together', () => {
  const file = (mib: number) => ({
    name: 'part.stl',
    file: { size: mib * 1024 * 1024, slice: () => new Blob() },
  });
  expect(() => refuseTooLargeTogether([file(200), file(200)])).not.toThrow();
  expect(() => refuseTooLargeTogether([file(200), file(201)])).toThrow(
    '2 files are too large together: 401 MiB, the limit is 400 MiB',
  );
});
