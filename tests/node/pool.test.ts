import { expect, test } from 'vitest';
import type { Range } from '../../www/src/messages.ts';
import { type Gcode, layerOf, partsOf } from '../../www/src/slicer/gcode.ts';
import { LayerQueue, Pool, type Progress } from '../../www/src/slicer/pool.ts';
import { expected, fakeLanes, layerText } from './fake-lanes.ts';

const sources = [{ name: 'part.stl', file: new Blob([]) }];
const text = (gcode: Gcode): string => Buffer.concat(partsOf(gcode)).toString();
const wanted = (layers: number): string => `<${Array.from({ length: layers }, (_, k) => layerText(k)).join('|')}>`;

test.each([1, 2, 3, 8])('%d engines give the layers in order', async (workers) => {
  const lanes = fakeLanes({ layers: 211 });
  const pool = new Pool(lanes, workers);
  await pool.open(sources);
  expect(text(await pool.slice({ settings: '{}' }))).toBe(wanted(211));
  expect(lanes.log.includes('helper slice')).toBe(workers > 1);
});

test('helpers live for one job only; one layer needs none', async () => {
  const lanes = fakeLanes({ layers: 1 });
  const pool = new Pool(lanes, 4);
  await pool.open(sources);
  expect(text(await pool.slice({ settings: '{}' }))).toBe(wanted(1));
  expect(lanes.log).not.toContain('lead share');
  expect(lanes.open()).toBe(1);
});

test('progress counts every layer once and ends with the join', async () => {
  const pool = new Pool(fakeLanes({ layers: 100 }), 3);
  await pool.open(sources);
  const seen: Progress[] = [];
  await pool.slice({ settings: '{}', progress: (progress) => seen.push(progress) });
  const done = seen.filter(({ stage }) => stage === 'layers').map((it) => it.done);
  expect(done).toEqual([...done].sort((a, b) => a - b));
  expect(done.at(-1)).toBe(100);
  expect(seen.at(-1)).toEqual({ stage: 'join', done: 100, total: 100 });
});

test('a cancel rejects at once, ends all lanes, and the model is read again for the next job', async () => {
  const cancel = new AbortController();
  const lanes = fakeLanes({ layers: 500, before: (_, { first }) => first > 100 && cancel.abort() });
  const pool = new Pool(lanes, 3);
  await pool.open(sources);
  await expect(pool.slice({ settings: '{}', signal: cancel.signal })).rejects.toThrow('cancelled');
  expect(lanes.open()).toBe(0);
  expect(text(await pool.slice({ settings: '{}' }))).toBe(wanted(500));
  expect(lanes.log.filter((it) => it === 'lead open')).toHaveLength(2);
});

test('a cancelled job does not end the lanes of the model that was opened after it', async () => {
  const cancel = new AbortController();
  const pool = new Pool(fakeLanes({ layers: 50 }), 2);
  await pool.open(sources);
  const first = pool.slice({ settings: '{}', signal: cancel.signal });
  cancel.abort();
  const opened = pool.open([{ name: 'other.stl', file: new Blob([]) }]);
  await expect(first).rejects.toThrow('cancelled');
  expect((await opened).inspections).toEqual(['other.stl']);
  expect(text(await pool.slice({ settings: '{}' }))).toBe(wanted(50));
});

test('a signal that was aborted before cancels too', async () => {
  const pool = new Pool(fakeLanes({ layers: 50 }), 2);
  await pool.open(sources);
  await expect(pool.slice({ settings: '{}', signal: AbortSignal.abort() })).rejects.toThrow('cancelled');
});

test.each(['lead', 'helper'])(
  'a %s that breaks fails the job with InternalError, and the next job has new lanes',
  async (who) => {
    let broken = false;
    const before = (lane: string, _: Range): void => {
      if (lane !== who || broken) return;
      broken = true;
      throw new WebAssembly.RuntimeError('unreachable');
    };
    const lanes = fakeLanes({ layers: 200, before });
    const pool = new Pool(lanes, 2);
    await pool.open(sources);
    await expect(pool.slice({ settings: '{}' })).rejects.toMatchObject({ name: 'InternalError' });
    expect(lanes.open()).toBe(0);
    expect(text(await pool.slice({ settings: '{}' }))).toBe(wanted(200));
  },
);

