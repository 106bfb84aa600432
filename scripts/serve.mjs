// A server of files for tests and examples: what stands in a list of places, on a free port of this machine.
import { existsSync, readFileSync, statSync } from 'node:fs';
import { createServer } from 'node:http';
import path from 'node:path';

const types = {
  '.html': 'text/html; charset=utf-8',
  '.js': 'text/javascript',
  '.css': 'text/css',
  '.wasm': 'application/wasm',
  '.svg': 'image/svg+xml',
  '.png': 'image/png',
  '.webmanifest': 'application/manifest+json',
};

/**
 * Serves the folders of `places` under their paths (`{ '/shop/': 'examples/embed' }`); the first that has a file wins,
 * and a file may stand for a path of its own. `headers` go with each answer; `edit` may change a text. Resolves to
 * the origin, the paths asked for, and a way to end it.
 *
 * @param {Readonly<Record<string, string>>} places
 * @param {{ headers?: Record<string, string>, edit?: (text: string, asked: string) => string }} [how]
 */
export async function serve(places, { headers = {}, edit = (text) => text } = {}) {
  /** @type {string[]} */
  const asked = [];
  const server = createServer((request, response) => {
    const asks = decodeURIComponent(new URL(request.url ?? '/', 'http://localhost').pathname);
    asked.push(asks);
    const file = Object.entries(places)
      .filter(([below]) => asks === below || (below.endsWith('/') && asks.startsWith(below)))
      .map(([below, place]) => path.join(place, asks.slice(below.length)))
      .map((found) => (asks.endsWith('/') ? path.join(found, 'index.html') : found))
      .find((found) => existsSync(found) && statSync(found).isFile());
    if (file === undefined || asks.includes('..')) {
      response.writeHead(404).end();
      return;
    }
    const type = types[path.extname(file)] ?? 'application/octet-stream';
    const content = readFileSync(file);
    const isText = /^text|manifest/.test(type);
    response.writeHead(200, { 'content-type': type, 'cache-control': 'no-cache', ...headers });
    response.end(isText ? edit(String(content), asks) : content);
  });
  await new Promise((resolve) => server.listen(0, 'localhost', () => resolve(undefined)));
  const address = server.address();
  const port = typeof address === 'object' && address !== null ? address.port : 0;
  return {
    origin: `http://localhost:${port}`,
    asked,
    close: () =>
      new Promise((resolve) => {
        server.closeAllConnections();
        server.close(resolve);
      }),
  };
}
