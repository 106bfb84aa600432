// <foothold-slicer>: the app in another site's page, with a style of its own. It keeps nothing for the next visit:
// what is kept on the host's origin is the host's.
import style from '../style.css?inline';
import { App } from './app.ts';
import type { FootholdSlicerElement, PrintEvent, Report, SlicerProblem, SomeSettings } from './element-types.ts';
import { closest } from './i18n/text.ts';
import type { ModelSource } from './messages.ts';
import { type ThemeChoice, themes } from './preferences.ts';
import type { Kind } from './profiles/catalog.ts';
import { flattened, offered, withProfile } from './profiles/choice.ts';
import { problemOf } from './session.ts';
import type { Changes } from './settings/changes.ts';
import { partsOf } from './slicer/gcode.ts';
import { fetched, lastPart } from './source.ts';
import type { Problem, State } from './state.ts';
import { FootholdApp } from './ui/foothold-app.ts';

export type * from './element-types.ts';

const kinds: readonly Kind[] = ['printer', 'material', 'quality'];

/** One sheet for all elements of a page; made by script, it needs no leave of the page's style-src. */
let shared: CSSStyleSheet | undefined;

function sheet(): CSSStyleSheet {
  if (shared === undefined) {
    shared = new CSSStyleSheet();
    shared.replaceSync(style);
  }
  return shared;
}

export class FootholdSlicer extends HTMLElement implements FootholdSlicerElement {
  static readonly observedAttributes = ['src', ...kinds, 'locked', 'lang', 'theme'];
  readonly #root = this.attachShadow({ mode: 'open' });
  #app: App | undefined;
  #loading: Promise<void> = Promise.resolve();
  #settings: SomeSettings = {};

  constructor() {
    super();
    this.#root.adoptedStyleSheets = [sheet()];
  }

  connectedCallback(): void {
    this.#takeEarly();
    if (this.#app === undefined) this.#start();
  }

  disconnectedCallback(): void {
    // An element that is only moved in its page is there again at once.
    queueMicrotask(() => {
      if (!this.isConnected) this.#stop();
    });
  }

  attributeChangedCallback(name: string, before: string | null, after: string | null): void {
    const app = this.#app;
    if (app === undefined || before === after) return;
    const kind = kinds.find((it) => it === name);
    if (kind !== undefined) {
      app.store.update({ changes: withProfile(app.store.state.changes, kind, after ?? undefined) });
      const fault = this.#fault();
      if (fault !== undefined) app.store.update({ model: { kind: 'failed', problem: fault } });
    } else if (name === 'src') {
      this.#loadNamed();
    } else {
      app.store.update(this.#looks());
    }
  }

  get settings(): SomeSettings {
    return this.#settings;
  }

  set settings(settings: SomeSettings) {
    this.#settings = settings;
    this.#app?.store.update({ changes: this.#changes() });
  }

  load(model: Blob | URL | string): Promise<void> {
    this.#loading = this.#load(this.#running(), model);
    // Whoever slices hears of it as well; nobody has to listen.
    this.#loading.catch(() => undefined);
    return this.#loading;
  }

  async slice(): Promise<Report> {
    const app = this.#running();
    await this.#loading;
    const session = await app.session;
    if (app.store.state.model.kind !== 'open') throw named({ name: 'ModelError', message: 'no model is open' });
    await session.slice();
    const { job, result } = app.store.state;
    if (job.kind === 'failed' && this.#app === app) throw named(job.problem);
    if (job.kind !== 'done' || result?.sliced === undefined) throw new DOMException('cancelled', 'AbortError');
    return result.sliced;
  }

  gcode(): File | undefined {
    const result = this.#app?.store.state.result;
    if (result === undefined) return undefined;
    return new File(partsOf(result.gcode), result.gcode.joined.fileName, { type: 'text/x.gcode' });
  }

  #start(): void {
    const element = new FootholdApp();
    element.setAttribute('part', 'app');
    this.#root.replaceChildren(element);
    const app = new App(element, element, { ...this.#looks(), changes: this.#changes() });
    this.#app = app;
    let before = app.store.state;
    app.store.listen((state) => {
      // What an end brings about is nobody's error.
      if (this.#app === app) this.#tell(before, state);
      before = state;
    });
    this.#loadNamed();
  }

  /** Takes over settings that were set before the element was defined. */
  #takeEarly(): void {
    const early = Object.getOwnPropertyDescriptor(this, 'settings')?.value as SomeSettings | undefined;
    if (early === undefined) return;
    Reflect.deleteProperty(this, 'settings');
    this.settings = early;
  }

  #stop(): void {
    this.#app?.close();
    this.#app = undefined;
    this.#root.replaceChildren();
  }

  #running(): App {
    if (this.#app === undefined) throw new Error('<foothold-slicer> is not in a page');
    return this.#app;
  }

  #loadNamed(): void {
    const src = this.getAttribute('src');
    if (src !== null && src !== '') void this.load(src).catch(() => undefined);
  }

  async #load(app: App, model: Blob | URL | string): Promise<void> {
    try {
      const fault = this.#fault();
      if (fault !== undefined) throw named(fault);
      const [session, source] = await Promise.all([app.session, sourceOf(model)]);
      await session.replace([source]);
    } catch (error) {
      const { engine } = app.store.state;
      if (typeof engine === 'string') app.store.update({ model: { kind: 'failed', problem: problemOf(error) } });
    }
    const { model: now, engine } = app.store.state;
    if (typeof engine !== 'string') throw named(engine);
    if (now.kind === 'failed') throw named(now.problem);
  }

  /** What the attributes say about frame, language and colours. */
  #looks(): Pick<State, 'frame' | 'language' | 'theme'> {
    const language = this.closest<HTMLElement>('[lang]')?.lang ?? '';
    const theme = this.getAttribute('theme') ?? 'system';
    return {
      frame: this.hasAttribute('locked') ? 'locked' : 'embedded',
      language: closest(language === '' ? navigator.languages : [language, ...navigator.languages]),
      theme: themes.find((it): it is ThemeChoice => it === theme) ?? 'system',
    };
  }

