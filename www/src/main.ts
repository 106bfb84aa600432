// Creates the page's parts and connects them.
import { speak } from './i18n/text.ts';
import { loadChanges, loadModels, saveChanges, saveModels } from './keep.ts';
import { loadPreferences, savePreferences } from './preferences.ts';
import { PrintSession } from './printer/print-session.ts';
import { problemOf, Session } from './session.ts';
import { allFields } from './settings/room.ts';
import { Pool } from './slicer/pool.ts';
import { compileEngine, pageLanes, viewLane, workerCount } from './slicer/threads.ts';
import { SAMPLE } from './source.ts';
import { type State, Store } from './state.ts';
import { FootholdApp } from './ui/foothold-app.ts';
import { painter } from './view/painter.ts';

const store = new Store();
const app = document.querySelector('foothold-app');
if (!(app instanceof FootholdApp)) throw new Error('the page has no <foothold-app>');
dress(store);
store.update({ changes: loadChanges(allFields), history: store.state.history });
app.store = store;
store.listen((state) => {
  app.state = state;
});

const compiled = compileEngine();
prepareToPrint(store, compiled);

try {
  const module = await compiled;
  const pool = new Pool(pageLanes(module), workerCount(navigator.hardwareConcurrency));
  app.session = new Session(store, pool);
  app.painter = painter(pool, viewLane(module));
  store.update({ engine: 'ready', roles: await app.painter.roles() });
  const kept = await loadModels();
  keepWork(store);
  await app.session.start(location.href, kept);
} catch (error) {
  store.update({ engine: problemOf(error) });
}

/** The Print step's session over its part of the state; the layer view follows the print. */
function prepareToPrint(store: Store, compiled: Promise<WebAssembly.Module>): void {
  const print = {
    get state() {
      return store.state.print;
    },
    update: (change: Partial<State['print']>) => {
      const print = { ...store.state.print, ...change };
      const { result, step, layer } = store.state;
      const printed = change.journal && Math.max(0, change.journal.layer - 1);
      const follows = step === 'print' && printed !== undefined && print.job?.result === result;
      store.update(follows && printed !== layer ? { print, layer: printed } : { print });
    },
  };
  const printing = new PrintSession(print, compiled);
  if (app instanceof FootholdApp) app.printing = printing;
  void printing.start();
}

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

/** Gives the page its language and colours, as kept or as the browser asks for, and keeps later choices. */
function dress(store: Store): void {
  const system = matchMedia('(prefers-color-scheme: dark)');
  const isDark = ({ theme }: Pick<State, 'theme'>): boolean => (theme === 'system' ? system.matches : theme === 'dark');
  const preferences = loadPreferences();
  store.update({ ...preferences, dark: isDark(preferences) });
  system.addEventListener('change', () => store.update({ dark: isDark(store.state) }));
  let before: Pick<State, 'language' | 'theme'> | undefined;
  store.listen((state) => {
    document.documentElement.dataset['theme'] = isDark(state) ? 'dark' : 'light';
    if (state.dark !== isDark(state)) store.update({ dark: isDark(state) });
    const { language, theme } = state;
    if (before?.language === language && before.theme === theme) return;
    if (before?.language !== language) speak(language);
    if (before !== undefined) savePreferences({ language, theme });
    before = { language, theme };
  });
}
