// The steps as tabs: arrow keys go from one to the next.
import { html, type TemplateResult } from 'lit';
import { t } from '../i18n/text.ts';
import type { Step } from '../state.ts';
import { Part } from './part.ts';

/** Sends `step-change` with a Step. */
export class StepBar extends Part {
  static override properties = { steps: { attribute: false }, step: { attribute: false } };
  declare steps: readonly Step[];
  declare step: Step;

  constructor() {
    super();
    this.steps = [];
    this.step = 'prepare';
  }

  protected override render(): TemplateResult {
    return html`<div class="steps" role="tablist" aria-label=${t.steps.heading} @keydown=${this.#key}>
      ${this.steps.map((step) => this.#tab(step))}
    </div>`;
  }

  #tab(step: Step): TemplateResult {
    const chosen = step === this.step;
    return html`<button
      type="button"
      role="tab"
      id="tab-${step}"
      part="step step-${step}"
      aria-selected=${chosen}
      aria-controls="panel"
      tabindex=${chosen ? 0 : -1}
      @click=${() => this.#go(step)}
    >
      ${t.steps[step]}
    </button>`;
  }

  #key = (event: KeyboardEvent): void => {
    const next = this.#target(event.key);
    if (next === undefined) return;
    event.preventDefault();
    this.#go(next);
    this.querySelector<HTMLElement>(`#tab-${next}`)?.focus();
  };

  #target(key: string): Step | undefined {
    const { steps } = this;
    const at = steps.indexOf(this.step);
    const to = { ArrowRight: at + 1, ArrowLeft: at - 1, Home: 0, End: steps.length - 1 }[key];
    return to === undefined ? undefined : steps[(to + steps.length) % steps.length];
  }

  #go(step: Step): void {
    this.tell('step-change', step);
  }
}

customElements.define('step-bar', StepBar);
