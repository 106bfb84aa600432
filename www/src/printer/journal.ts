// The job that prints and how far it is, in IndexedDB: both survive a closed tab.
import type { Journal, Outline } from './messages.ts';

/** A job that began and has not ended well. */
export interface Standing {
  readonly name: string;
  readonly text: Blob;
  readonly outline: Outline;
  readonly journal: Journal;
  /** It stands in a pause, or on the way into or out of one: the head is not where the print left off. */
  readonly parked: boolean;
}

const STORE = 'print';

/** Where there is no IndexedDB (some private windows), nothing is kept and nothing is said. */
export class PrintJournal {
  #database: Promise<IDBDatabase | undefined> | undefined;

  /** A new job begins; the last one is forgotten. */
  async begin(job: Omit<Standing, 'journal' | 'parked'>, journal: Journal): Promise<void> {
    await this.#put({ job, journal, parked: false });
  }

  async reached(journal: Journal, parked: boolean): Promise<void> {
    await this.#put({ journal, parked });
  }

  async ended(): Promise<void> {
    const store = await this.#store('readwrite');
    if (store !== undefined) await done(store.clear());
  }

  /** The job that stands, if one does. */
  async standing(): Promise<Standing | undefined> {
    const store = await this.#store('readonly');
    if (store === undefined) return undefined;
    const [job, journal, parked] = await Promise.all(['job', 'journal', 'parked'].map((key) => done(store.get(key))));
    if (job === undefined || journal === undefined) return undefined;
    return { ...(job as Omit<Standing, 'journal' | 'parked'>), journal: journal as Journal, parked: parked === true };
  }

  async #put(values: Readonly<Record<string, unknown>>): Promise<void> {
    const store = await this.#store('readwrite');
    if (store === undefined) return;
    await Promise.all(Object.entries(values).map(([key, value]) => done(store.put(value, key))));
  }

  async #store(mode: IDBTransactionMode): Promise<IDBObjectStore | undefined> {
    this.#database ??= opened().catch(() => undefined);
    return (await this.#database)?.transaction(STORE, mode).objectStore(STORE);
  }
}

function opened(): Promise<IDBDatabase> {
  const request = indexedDB.open('foothold-print', 1);
  request.onupgradeneeded = () => request.result.createObjectStore(STORE);
  return done(request);
}

function done<T>(request: IDBRequest<T>): Promise<T> {
  return new Promise((resolve, reject) => {
    request.onsuccess = () => resolve(request.result);
    request.onerror = () => reject(request.error);
  });
}
