// The example of a host page: `node scripts/embed.mjs` serves it, and the element from another origin.
import { existsSync } from 'node:fs';
import { pathToFileURL } from 'node:url';
import { at } from './places.mjs';
import { serve } from './serve.mjs';

/** The page on one port below /shop/parts/, the element with leave for all origins on another. */
export async function embedExample() {
  const element = await serve({ '/': at('dist', 'element') }, { headers: { 'access-control-allow-origin': '*' } });
  const host = await serve(
    { '/shop/parts/bracket.stl': at('www', 'public', 'sample.stl'), '/shop/parts/': at('examples', 'embed') },
    { edit: (text) => text.replaceAll('https://slicer.example', element.origin) },
  );
  return {
    element,
    host,
    address: `${host.origin}/shop/parts/`,
    close: () => Promise.all([host.close(), element.close()]),
  };
}

if (existsSync(process.argv[1] ?? '') && import.meta.url === pathToFileURL(process.argv[1] ?? '').href) {
  console.log((await embedExample()).address);
}
