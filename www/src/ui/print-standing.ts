// A print that stands, since the cable was pulled or the tab was closed: go on, begin at a layer, or give it up.
import { html, nothing, type TemplateResult } from 'lit';
import { t } from '../i18n/text.ts';
import type { Standing } from '../printer/journal.ts';
import { hasJob } from '../printer/link.ts';
import { PrintPart } from './print-part.ts';

/** How far a pause lifts the head, mm: as the engine's park lines do. */
const PARK_LIFT = 5;

export class PrintStanding extends PrintPart {
  #layer: number | undefined;
  #height: number | undefined;

  protected override render(): TemplateResult | typeof nothing {
    const { standing, printer } = this.print;
    if (standing === undefined || hasJob(printer)) return nothing;
    const { journal, name } = standing;
    const line = t.format.number((journal.acked_line ?? -1) + 1, 0);
    return html`<section class="card" aria-label=${t.printing.standing.heading}>
      <h2>${t.printing.standing.heading}</h2>
      <p>${t.printing.standing.where(name, line, journal.layer)}</p>
      ${this.#ways(standing)}
      <div class="row">
        <button type="button" class="link" @click=${() => this.printing?.forgetStanding()}>
          ${t.printing.standing.forget}
        </button>
      </div>
    </section>`;
  }

  #ways(standing: Standing): TemplateResult {
    const { printer, kept } = this.print;
    const words = t.printing.standing;
    if (printer !== 'ready') return html`<p class="hint">${words.connect}</p>`;
    if (kept === undefined) return html`<p class="hint" role="status">${words.wait}</p>`;
    if (!kept) return this.#atLayer(standing);
    const line = (standing.journal.acked_line ?? -1) + 1;
    return html`
      <p>${words.kept}</p>
      <div class="row buttons">
        <button type="button" class="button primary" @click=${() => this.printing?.goOn({ kind: 'line', line })}>
          ${words.goOn}
        </button>
      </div>
    `;
  }

  #atLayer({ outline, journal, parked }: Standing): TemplateResult {
    const words = t.printing.standing;
    const count = outline.layers.length;
    const why = parked ? words.parked : words.lost;
    if (count === 0) return html`<p>${why}</p>`;
    const layer = this.#layer ?? Math.min(Math.max(journal.layer, 1), count);
    const left = journal.z ?? outline.layers[layer - 1]?.z ?? 0;
    const height = this.#height ?? left + (parked ? PARK_LIFT : 0);
    const begin = (): void => this.printing?.goOn({ kind: 'layer', layer: layer - 1, z: height });
    return html`
      <p>${why}</p>
      ${this.#number(words.layer, layer, 1, count, 1, (value) => {
        this.#layer = Math.round(value);
      })}
      ${this.#number(words.height, height, 0, 2000, 0.01, (value) => {
        this.#height = value;
      })}
      <p class="hint">${parked ? words.parkedHint : words.heightHint}</p>
      <div class="row buttons">
        <button type="button" class="button primary" @click=${begin}>${words.begin}</button>
      </div>
    `;
  }

  #number(
    label: string,
    value: number,
    least: number,
    most: number,
    step: number,
    set: (value: number) => void,
  ): TemplateResult {
    const change = (event: Event): void => {
      const typed = (event.target as HTMLInputElement).valueAsNumber;
      if (Number.isFinite(typed)) set(Math.min(Math.max(typed, least), most));
      this.requestUpdate();
    };
    return html`<label class="line">
      <span>${label}</span>
      <input type="number" min=${least} max=${most} step=${step} .value=${String(value)} @change=${change} />
    </label>`;
  }
}

customElements.define('print-standing', PrintStanding);
