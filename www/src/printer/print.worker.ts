// The print lane in a worker: a tab in the background does not starve the printer.
import * as engine from '../generated/link/foothold_link.js';
import { watchPanics } from '../slicer/errors.ts';
import { Link } from './link.ts';
import type { PrintNews, ToPrintLane } from './messages.ts';
import { portLike } from './port.ts';
import { sourceOfBlob } from './text.ts';

declare const self: DedicatedWorkerGlobalScope;

watchPanics(console.warn);

let link: Link | undefined;

self.onmessage = ({ data }: MessageEvent<ToPrintLane>) => {
  if ('request' in data) {
    link?.handle(data.request);
    return;
  }
  engine.initSync({ module: data.start });
  const reader = new FileReaderSync();
  link = new Link({
    engine,
    news: (news: PrintNews) => self.postMessage(news),
    source: async (text) => sourceOfBlob(text, (part) => reader.readAsArrayBuffer(part)),
    port: portLike,
  });
};
