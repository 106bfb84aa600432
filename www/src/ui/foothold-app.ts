// The page: hands the state to its parts and their events to the session.
import { html, nothing, type TemplateResult } from 'lit';
import settingsSchema from '../../../schema/settings.schema.json';
import { en } from '../i18n/en.ts';
import type { Bounds, LegendEntry, PictureView } from '../messages.ts';
import type { Session } from '../session.ts';
import { withChange } from '../settings/changes.ts';
import type { Schema } from '../settings/fields.ts';
import { heightOf, layerOf } from '../slicer/gcode.ts';
import { initial, isStale, type Result, type State, type Store } from '../state.ts';
import type { LayerText, Painter } from '../view/painter.ts';

import '../view/layer-view.ts';
import './drop-zone.ts';
import './job-bar.ts';
import './layer-slider.ts';
import { Part } from './part.ts';
import { problemBox } from './problem-box.ts';
import './result-figures.ts';
import './settings-form.ts';
import type { SettingChange } from './settings-form.ts';

const sides: readonly PictureView[] = ['iso', 'top', 'front'];

export class FootholdApp extends Part {
  static override properties = {
    state: { attribute: false },
    session: { attribute: false },
    painter: { attribute: false },
    store: { attribute: false },
  };
  declare state: State;
  declare store: Store | undefined;
  declare session: Session | undefined;
  declare painter: Painter | undefined;

  /** The layer shown and what it was made of; kept while neither changes. */
  #shown: (LayerText & { readonly result: Result; readonly layer: number; readonly height: string }) | undefined;

  constructor() {
    super();
    this.state = initial;
    this.store = undefined;
    this.session = undefined;
    this.painter = undefined;
  }

  protected override willUpdate(): void {
    const { result, layer } = this.state;
    if (result === this.#shown?.result && layer === this.#shown?.layer) return;
    const text = result === undefined ? new Uint8Array() : layerOf(result.gcode, layer);
    this.#shown = result && { result, layer, text, settings: result.settings, height: heightOf(text) };
  }

  protected override render(): TemplateResult {
    return html`
      <header class="top">
        <img src="./icon.svg" alt="" width="28" height="28" />
        <h1>${en.title}</h1>
        <p>${en.tagline}</p>
      </header>
      <main class="page">
        <div class="column prepare">
          ${typeof this.state.engine === 'string' ? nothing : problemBox(this.state.engine)}
          <drop-zone .model=${this.state.model} .starting=${this.state.engine === 'starting'} @open-file=${this.#open}></drop-zone>
          ${this.#settings()} ${this.#job()}
        </div>
        <section class="view" aria-label=${en.view.heading}>${this.#tabs()} ${this.#picture()}</section>
        <div class="column results">${this.#figures()}</div>
      </main>
      <p class="unseen" role="status">${this.#said()}</p>
    `;
  }

  #job(): TemplateResult {
    return html`<job-bar
      .job=${this.state.job}
      .ready=${this.state.model.kind === 'open'}
      .done=${this.state.result !== undefined}
      .stale=${isStale(this.state)}
      @slice=${() => void this.session?.slice()}
      @cancel=${() => this.session?.cancel()}
      @download=${() => this.session?.download()}
    ></job-bar>`;
  }

  #settings(): TemplateResult {
    return html`<settings-form
      .schema=${settingsSchema as Schema}
      .changes=${this.state.changes}
      @setting-change=${({ detail: { field, value } }: CustomEvent<SettingChange>) =>
        this.store?.update({ changes: withChange(this.state.changes, field, value) })}
    ></settings-form>`;
  }

  #tabs(): TemplateResult {
    const { show, side, result } = this.state;
    return html`<div class="view-bar">
      <div class="choice" role="group" aria-label=${en.view.choice}>
        ${choice(en.view.model, show === 'model', () => this.store?.update({ show: 'model' }))}
        ${choice(en.view.layers, show === 'layers', () => this.store?.update({ show: 'layers' }), result === undefined)}
      </div>
      ${
        show === 'model'
          ? html`<div class="choice" role="group" aria-label=${en.view.side}>
            ${sides.map((it) => choice(en.view.sides[it], side === it, () => this.store?.update({ side: it })))}
          </div>`
          : nothing
      }
    </div>`;
  }

  #picture(): TemplateResult {
    const { show, side, result, layer } = this.state;
    return html`<div class="picture">
      <layer-view
        .painter=${this.painter}
        .show=${show}
        .side=${side}
        .model=${this.state.model.kind === 'open' ? this.state.model : undefined}
        .job=${result}
        .extent=${result && extentOf(result)}
        .layer=${this.#shown}
        .label=${this.#label()}
        @legend=${({ detail }: CustomEvent<readonly LegendEntry[]>) => this.store?.update({ legend: detail })}
        @layer-step=${({ detail }: CustomEvent<number>) => this.session?.showLayer(layer + detail)}
      ></layer-view>
      ${
        show === 'layers' && result !== undefined
          ? html`<layer-slider
            .layer=${layer}
            .total=${result.gcode.layers.length}
            .height=${this.#shown?.height ?? ''}
            @layer-change=${this.#layer}
          ></layer-slider>`
          : nothing
      }
    </div>`;
  }

  #label(): string {
    const { show, result, layer, model } = this.state;
    if (show === 'layers') return en.view.layerPicture(layer + 1, result?.gcode.layers.length ?? 0);
    return model.kind === 'open' ? en.view.modelPicture(model.source.name) : en.view.heading;
  }

  #figures(): TemplateResult {
    const { result, legend } = this.state;
    return html`<result-figures
      .report=${result?.report}
      .legend=${legend}
      @layer-change=${this.#layer}
    ></result-figures>`;
  }

  /** What a screen reader is told, a few times in a job. */
  #said(): string {
    const { engine, model, job, result } = this.state;
    if (engine === 'starting') return en.loading;
    if (job.kind === 'running') {
      const { stage, done, total } = job.progress;
      const quarter = stage === 'layers' && total > 0 ? Math.floor((4 * done) / total) / 4 : 0;
      return quarter > 0 ? en.job.percent(quarter) : en.job.stages[stage];
    }
    if (job.kind === 'cancelled') return en.job.cancelled;
    if (job.kind === 'done' && result !== undefined) {
      return en.job.done(result.report.layers, en.figures.duration(result.report.time_s));
    }
    if (model.kind === 'reading') return en.model.reading(model.source.name);
    return model.kind === 'open' ? en.model.opened(model.source.name) : '';
  }

  #open({ detail }: CustomEvent<File>): void {
    void this.session?.open({ name: detail.name, file: detail });
  }

  #layer({ detail }: CustomEvent<number>): void {
    this.session?.showLayer(detail);
  }
}

/** Room around the model for what is printed beside it, mm. */
const MARGIN = 6;

/** What the layers of a result cover on the bed. */
function extentOf({ report }: Result): Bounds {
  const [min, max] = report.model.bounds;
  return [min[0] - MARGIN, min[1] - MARGIN, max[0] + MARGIN, max[1] + MARGIN];
}

function choice(label: string, chosen: boolean, choose: () => void, off = false): TemplateResult {
  return html`<button type="button" aria-pressed=${chosen} aria-disabled=${off} @click=${() => !off && choose()}>
    ${label}
  </button>`;
}

customElements.define('foothold-app', FootholdApp);
