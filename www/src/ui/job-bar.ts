// The job: slice, how far it is, cancel, download.
import { html, nothing, type TemplateResult } from 'lit';
import { t } from '../i18n/text.ts';
import type { Edit } from '../messages.ts';
import { type JobState, shareOf } from '../state.ts';
import { Part } from './part.ts';
import { problemBox } from './problem-box.ts';

/** Sends `slice`, `cancel` and `download`, `mend` with an Edit for every part, `show-setting` with a path. */
export class JobBar extends Part {
  static override properties = {
    job: { attribute: false },
    ready: { type: Boolean },
    done: { type: Boolean },
    stale: { type: Boolean },
    fixed: { type: Boolean },
  };
  declare job: JobState;
  /** There is a model to slice. */
  declare ready: boolean;
  /** There is G-code to download. */
  declare done: boolean;
  declare stale: boolean;
  /** The settings cannot be changed. */
  declare fixed: boolean;

  constructor() {
    super();
    this.job = { kind: 'idle' };
    this.ready = false;
    this.done = false;
    this.stale = false;
    this.fixed = false;
  }

  protected override render(): TemplateResult {
    const running = this.job.kind === 'running';
    return html`
      <section class="card job" aria-label=${t.job.heading}>
        <div class="row buttons">
          <button
            type="button"
            class="button ${this.done && !this.stale ? '' : 'primary'}"
            part="button slice"
            aria-disabled=${!this.ready || running}
            @click=${() => this.ready && !running && this.tell('slice')}
          >
            ${t.job.slice}
          </button>
          ${running ? this.#cancel() : this.#download()}
        </div>
        ${this.#status()}
      </section>
    `;
  }

  #cancel(): TemplateResult {
    return html`<button type="button" class="button" part="button cancel" @click=${() => this.tell('cancel')}>${t.job.cancel}</button>`;
  }

  #download(): TemplateResult {
    return html`<button
      type="button"
      class="button ${this.done && !this.stale ? 'primary' : ''}"
      part="button download"
      aria-disabled=${!this.done}
      @click=${() => this.done && this.tell('download')}
    >
      ${t.job.download}
    </button>`;
  }

  #status(): TemplateResult | typeof nothing {
    switch (this.job.kind) {
      case 'idle':
        return nothing;
      case 'cancelled':
        return html`<p class="hint">${t.job.cancelled}</p>`;
      case 'done':
        return this.stale ? html`<p class="remark">${t.job.stale}</p>` : nothing;
      case 'failed':
        return problemBox(
          this.job.problem,
          (fix) => this.tell<Edit>('mend', fix),
          this.fixed ? undefined : (path) => this.tell<string>('show-setting', path),
        );
      case 'running': {
        const { stage, done, total } = this.job.progress;
        return html`
          <progress aria-label=${t.job.progress} max="1" .value=${shareOf(this.job.progress)}></progress>
          <p class="hint">${t.job.stages[stage]}${stage === 'layers' ? ` ${t.job.layers(done, total)}` : ''}</p>
        `;
      }
      default:
        return this.job satisfies never;
    }
  }
}

customElements.define('job-bar', JobBar);
