// The print lane in the page itself: loaded only where a worker cannot have the port.
import * as engine from '../generated/link/foothold_link.js';
import { Link } from './link.ts';
import type { PrintNews } from './messages.ts';
import type { SerialPortLike } from './port.ts';
import { sourceOfBytes } from './text.ts';

export function linkInPage(
  module: WebAssembly.Module,
  port: () => SerialPortLike | undefined,
  news: (news: PrintNews) => void,
): Link {
  engine.initSync({ module });
  return new Link({
    engine,
    news,
    // A page cannot read a part of a Blob at once, as the engine wants it.
    source: async (text) => sourceOfBytes(new Uint8Array(await text.arrayBuffer())),
    port: async () => port(),
  });
}
