// Where a model comes from: a file the user gives, the sample, or one beside the page (`?model=`).
import { t } from './i18n/text.ts';
import type { ModelSource } from './messages.ts';

/** The model that comes with the page. */
export const SAMPLE = 'sample.stl';

export class SourceError extends Error {
  override name = 'ModelError';
}

/** The model that the page's address names, relative to the page; undefined when it names none. */
export function namedModel(address: string): string | undefined {
  const name = new URL(address).searchParams.get('model') ?? '';
  if (name === '') return undefined;
  const elsewhere =
    /^[a-z][a-z0-9+.-]*:|^[\\/]{2}/i.test(name) || new URL(name, address).origin !== new URL(address).origin;
  if (elsewhere) throw new SourceError(t.model.badAddress);
  return name;
}

/** Loads a model that lies beside the page. */
export async function fetched(address: string, name: string): Promise<ModelSource> {
  const response = await fetch(new URL(address, document.baseURI)).catch(() => {
    throw new SourceError(t.model.unreachable(name));
  });
  const isPage = response.headers.get('content-type')?.startsWith('text/html') === true;
  if (!response.ok || isPage) throw new SourceError(t.model.notFound(name));
  return { name, file: await response.blob() };
}

export const lastPart = (address: string): string => address.split(/[?#]/)[0]?.split('/').at(-1) ?? address;
