// Workers from a module, wherever it lies: a browser starts them only from the page's own origin.

/** Small scripts that import a module of another origin, by its address. */
const importers = new Map<string, string>();

export function startWorker(module: string): Worker {
  const address = new URL(module, location.href);
  const script = address.origin === location.origin ? address.href : importerOf(address.href);
  return new Worker(script, { type: 'module' });
}

/** The address of a Blob that imports the module; one for all workers of the kind. */
function importerOf(address: string): string {
  const known = importers.get(address);
  if (known !== undefined) return known;
  const made = URL.createObjectURL(new Blob([importer(address)], { type: 'text/javascript' }));
  importers.set(address, made);
  return made;
}

/**
 * A page's policy counts what a worker imports in its first line under worker-src, and what it imports later under
 * script-src, where the module's host is allowed already: hence the later one. Messages that come before it wait.
 */
const importer = (address: string): string => `
const early = [];
const wait = (event) => early.push(event.data);
addEventListener('message', wait);
import(${JSON.stringify(address)}).then(
  () => {
    removeEventListener('message', wait);
    for (const data of early) dispatchEvent(new MessageEvent('message', { data }));
  },
  (error) => setTimeout(() => { throw error; }),
);
`;