  /** The profiles that the attributes name, and the settings over them. */
  #changes(): Changes {
    const profiles = kinds.reduce<Changes>(
      (changes, kind) => withProfile(changes, kind, this.getAttribute(kind) ?? undefined),
      {},
    );
    return { ...profiles, ...flattened(this.#settings) };
  }

  /** A profile that is named and not there. */
  #fault(): Problem | undefined {
    for (const kind of kinds) {
      const id = this.getAttribute(kind);
      const ids = offered[kind].map((it) => it.id);
      if (id === null || ids.includes(id)) continue;
      return { name: 'SettingsError', message: `there is no ${kind} "${id}": there are ${ids.join(', ')}` };
    }
    return undefined;
  }

  /** Sends what has changed between two states as events. */
  #tell(before: State, now: State): void {
    const { result } = now;
    if (result?.sliced !== undefined && result !== before.result) this.#send<Report>('foothold-sliced', result.sliced);
    const known = problemsOf(before);
    for (const problem of problemsOf(now)) {
      if (!known.includes(problem)) this.#send<SlicerProblem>('foothold-error', problem);
    }
    const { job, end } = now.print;
    if (job === undefined) return;
    const { name } = job;
    if (job !== before.print.job) this.#send<PrintEvent>('foothold-print', { state: 'started', name });
    if (end !== undefined && end !== before.print.end) {
      this.#send<PrintEvent>('foothold-print', { state: end.kind, name });
    }
  }

  #send<T>(name: string, detail: T): void {
    this.dispatchEvent(new CustomEvent<T>(name, { detail, bubbles: true, composed: true }));
  }
}

/** All that the state says went wrong. */
function problemsOf({ engine, model, job, trouble }: State): readonly Problem[] {
  return [
    typeof engine === 'string' ? undefined : engine,
    model.kind === 'failed' ? model.problem : undefined,
    job.kind === 'failed' ? job.problem : undefined,
    trouble,
  ].filter((it) => it !== undefined);
}

async function sourceOf(model: Blob | URL | string): Promise<ModelSource> {
  if (!(model instanceof Blob)) return fetched(String(model), decodeURIComponent(lastPart(String(model))));
  return { name: model instanceof File ? model.name : 'model.stl', file: model };
}

function named({ name, message }: Problem): Error {
  return Object.assign(new Error(message), { name });
}

if (customElements.get('foothold-slicer') === undefined) customElements.define('foothold-slicer', FootholdSlicer);
