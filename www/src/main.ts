// The page: the app in a page of its own, which keeps what the visitor did for the next visit.
import { App } from './app.ts';
import { loadChanges, loadModels, saveChanges, saveModels } from './keep.ts';
import { keepOffline } from './offline.ts';
import { loadPreferences, savePreferences } from './preferences.ts';
import { allFields } from './settings/room.ts';
import { SAMPLE } from './source.ts';
import type { State, Store } from './state.ts';
import { FootholdApp } from './ui/foothold-app.ts';

const element = document.querySelector('foothold-app');
if (!(element instanceof FootholdApp)) throw new Error('the page has no <foothold-app>');
const app = new App(element, document.documentElement, { ...loadPreferences(), changes: loadChanges(allFields) });
keepPreferences(app.store);

// An engine that does not start is told by the state.
const session = await app.session.catch(() => undefined);
if (session !== undefined) {
  const kept = await loadModels();
  keepWork(app.store);
  await session.start(location.href, kept);
}
// After the first job, so that what is kept for later does not hold it up.
const takeNewVersion = await keepOffline(app.store);
element.addEventListener('take-new-version', takeNewVersion);

/** Keeps settings, models and parts for the next visit whenever they change. */
function keepWork(store: Store): void {
  let before: State = store.state;
  store.listen((state) => {
    if (state.changes !== before.changes) saveChanges(state.changes);
    const { model, parts, arranged, history } = state;
    // The sample is there at every first visit: it is kept once somebody has changed it.
    const isOwn = model.kind === 'open' && (model.source.name !== SAMPLE || history.past.length > 0);
    if (isOwn && (model !== before.model || parts !== before.parts)) {
      void saveModels({ sources: model.models.map(({ source }) => source), parts, arranged });
    }
    before = state;
  });
}

/** Keeps later choices of language and colours. */
function keepPreferences(store: Store): void {
  let { language, theme } = store.state;
  store.listen((state) => {
    if (state.language === language && state.theme === theme) return;
    ({ language, theme } = state);
    savePreferences({ language, theme });
  });
}
