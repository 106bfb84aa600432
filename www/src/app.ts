// What runs behind a <foothold-app>, in the page and in <foothold-slicer> alike: its state, its session, its workers.
import { onLanguage, speak, spoken } from './i18n/text.ts';
import { PrintSession } from './printer/print-session.ts';
import { problemOf, Session } from './session.ts';
import { Pool } from './slicer/pool.ts';
import { compileEngine, pageLanes, viewLane, workerCount } from './slicer/threads.ts';
import { type State, Store } from './state.ts';
import type { FootholdApp } from './ui/foothold-app.ts';
import { type Painter, painter } from './view/painter.ts';

export class App {
  readonly store = new Store();
  /** Resolves once the engine is there; rejects when it can't be had, which the state tells as well. */
  readonly session: Promise<Session>;
  readonly #element: FootholdApp;
  readonly #printing: PrintSession;
  readonly #end = new AbortController();
  #pool: Pool | undefined;
  #painter: Painter | undefined;

  /** `root` carries language and colours; `begin` is where the state differs from that of a first visit. */
  constructor(element: FootholdApp, root: HTMLElement, begin: Partial<State>) {
    this.#element = element;
    this.store.update({ ...begin, history: this.store.state.history });
    this.#dress(root);
    element.store = this.store;
    this.store.listen((state) => {
      element.state = state;
    });
    const compiled = compileEngine();
    this.#printing = this.#prepareToPrint();
    this.session = this.#start(compiled);
    this.session.catch((error: unknown) => {
      if (!this.#end.signal.aborted) this.store.update({ engine: problemOf(error) });
    });
  }

  /** Ends all workers; the app is not used any more. */
  close(): void {
    this.#end.abort();
    this.#printing.close();
    this.#pool?.close();
    this.#painter?.close();
  }

  async #start(compiled: Promise<WebAssembly.Module>): Promise<Session> {
    const module = await compiled;
    this.#end.signal.throwIfAborted();
    this.#pool = new Pool(pageLanes(module), workerCount(navigator.hardwareConcurrency));
    const session = new Session(this.store, this.#pool);
    this.#element.session = session;
    this.#painter = painter(this.#pool, () => viewLane(module));
    this.#element.painter = this.#painter;
    this.store.update({ engine: 'ready', roles: await this.#painter.roles() });
    return session;
  }

  /** The Print step's session over its part of the state; the layer view follows the print. */
  #prepareToPrint(): PrintSession {
    const { store } = this;
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
    const printing = new PrintSession(print);
    this.#element.printing = printing;
    void printing.start();
    return printing;
  }

  /** Gives `root` its language and colours, as chosen or as the system has them. */
  #dress(root: HTMLElement): void {
    const { store } = this;
    const { signal } = this.#end;
    const system = matchMedia('(prefers-color-scheme: dark)');
    const isDark = ({ theme }: State): boolean => (theme === 'system' ? system.matches : theme === 'dark');
    system.addEventListener('change', () => store.update({ dark: isDark(store.state) }), { signal });
    signal.addEventListener(
      'abort',
      onLanguage(() => {
        root.lang = spoken();
      }),
    );
    let language: State['language'] | undefined;
    store.listen((state) => {
      const dark = isDark(state);
      root.dataset['theme'] = dark ? 'dark' : 'light';
      if (state.dark !== dark) store.update({ dark });
      if (state.language === language) return;
      language = state.language;
      speak(language);
    });
  }
}
