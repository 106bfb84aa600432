// The view lane is replaced when it breaks.
import { expect, test } from 'vitest';
import type { ViewReply, ViewRequest } from '../../www/src/messages.ts';
import { LocalLane } from '../../www/src/slicer/lane.ts';
import { Pool } from '../../www/src/slicer/pool.ts';
import { painter } from '../../www/src/view/painter.ts';
import { expected, fakeLanes } from './fake-lanes.ts';

/** Lanes whose first so many answers are errors. */
function viewLanes(errors: readonly Error[]) {
  const left = [...errors];
  const handle = (request: ViewRequest): ViewReply => {
    const error = left.shift();
    if (error !== undefined) throw error;
    if (request.kind !== 'roles') throw new Error(`not faked: ${request.kind}`);
    return { kind: 'roles', roles: '[]' };
  };
  return () => new LocalLane<ViewRequest, ViewReply>(handle, async () => undefined);
}

const pool = new Pool(fakeLanes({ layers: 1 }), 1);

test('after a fault of the engine the next question goes to a new lane', async () => {
  const paint = painter(pool, viewLanes([new Error('unreachable')]));
  await expect(paint.roles()).rejects.toThrow('unreachable');
  expect(paint.lanes).toBe(2);
  expect(await paint.roles()).toEqual([]);
});

test('questions that a broken lane did not answer start one new lane together', async () => {
  const paint = painter(pool, viewLanes([new Error('unreachable')]));
  const all = await Promise.allSettled([paint.roles(), paint.roles(), paint.roles()]);
  expect(all.map(({ status }) => status)).toEqual(['rejected', 'rejected', 'rejected']);
  expect(paint.lanes).toBe(2);
  expect(await paint.roles()).toEqual([]);
});

test('an error that the engine throws on purpose leaves the lane', async () => {
  const paint = painter(pool, viewLanes([expected('SettingsError', 'layers.height: too thin')]));
  await expect(paint.roles()).rejects.toThrow('too thin');
  expect(paint.lanes).toBe(1);
});
