// Creates the page's parts and connects them.
import { problemOf, Session } from './session.ts';
import { Pool } from './slicer/pool.ts';
import { compileEngine, pageLanes, viewLane, workerCount } from './slicer/threads.ts';
import { Store } from './state.ts';
import { FootholdApp } from './ui/foothold-app.ts';
import { painter } from './view/painter.ts';

const store = new Store();
const app = document.querySelector('foothold-app');
if (!(app instanceof FootholdApp)) throw new Error('the page has no <foothold-app>');
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
