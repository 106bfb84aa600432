import { expect, test } from 'vitest';
import { parseCommand, UsageError } from '../../bin/cli/args.ts';

test('slice with everything', () => {
  const words =
    'slice a.stl b.stl -o out.gcode --settings f.json --set walls.count=2 --set x.y=z --report r.json --workers 3';
  expect(parseCommand(words.split(' '))).toEqual({
    kind: 'slice',
    models: ['a.stl', 'b.stl'],
    out: 'out.gcode',
    settings: { profiles: {}, files: ['f.json'], sets: ['walls.count=2', 'x.y=z'] },
    own: [],
    report: 'r.json',
    workers: 3,
  });
});

test('standard output, a value with an equals sign, words after --', () => {
  expect(
    parseCommand(['slice', '-o', '-', '--set', 'printer.start_gcode="G28 ; a=b"', '--', '-odd.stl']),
  ).toMatchObject({
    models: ['-odd.stl'],
    out: '-',
    settings: { sets: ['printer.start_gcode="G28 ; a=b"'] },
  });
});

test('draw takes a layer or a plane', () => {
  expect(parseCommand('draw a.stl --layer 3 -o o.svg'.split(' '))).toMatchObject({ what: { layer: 3 } });
  expect(parseCommand('draw a.stl --plane x=-1.5 -o o.svg'.split(' '))).toMatchObject({ what: { plane: 'x=-1.5' } });
});

test.each([
  ['', 'no command'],
  ['melt a.stl', 'no command "melt"'],
  ['slice', 'slice needs a model'],
  ['slice a.stl --wrokers 2', "unknown option '--wrokers'"],
  ['slice a.stl --prnter ender3', "unknown option '--prnter'; did you mean --printer?"],
  ['slice a.stl --walls 2', 'settings are given as --set path=value'],
  ['slice a.stl --workers 0', '--workers 0: expected a whole number from 1 to 64'],
  ['slice a.stl --workers two', '--workers two'],
  ['slice a.stl --workers', 'argument missing'],
  ['slice a.stl --set walls.count', '--set walls.count: expected path=value'],
  ['slice a.stl --set-for a', '--set-for a: expected MODEL:path=value'],
  ['inspect', 'inspect needs a model'],
  ['inspect a.stl b.stl', 'inspect takes one model, not 2'],
  ['draw a.stl -o o.svg', 'draw needs --layer K or --plane'],
  ['draw a.stl --layer 1 --plane y=2 -o o.svg', 'not both'],
  ['draw a.stl --layer -1 -o o.svg', 'argument is ambiguous'],
  ['draw a.stl --plane z=2 -o o.svg', '--plane z=2'],
  ['draw a.stl --plane y=NaN -o o.svg', '--plane y=NaN'],
  ['draw a.stl --layer 1', 'draw needs -o'],
  ['settings extra', 'unexpected argument'],
])('wrong use: %s', (words, message) => {
  const parse = (): unknown => parseCommand(words.split(' ').filter((it) => it !== ''));
  expect(parse).toThrow(UsageError);
  expect(parse).toThrow(new RegExp(message.replaceAll(/[.*+?^${}()|[\]\\]/g, '\\$&'), 'i'));
});

test('profiles are named by id', () => {
  expect(parseCommand('slice a.stl --printer ender3 --material petg'.split(' '))).toMatchObject({
    settings: { profiles: { printer: 'ender3', material: 'petg' } },
  });
  expect(() => parseCommand('slice a.stl --printer ender99'.split(' '))).toThrow(
    /^--printer ender99: there are .*ender3/,
  );
  expect(parseCommand(['profiles'])).toEqual({ kind: 'profiles' });
});
