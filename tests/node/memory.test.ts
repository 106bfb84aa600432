// The engine's memory: what a job took is given back.
import { readFileSync } from 'node:fs';
import { expect, test } from 'vitest';
import * as engine from '../../www/src/generated/engine/foothold.js';
import type { LeadReply, LeadRequest } from '../../www/src/messages.ts';
import { LocalLane } from '../../www/src/slicer/lane.ts';
import { Lead } from '../../www/src/slicer/lead.ts';
import { Pool } from '../../www/src/slicer/pool.ts';
import { binaryStl, bunny } from './shapes.ts';

const wasm = new URL('../../www/src/generated/engine/foothold_bg.wasm', import.meta.url);

test('the same job over and over takes hardly more memory', async () => {
  const { memory } = engine.initSync({ module: readFileSync(wasm) });
  const lead = (): LocalLane<LeadRequest, LeadReply> => {
    const it = new Lead(engine, () => Promise.reject(new Error('an STL needs no other module')));
    return new LocalLane(
      (request) => it.handle(request),
      async () => undefined,
    );
  };
  const pool = new Pool(
    {
      lead,
      helper: () => {
        throw new Error('one engine is enough');
      },
    },
    1,
  );
  const file = new Blob([binaryStl(bunny()) as Uint8Array<ArrayBuffer>]);
  const settings = await pool.settings([], ['layers.height=0.6']);
  const taken: number[] = [];
  for (let job = 0; job < 5; job++) {
    await pool.open([{ name: 'bunny.stl', file }]);
    await pool.slice({ settings });
    taken.push(memory.buffer.byteLength);
  }
  // The model alone takes 1.2 MB: four times that would show. An allocator may still find other pieces.
  const [, second = 0] = taken;
  expect((taken.at(-1) ?? 0) - second, taken.join(', ')).toBeLessThan(1024 * 1024);
}, 120_000);
