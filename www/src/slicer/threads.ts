// The page's lanes: each a worker with an engine of its own; the wasm is compiled once.
import wasmUrl from '../generated/engine/foothold_bg.wasm?url';
import type { HelperReply, HelperRequest, LeadReply, LeadRequest, ViewReply, ViewRequest } from '../messages.ts';
import { type Lane, type Port, ThreadLane } from './lane.ts';
import type { LaneMaker } from './pool.ts';

/** Engines at work for one job, on a device with so many processors. */
export function workerCount(processors: number): number {
  return Math.max(1, Math.min(processors, 4));
}

/** Fetches and compiles the engine; also from a server that calls wasm by another type. */
export async function compileEngine(): Promise<WebAssembly.Module> {
  const response = await fetch(wasmUrl);
  if (!response.ok) throw new Error(`the engine could not be loaded: ${response.status}`);
  return WebAssembly.compile(await response.arrayBuffer());
}

export function pageLanes(module: WebAssembly.Module): LaneMaker {
  return {
    lead: () => {
      const worker = new Worker(new URL('./lead.worker.ts', import.meta.url), { type: 'module' });
      return new ThreadLane<LeadRequest, LeadReply>(port(worker), module);
    },
    helper: () => {
      const worker = new Worker(new URL('./helper.worker.ts', import.meta.url), { type: 'module' });
      return new ThreadLane<HelperRequest, HelperReply>(port(worker), module);
    },
  };
}

export type ViewLane = Lane<ViewRequest, ViewReply>;

export function viewLane(module: WebAssembly.Module): ViewLane {
  const worker = new Worker(new URL('../view/view.worker.ts', import.meta.url), { type: 'module' });
  return new ThreadLane<ViewRequest, ViewReply>(port(worker), module);
}

function port(worker: Worker): Port {
  return {
    post: (message, transfer) => worker.postMessage(message, transfer),
    listen: (message, died) => {
      worker.onmessage = ({ data }: MessageEvent<unknown>) => message(data);
      worker.onerror = (event) => died(event.message === '' ? 'a worker could not start' : event.message);
      worker.onmessageerror = () => died('a message to the page could not be read');
    },
    close: () => worker.terminate(),
  };
}
