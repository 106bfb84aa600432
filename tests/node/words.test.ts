// Small pure functions that turn data into words, and words into data.
import { expect, test } from 'vitest';
import { inWords } from '../../bin/cli/inspection.ts';
import { bar } from '../../bin/cli/progress.ts';
import { heightOf } from '../../www/src/slicer/gcode.ts';
import { namedModel } from '../../www/src/source.ts';
import { shareOf } from '../../www/src/state.ts';

test('the progress line has the same width at every stage', () => {
  const line = bar({ stage: 'layers', done: 50, total: 100 });
  expect(line.trimEnd()).toBe(`slicing   [${'#'.repeat(15)}${'.'.repeat(15)}] 50/100`);
  expect(bar({ stage: 'read', done: 0, total: 0 })).toHaveLength(line.length);
});

test('progress only grows from stage to stage', () => {
  const stages = [
    { stage: 'read', done: 0, total: 0 },
    { stage: 'orient', done: 3, total: 6 },
    { stage: 'prepare', done: 0, total: 9 },
    { stage: 'layers', done: 1, total: 9 },
    { stage: 'layers', done: 9, total: 9 },
    { stage: 'join', done: 9, total: 9 },
  ] as const;
  const shares = stages.map(shareOf);
  expect(shares).toEqual(shares.toSorted((a, b) => a - b));
  expect(shares.at(-1)).toBeLessThan(1);
});

test('an inspection is one fact a line, remarks last', () => {
  const found = {
    triangles: 12,
    bounds: { min: [0, 0, 0], max: [1, 2, 3] },
    solids: [],
    warnings: [{ message: 'open' }],
  };
  expect(inWords(JSON.stringify(found))).toBe('triangles  12\nbounds     0 0 0 to 1 2 3\nwarning: open\n');
});

test('a layer says its height', () => {
  const bytes = (text: string): Uint8Array => new TextEncoder().encode(text);
  expect(heightOf(bytes('M83\n;LAYER_CHANGE\n;Z:0.6\nG1 Z0.6\n'))).toBe('0.6');
  expect(heightOf(bytes('G1 X1\n'))).toBe('');
  expect(['19.850', '20.00', '100', '0.6'].map((z) => heightOf(bytes(`;Z:${z}\n`)))).toEqual([
    '19.85',
    '20',
    '100',
    '0.6',
  ]);
});

test('only a model beside the page can be named in its address', () => {
  const page = 'https://example.com/tools/foothold/index.html';
  expect(namedModel(page)).toBeUndefined();
  expect(namedModel(`${page}?model=parts/a%20b.stl`)).toBe('parts/a b.stl');
  for (const bad of [
    'https://elsewhere.net/a.stl',
    '//elsewhere.net/a.stl',
    '\\\\elsewhere.net/a.stl',
    'data:model/stl,',
    'blob:x',
  ]) {
    expect(() => namedModel(`${page}?model=${encodeURIComponent(bad)}`)).toThrow('another site');
  }
});
