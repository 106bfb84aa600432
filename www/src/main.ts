// Creates the page's parts and connects them.
import { speak } from './i18n/text.ts';
import { loadPreferences, savePreferences } from './preferences.ts';
import { problemOf, Session } from './session.ts';
import { Pool } from './slicer/pool.ts';
import { compileEngine, pageLanes, viewLane, workerCount } from './slicer/threads.ts';
import { type State, Store } from './state.ts';
import { FootholdApp } from './ui/foothold-app.ts';
import { painter } from './view/painter.ts';

const store = new Store();
const app = document.querySelector('foothold-app');
if (!(app instanceof FootholdApp)) throw new Error('the page has no <foothold-app>');
dress(store);
app.store = store;
store.listen((state) => {
  app.state = state;
});

try {
  const module = await compileEngine();
  const pool = new Pool(pageLanes(module), workerCount(navigator.hardwareConcurrency));
  app.session = new Session(store, pool);
  app.painter = painter(pool, viewLane(module));
  store.update({ engine: 'ready' });
  await app.session.start(location.href);
} catch (error) {
  store.update({ engine: problemOf(error) });
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
