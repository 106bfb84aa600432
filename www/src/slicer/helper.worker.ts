// One of the page's helper lanes.
import * as engine from '../generated/engine/foothold.js';
import type { HelperReply, HelperRequest, ToLane } from '../messages.ts';
import { watchPanics } from './errors.ts';
import { Helper } from './helper.ts';
import { serve } from './lane.ts';
import { live } from './life.ts';

declare const self: DedicatedWorkerGlobalScope;

watchPanics(console.warn);

const receive = serve<HelperRequest, HelperReply>(
  (module) => {
    engine.initSync({ module });
    const helper = new Helper(engine);
    return (request) => helper.handle(request);
  },
  (message, transfer) => self.postMessage(message, transfer),
);

live((message) => self.postMessage(message));
self.onmessage = ({ data }: MessageEvent<ToLane<HelperRequest>>) => receive(data);
