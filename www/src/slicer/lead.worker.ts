// The page's lead lane.
import { loadFiles } from '../files/load.ts';
import * as engine from '../generated/engine/foothold.js';
import type { LeadReply, LeadRequest, ToLane } from '../messages.ts';
import { watchPanics } from './errors.ts';
import { serve } from './lane.ts';
import { Lead } from './lead.ts';
import { live } from './life.ts';

declare const self: DedicatedWorkerGlobalScope;

watchPanics(console.warn);

const receive = serve<LeadRequest, LeadReply>(
  (module, files) => {
    engine.initSync({ module });
    const lead = new Lead(engine, () => loadFiles(files));
    return (request) => lead.handle(request);
  },
  (message, transfer) => self.postMessage(message, transfer),
);

live((message) => self.postMessage(message));
self.onmessage = ({ data }: MessageEvent<ToLane<LeadRequest>>) => receive(data);
