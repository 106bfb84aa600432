// Parts on the bed, undo and redo: pure functions of the page.
import { expect, test } from 'vitest';
import schema from '../../schema/settings.schema.json';
import { type History, noHistory, planOf, recorded, redone, undone } from '../../www/src/history.ts';
import {
  asStanding,
  atFreeSpot,
  freeId,
  isOutside,
  middleOf,
  moved,
  movedTo,
  type Part,
  type Room,
  scaleOf,
  sizeOf,
  UNMOVED,
} from '../../www/src/parts.ts';
import { asChanges, withChange } from '../../www/src/settings/changes.ts';
import { type Depth, found, shownAt } from '../../www/src/settings/depths.ts';
import { groupsOf, type Schema } from '../../www/src/settings/fields.ts';
import { ownGroups } from '../../www/src/settings/own.ts';
import { allFields, roomOf } from '../../www/src/settings/room.ts';
import { Store } from '../../www/src/state.ts';

const room: Room = [200, 100, 150, 0, 0, false];
const part = (id: number, box: readonly number[]): Part => ({ id, model: 0, matrix: UNMOVED, box });
const cube = part(1, [0, 0, 0, 20, 20, 20]);

test('a part moves with its box and its matrix', () => {
  const there = movedTo(cube, 50, 60);
  expect(there.box).toEqual([40, 50, 0, 60, 70, 20]);
  expect(there.matrix.slice(12)).toEqual([40, 50, 0, 1]);
  expect(middleOf(there)).toEqual([50, 60]);
  expect(sizeOf(there)).toEqual([20, 20, 20]);
});

test('a part has some settings of its own, and what the plate has is none', () => {
  const plate = { 'walls.count': 4 };
  const fields = ownGroups(plate).flatMap((group) => group.fields);
  const field = (path: string) => fields.find((it) => it.path === path);
  expect(['layers.height', 'support.tool', 'speed.travel', 'filament.bed_temp'].filter(field)).toEqual([]);
  const count = field('walls.count');
  if (count === undefined) throw new Error('walls.count is missing');
  expect(withChange({}, count, 4)).toEqual({});
  // The engine's default differs from what this plate has.
  expect(withChange({}, count, 3)).toEqual({ 'walls.count': 3 });
  const alone = ownGroups({ 'print.sequence': 'by_object' }).flatMap((group) => group.fields.map(({ path }) => path));
  expect(alone).toContain('layers.height');
  expect(alone).toContain('adhesion.kind');

  expect(asStanding([cube, { ...cube, id: 2, own: {} }], true).own).toEqual([]);
  expect(asStanding([cube, { ...cube, id: 2, own: { 'infill.density': 1 } }], true).own).toEqual([
    '{}',
    '{"infill":{"density":1}}',
  ]);
});

test('the scale is that of the volume, also mirrored and turned', () => {
  expect(scaleOf(cube)).toBe(1);
  expect(scaleOf({ ...cube, matrix: [0, 2, 0, 0, 2, 0, 0, 0, 0, 0, 2, 0, 9, 9, 9, 1] })).toBeCloseTo(2, 12);
  expect(scaleOf({ ...cube, matrix: [8, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1] })).toBeCloseTo(2, 12);
});

test('what reaches over the edge or the top is outside', () => {
  expect(isOutside(cube, room)).toBe(false);
  expect(isOutside(moved(cube, -0.0005, 0), room)).toBe(false);
  expect(isOutside(moved(cube, -0.1, 0), room)).toBe(true);
  expect(isOutside(moved(cube, 0, 80.1), room)).toBe(true);
  expect(isOutside(part(1, [0, 0, 0, 20, 20, 151]), room)).toBe(true);
});

