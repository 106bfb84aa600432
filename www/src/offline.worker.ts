// The page without a network: its service worker keeps all that the page is made of at the first visit. A newer
// version is fetched beside it and waits until the page says that it may take over.
import { precacheAndRoute } from 'workbox-precaching';

declare const self: ServiceWorkerGlobalScope & {
  /** All files of the page; the build writes them in. */
  readonly FOOTHOLD_FILES: { readonly url: string; readonly revision: string | null }[];
};

// An address may name a model or a lesson: it is the same page.
precacheAndRoute(self.FOOTHOLD_FILES, { ignoreURLParametersMatching: [/./] });

self.addEventListener('activate', (event) => event.waitUntil(self.clients.claim()));

self.addEventListener('message', ({ data }) => {
  if (data === 'take over') void self.skipWaiting();
});
