// The command line's lanes: the lead runs in this thread, helpers in threads of their own. The wasm is compiled
// once and shared.
import { readFileSync } from 'node:fs';
import { Worker } from 'node:worker_threads';
import * as engine from '../../www/src/generated/engine/foothold.js';
import type { HelperReply, HelperRequest, LeadReply, LeadRequest } from '../../www/src/messages.ts';
import { watchPanics } from '../../www/src/slicer/errors.ts';
import { LocalLane, type Port, ThreadLane } from '../../www/src/slicer/lane.ts';
import { Lead } from '../../www/src/slicer/lead.ts';
import type { LaneMaker } from '../../www/src/slicer/pool.ts';
import { loadFiles } from './files.ts';

/** Lanes of one run of the command line. */
export function nodeLanes(): LaneMaker {
  const module = compile();
  return {
    lead: () => {
      watchPanics(() => undefined);
      engine.initSync({ module });
      const lead = new Lead(engine, loadFiles);
      return new LocalLane<LeadRequest, LeadReply>((request) => lead.handle(request), pause);
    },
    helper: () =>
      new ThreadLane<HelperRequest, HelperReply>(threadPort(new URL('./lane.mjs', import.meta.url)), module),
  };
}

/** The engine's version. */
export function engineVersion(): string {
  engine.initSync({ module: compile() });
  return engine.version();
}

function compile(): WebAssembly.Module {
  return new WebAssembly.Module(readFileSync(new URL('./foothold_bg.wasm', import.meta.url)));
}

/** Lets messages of other threads and signals in. */
const pause = (): Promise<void> => new Promise((resolve) => setImmediate(resolve));

function threadPort(file: URL): Port {
  const worker = new Worker(file);
  return {
    post: (message, transfer) => worker.postMessage(message, transfer as never),
    listen: (message, died) => {
      worker.on('message', message);
      worker.on('error', (error) => died(error.message));
      worker.on('exit', (code) => died(`the thread ended with ${code}`));
    },
    close: () => void worker.terminate(),
  };
}
