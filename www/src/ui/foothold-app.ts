// The page: the steps' bar, the chosen step's panel beside the view that all steps share, and the job.
import { html, nothing, type TemplateResult } from 'lit';
import { t } from '../i18n/text.ts';
import type { Edit } from '../messages.ts';
import type { ThemeChoice } from '../preferences.ts';
import type { PrintSession } from '../printer/print-session.ts';
import { isBusy, isStale, type Step } from '../state.ts';
import type { Painter } from '../view/painter.ts';
import './job-bar.ts';
import './learn-step.ts';
import './page-menu.ts';
import type { PrepareStep } from './prepare-step.ts';
import './prepare-step.ts';
import './preview-step.ts';
import './print-step.ts';
import { problemBox } from './problem-box.ts';
import type { SettingsForm } from './settings-form.ts';
import './step-bar.ts';
import { StepPart } from './step-part.ts';
import { surroundings } from './surroundings.ts';
import './step-view.ts';

/** The steps there are, in their order; where settings are fixed there is nothing to try out. */
const steps: readonly Step[] = ['prepare', 'preview', 'print', 'learn'];
const lockedSteps: readonly Step[] = ['prepare', 'preview', 'print'];

export class FootholdApp extends StepPart {
  static override properties = {
    ...StepPart.properties,
    painter: { attribute: false },
    printing: { attribute: false },
  };
  declare painter: Painter | undefined;
  declare printing: PrintSession | undefined;
  #deaf: AbortController | undefined;

  constructor() {
    super();
    this.painter = undefined;
    this.printing = undefined;
  }

  override connectedCallback(): void {
    super.connectedCallback();
    this.#deaf = new AbortController();
    surroundings(this).addEventListener('keydown', this.#key, { signal: this.#deaf.signal });
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.#deaf?.abort();
  }

  /** Undo and redo, unless the key belongs to the text that is being typed. */
  #key = (event: Event): void => {
    if (!(event instanceof KeyboardEvent)) return;
    const [target] = event.composedPath();
    const isTyping = target instanceof HTMLElement && target.matches('input[type=text], input[type=search], textarea');
    if (!(event.ctrlKey || event.metaKey) || event.altKey || isTyping) return;
    const key = event.key.toLowerCase();
    const redo = key === 'y' || (key === 'z' && event.shiftKey);
    if (!redo && key !== 'z') return;
    event.preventDefault();
    if (redo) this.session?.redo();
    else this.session?.undo();
  };

  protected override render(): TemplateResult {
    const { step, engine, language, dark, frame } = this.state;
    const isPage = frame === 'page';
    return html`
      <div class="top" part="top" role=${isPage ? 'banner' : nothing}>
        <slot name="brand">
          <div class="brand" part="brand">${icon} ${isPage ? html`<h1>${t.title}</h1>` : html`<p>${t.title}</p>`}</div>
        </slot>
        <step-bar
          part="steps"
          .steps=${frame === 'locked' ? lockedSteps : steps}
          .step=${step}
          @step-change=${({ detail }: CustomEvent<Step>) => this.store?.update({ step: detail })}
        ></step-bar>
        <page-menu
          part="menu"
          .language=${language}
          .dark=${dark}
          @language-change=${({ detail }: CustomEvent<typeof language>) => this.store?.update({ language: detail })}
          @theme-change=${({ detail }: CustomEvent<ThemeChoice>) => this.store?.update({ theme: detail })}
        ></page-menu>
      </div>
      <div class="page ${step === 'learn' ? 'learning' : ''}" role=${isPage ? 'main' : nothing}>
        <div
          class="panel"
          part="panel"
          id="panel"
          role="tabpanel"
          aria-labelledby="tab-${step}"
          @show-setting=${({ detail }: CustomEvent<string>) => void this.#showSetting(detail)}
        >
          <slot name="notice"></slot>
          ${isBusy(this.state) ? nothing : this.#news()}
          ${typeof engine === 'string' ? nothing : problemBox(engine)}
          <div class="panel-scroll">${this.#panel()}</div>
          ${step === 'learn' ? nothing : this.#job()}
          <slot name="actions"></slot>
        </div>
        <step-view
          part="view"
          ?hidden=${step === 'learn'}
          .state=${this.state}
          .store=${this.store}
          .session=${this.session}
          .painter=${this.painter}
        ></step-view>
      </div>
      <p class="unseen" role="status">${this.#said()}</p>
    `;
  }

