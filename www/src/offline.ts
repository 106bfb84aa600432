// The page without a network, and newer versions of it: they are told, and taken only when no tab is at work.
import { isBusy, type Store } from './state.ts';

/** Held in common by all tabs that are at work. */
const AT_WORK = 'foothold.work';

/** Registers the service worker, tells of newer versions, and resolves to what takes the newest. */
export async function keepOffline(store: Store): Promise<() => void> {
  if (!('serviceWorker' in navigator)) return () => undefined;
  const { serviceWorker } = navigator;
  holdWhileBusy(store);
  // A browser that keeps nothing, or a server without the file: the page works as it did, with a network.
  const registration = await serviceWorker.register('./offline.js').catch(() => undefined);
  if (registration === undefined) return () => undefined;

  let taking = false;
  let isFirst = serviceWorker.controller === null;
  serviceWorker.addEventListener('controllerchange', () => {
    if (taking) location.reload();
    else if (!isFirst) store.update({ newVersion: 'ready' });
    isFirst = false;
  });
  const look = (): void => {
    if (registration.waiting !== null && serviceWorker.controller !== null) store.update({ newVersion: 'ready' });
  };
  look();
  registration.addEventListener('updatefound', () => registration.installing?.addEventListener('statechange', look));

  return () => {
    void navigator.locks.request(AT_WORK, { ifAvailable: true }, (free) => {
      if (free === null) {
        store.update({ newVersion: 'elsewhere' });
        return;
      }
      taking = true;
      if (registration.waiting === null) location.reload();
      else registration.waiting.postMessage('take over');
    });
  };
}

/** While this tab slices or prints, no other one takes a new version, which would end the old one here too. */
function holdWhileBusy(store: Store): void {
  let release: (() => void) | undefined;
  store.listen((state) => {
    const busy = isBusy(state);
    if (busy && release === undefined) {
      const done = new Promise<void>((resolve) => {
        release = resolve;
      });
      void navigator.locks.request(AT_WORK, { mode: 'shared' }, () => done);
    } else if (!busy) {
      release?.();
      release = undefined;
    }
  });
}