test('an expected error keeps the lead and its models', async () => {
  let refused = false;
  const before = (): void => {
    if (refused) return;
    refused = true;
    throw expected('FitError', 'too tall');
  };
  const lanes = fakeLanes({ layers: 20, before });
  const pool = new Pool(lanes, 1);
  await pool.open(sources);
  await expect(pool.slice({ settings: '{}' })).rejects.toMatchObject({ name: 'FitError', message: 'too tall' });
  expect(text(await pool.slice({ settings: '{}' }))).toBe(wanted(20));
  expect(lanes.log.filter((it) => it === 'lead open')).toHaveLength(1);
});

test('a model that can not be read says so for each use', async () => {
  const pool = new Pool(fakeLanes({ layers: 20, failToOpen: true }), 1);
  await expect(pool.open(sources)).rejects.toMatchObject({ name: 'ModelError' });
  await expect(pool.slice({ settings: '{}' })).rejects.toMatchObject({ name: 'ModelError', message: 'truncated' });
});

test('the queue hands out each layer once', () => {
  const queue = new LayerQueue(300);
  const ranges: { first: number; last: number }[] = [];
  for (let range = queue.take(24); range !== undefined; range = queue.take(24)) ranges.push(range);
  expect(ranges[0]).toEqual({ first: 0, last: 24 });
  expect(ranges.at(-1)?.last).toBe(300);
  ranges.slice(1).forEach((range, k) => {
    expect(range.first).toBe(ranges[k]?.last);
  });
  const sizes = ranges.map(({ first, last }) => last - first);
  expect(sizes).toEqual(sizes.toSorted((a, b) => b - a));
  expect(sizes.at(-1)).toBeLessThanOrEqual(4);
  const stopped = new LayerQueue(30);
  stopped.stop();
  expect(stopped.take(1)).toBeUndefined();
});

test('a layer comes with the text that joins it to the one before', async () => {
  const pool = new Pool(fakeLanes({ layers: 30 }), 2);
  await pool.open(sources);
  const gcode = await pool.slice({ settings: '{}' });
  const layer = (k: number): string => Buffer.from(layerOf(gcode, k)).toString();
  expect([layer(0), layer(7), layer(29)]).toEqual(['M83\n<layer 0\n', 'M83\n|layer 7\n', 'M83\n|layer 29\n']);
});

const eight = '1 0, 2 1, 3 2, 4 3, 5 4, 6 5, 7 6, 8 7';

test.each([1, 2, 5])('%d engines evaluate each direction once, in the order of their ids', async (workers) => {
  const lanes = fakeLanes({ layers: 1, directions: 8 });
  const pool = new Pool(lanes, workers);
  await pool.open(sources);
  const seen: Progress[] = [];
  expect(await pool.orient({ settings: '{}', progress: (progress) => seen.push(progress) })).toBe(eight);
  expect(lanes.log.filter((it) => it.endsWith('evaluate'))).toHaveLength(8);
  expect(lanes.log.filter((it) => it === 'helper mesh 7')).toHaveLength(workers - 1);
  expect(lanes.open()).toBe(1);
  const done = seen.filter(({ stage }) => stage === 'orient').map((it) => it.done);
  expect(done).toEqual([0, 1, 2, 3, 4, 5, 6, 7, 8]);
});

test('a comparison of directions can be cancelled, and the next one starts anew', async () => {
  const cancel = new AbortController();
  const lanes = fakeLanes({ layers: 1, directions: 8, before: (_, { first }) => first > 2 && cancel.abort() });
  const pool = new Pool(lanes, 1);
  await pool.open(sources);
  await expect(pool.orient({ settings: '{}', signal: cancel.signal })).rejects.toThrow('cancelled');
  expect(lanes.open()).toBe(0);
  expect(await pool.orient({ settings: '{}' })).toBe(eight);
});

test('a job that turns its models compares only what it may choose, and goes on where it can not', async () => {
  const settings = JSON.stringify({ orientation: { mode: 'auto' } });
  for (const directions of [8, undefined]) {
    const lanes = fakeLanes(directions === undefined ? { layers: 30 } : { layers: 30, directions });
    const pool = new Pool(lanes, 2);
    await pool.open(sources);
    expect(text(await pool.slice({ settings }))).toBe(wanted(30));
    expect(lanes.log.filter((it) => it.endsWith('evaluate'))).toHaveLength(directions === undefined ? 0 : 6);
    expect(lanes.log.includes('lead choose')).toBe(directions !== undefined);
  }
});
