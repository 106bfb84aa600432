// The page's lanes: each a worker with an engine of its own; the wasm is compiled once.
import wasmUrl from '../generated/engine/foothold_bg.wasm?url';
import filesUrl from '../generated/files/foothold_files_bg.wasm?url';
import type { HelperReply, HelperRequest, LeadReply, LeadRequest, ViewReply, ViewRequest } from '../messages.ts';
import viewScript from '../view/view.worker.ts?worker&url';
import { compiledOnce } from './compile.ts';
import helperScript from './helper.worker.ts?worker&url';
import { type Port, ThreadLane, type ViewLane } from './lane.ts';
import leadScript from './lead.worker.ts?worker&url';
import { isAlive, watch } from './life.ts';
import type { LaneMaker } from './pool.ts';
import { startWorker } from './start-worker.ts';

/** Where the module for files of other programs is. */
export { filesUrl };

/** Engines at work for one job, on a device with so many processors. */
export function workerCount(processors: number): number {
  return Math.max(1, Math.min(processors, 4));
}

/** Fetches and compiles the engine. */
export const compileEngine = compiledOnce(wasmUrl);

export function pageLanes(module: WebAssembly.Module): LaneMaker {
  return {
    lead: () => new ThreadLane<LeadRequest, LeadReply>(port(startWorker(leadScript)), module, filesUrl),
    helper: () => new ThreadLane<HelperRequest, HelperReply>(port(startWorker(helperScript)), module),
  };
}

export function viewLane(module: WebAssembly.Module): ViewLane {
  return new ThreadLane<ViewRequest, ViewReply>(port(startWorker(viewScript)), module);
}

function port(worker: Worker): Port {
  return {
    post: (message, transfer) => worker.postMessage(message, transfer),
    listen: (message, died) => {
      worker.onmessage = ({ data }: MessageEvent<unknown>) => {
        if (isAlive(data)) watch(data, () => died('a worker ended'));
        else message(data);
      };
      worker.onerror = (event) => died(event.message === '' ? 'a worker could not start' : event.message);
      worker.onmessageerror = () => died('a message to the page could not be read');
    },
    close: () => worker.terminate(),
  };
}