  /** That there is a newer page; not said during a job, which it would end. */
  #news(): TemplateResult | typeof nothing {
    const { newVersion } = this.state;
    if (newVersion === undefined) return nothing;
    return html`<div class="remark row spread" role="status">
      <span>${newVersion === 'ready' ? t.page.newVersion : t.page.versionWaits}</span>
      <button type="button" class="button small" @click=${() => this.tell('take-new-version')}>${t.page.reload}</button>
    </div>`;
  }

  /** The panel of the chosen step. */
  #panel(): TemplateResult | typeof nothing {
    const { state, store, session } = this;
    switch (state.step) {
      case 'prepare':
        return html`<prepare-step .state=${state} .store=${store} .session=${session}></prepare-step>`;
      case 'preview':
        return html`<preview-step .state=${state} .store=${store} .session=${session}></preview-step>`;
      case 'print':
        return html`<print-step .state=${state} .store=${store} .session=${session} .printing=${this.printing}></print-step>`;
      case 'learn':
        return html`<learn-step .state=${state} .store=${store} .session=${session}></learn-step>`;
      default:
        return state.step satisfies never;
    }
  }

  #job(): TemplateResult {
    return html`<job-bar
      part="job"
      .job=${this.state.job}
      .ready=${this.state.model.kind === 'open'}
      .done=${this.state.result !== undefined}
      .stale=${isStale(this.state)}
      .fixed=${this.state.frame === 'locked'}
      @slice=${() => void this.session?.slice()}
      @mend=${({ detail }: CustomEvent<Edit>) => void this.session?.mend(detail)}
      @cancel=${() => this.session?.cancel()}
      @download=${() => this.session?.download()}
    ></job-bar>`;
  }

  /** Goes to a setting of the plate, from whichever step. */
  async #showSetting(path: string): Promise<void> {
    this.store?.update({ step: 'prepare' });
    await this.updateComplete;
    const step = this.querySelector<PrepareStep>('prepare-step');
    await step?.updateComplete;
    await step?.querySelector<SettingsForm>(':scope > settings-form')?.reveal(path);
  }

  /** What a screen reader is told, a few times in a job. */
  #said(): string {
    const { engine, model, job, result } = this.state;
    if (engine === 'starting') return t.loading;
    if (job.kind === 'running') {
      const { stage, done, total } = job.progress;
      const quarter = stage === 'layers' && total > 0 ? Math.floor((4 * done) / total) / 4 : 0;
      return quarter > 0 ? t.job.percent(quarter) : t.job.stages[stage];
    }
    if (job.kind === 'cancelled') return t.job.cancelled;
    if (job.kind === 'done' && result !== undefined) {
      const done = t.job.done(result.report.layers, t.format.duration(result.report.time_s));
      const remarks = result.report.warnings.length;
      return remarks === 0 ? done : `${done} ${t.job.remarks(remarks)}`;
    }
    if (model.kind === 'reading') return t.model.reading(model.source.name);
    return model.kind === 'open' ? t.model.opened(model.source.name) : '';
  }
}

const icon = html`<svg class="icon" viewBox="0 0 32 32" width="28" height="28" aria-hidden="true">
  <rect width="32" height="32" rx="7" fill="#0f766e" />
  <path d="M9 22V8h12v4h-8v3h6v4h-6v3z" fill="#fff" />
  <path
    d="M6 25h2.5l1.5-2 1.5 2h2l1.5-2 1.5 2h2l1.5-2 1.5 2H26"
    fill="none"
    stroke="#99f6e4"
    stroke-width="1.6"
    stroke-linejoin="round"
  />
</svg>`;

customElements.define('foothold-app', FootholdApp);