test('a free spot is inside, apart from the others, and near the middle', () => {
  const first = atFreeSpot(cube, [], room);
  expect(middleOf(first)).toEqual([100, 50]);
  const all = [first];
  for (let id = 2; id <= 12; id++) all.push(atFreeSpot({ ...cube, id }, all, room));
  for (const [k, it] of all.entries()) {
    expect(isOutside(it, room)).toBe(false);
    for (const other of all.slice(k + 1)) {
      const apart = [0, 1].some((axis) => {
        const gap = Math.max(
          (other.box[axis] ?? 0) - (it.box[axis + 3] ?? 0),
          (it.box[axis] ?? 0) - (other.box[axis + 3] ?? 0),
        );
        return gap >= 10;
      });
      expect(apart, `${it.id} and ${other.id}`).toBe(true);
    }
  }
  const large = part(2, [0, 0, 0, 190, 90, 5]);
  expect(middleOf(atFreeSpot(large, all, room)), 'no room: the middle').toEqual([100, 50]);
});

test('parts that nobody moved are left to the engine', () => {
  expect(asStanding([cube, cube], true)).toEqual({ models: [0, 0], placements: [], own: [] });
  expect(asStanding([cube], false).placements).toEqual([...UNMOVED]);
  expect(freeId([])).toBe(1);
  expect(freeId([part(7, []), cube])).toBe(8);
});

test('undo and redo go through all plans and back; a new change forgets what was undone', () => {
  const plans = [1, 2, 3].map((walls) => ({ parts: [], arranged: true, changes: { 'walls.count': walls } }));
  const [a, b, c] = plans;
  if (a === undefined || b === undefined || c === undefined) throw new Error('three plans');
  let history: History = recorded(recorded(noHistory, a), b);
  const back = undone(history, c);
  expect(back && planOf(back)).toEqual(b);
  history = back?.history ?? noHistory;
  const again = redone(history, b);
  expect(again && planOf(again)).toEqual(c);
  expect(undone(undone(history, b)?.history ?? noHistory, a)).toBeUndefined();
  expect(recorded(history, b).future).toEqual([]);
  expect(redone(noHistory, a)).toBeUndefined();
});

test('the store records what can be undone, and only that', () => {
  const store = new Store();
  store.update({ layer: 3, selected: 1 });
  expect(store.state.history.past).toEqual([]);
  store.update({ changes: { 'walls.count': 2 } });
  store.update({ parts: [cube], arranged: false });
  expect(store.state.history.past).toHaveLength(2);
  const before = undone(store.state.history, planOf(store.state));
  store.update(before ?? {});
  expect(store.state).toMatchObject({ parts: [], arranged: true, changes: { 'walls.count': 2 } });
  expect(store.state.history.future).toHaveLength(1);
});

const groups = groupsOf(schema as Schema);
const paths = (depth: Depth): string[] =>
  shownAt(depth, groups).flatMap(({ fields }) => fields.map((field) => field.path));

test('each depth shows more, and "all" shows everything once', () => {
  const [basic, usual, all] = [paths('basic'), paths('usual'), paths('all')];
  expect(basic[0]).toBe('layers.height');
  expect(usual).toEqual(expect.arrayContaining(basic));
  expect(all).toEqual(expect.arrayContaining(usual));
  expect(new Set(all).size).toBe(all.length);
  expect(basic.length).toBeLessThan(usual.length);
  expect(usual.length).toBeLessThan(all.length / 2);
});

test('search looks at labels, paths and help, all words', () => {
  const hits = (search: string): string[] =>
    found(groups, search).flatMap(({ fields }) => fields.map((field) => field.path));
  expect(hits('bed temperature')).toContain('filament.bed_temp');
  expect(hits('walls.count')).toContain('walls.count');
  expect(hits('BRIM width')).toContain('adhesion.brim.width');
  expect(hits('flux capacitor')).toEqual([]);
});

test('a settings file becomes changes; what is default is none', () => {
  const file = { walls: { count: 5, width: 0.45 }, printer: { bed_size: [300, 300] }, unknown: 1 };
  const changes = asChanges(file, allFields);
  expect(changes).toEqual({ 'walls.count': 5, 'printer.bed_size': [300, 300] });
  expect(roomOf(changes)).toEqual([300, 300, 250, 0, 0, false]);
  expect(asChanges(null, allFields)).toEqual({});
});
