// What the page keeps between visits besides its looks: the settings, and the parts with their files if they are
// small. A visitor who allows no storage begins anew each time.
import type { ModelSource } from './messages.ts';
import type { Part } from './parts.ts';
import { isOfProfile } from './profiles/choice.ts';
import { type Changes, fault } from './settings/changes.ts';
import type { Field } from './settings/fields.ts';

/** Models of more bytes in all are not kept. */
const MOST_BYTES = 32 << 20;
const SETTINGS = 'foothold.settings';
const DATABASE = 'foothold';
const STORE = 'last';

export interface Kept {
  readonly sources: readonly ModelSource[];
  readonly parts: readonly Part[];
  readonly arranged: boolean;
}

/** The changes of the last visit, as far as the settings still have them. */
export function loadChanges(fields: readonly Field[]): Changes {
  try {
    const found: unknown = JSON.parse(localStorage.getItem(SETTINGS) ?? '{}');
    return typeof found === 'object' && found !== null ? known(found as Changes, fields) : {};
  } catch {
    return {};
  }
}

function known(changes: Changes, fields: readonly Field[]): Changes {
  const entries = Object.entries(changes).filter(([path, value]) => {
    const field = fields.find((it) => it.path === path);
    if (field === undefined) return isOfProfile(path, value);
    return typeof value === typeof field.default && fault(field, value) === undefined;
  });
  return Object.fromEntries(entries);
}

export function saveChanges(changes: Changes): void {
  try {
    localStorage.setItem(SETTINGS, JSON.stringify(changes));
  } catch {
    // See above.
  }
}

/** The models and parts of the last visit; undefined when there are none. */
export async function loadModels(): Promise<Kept | undefined> {
  try {
    return (await inStore('readonly', (store) => store.get(STORE))) as Kept | undefined;
  } catch {
    return undefined;
  }
}

/** Keeps the models, or forgets the last ones when these are too large. */
export async function saveModels(kept: Kept): Promise<void> {
  const bytes = kept.sources.reduce((sum, { file }) => sum + file.size, 0);
  try {
    if (bytes > MOST_BYTES) await inStore('readwrite', (store) => store.delete(STORE));
    else await inStore('readwrite', (store) => store.put(kept, STORE));
  } catch {
    // See above.
  }
}

function inStore<T>(mode: IDBTransactionMode, act: (store: IDBObjectStore) => IDBRequest<T>): Promise<T> {
  return new Promise((resolve, reject) => {
    const opening = indexedDB.open(DATABASE, 1);
    opening.onupgradeneeded = () => opening.result.createObjectStore(STORE);
    opening.onerror = () => reject(opening.error);
    opening.onsuccess = () => {
      const database = opening.result;
      const request = act(database.transaction(STORE, mode).objectStore(STORE));
      request.onsuccess = () => resolve(request.result);
      request.onerror = () => reject(request.error);
      request.transaction?.addEventListener('complete', () => database.close());
    };
  });
}
