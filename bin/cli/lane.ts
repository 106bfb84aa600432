// The thread of a helper lane.
import { parentPort } from 'node:worker_threads';
import * as engine from '../../www/src/generated/engine/foothold.js';
import type { HelperReply, HelperRequest } from '../../www/src/messages.ts';
import { watchPanics } from '../../www/src/slicer/errors.ts';
import { Helper } from '../../www/src/slicer/helper.ts';
import { serve } from '../../www/src/slicer/lane.ts';

watchPanics(() => undefined);

const receive = serve<HelperRequest, HelperReply>(
  (module) => {
    engine.initSync({ module });
    const helper = new Helper(engine);
    return (request) => helper.handle(request);
  },
  (message, transfer) => parentPort?.postMessage(message, transfer as never),
);

parentPort?.on('message', receive);
