// "How shall it stick?": every kind of base layer drawn on the part, with what it costs and how it holds.
import { html, nothing, type TemplateResult } from 'lit';
import { t } from '../i18n/text.ts';
import type { BaseKind, BaseLayer, BaseLayers } from '../studies.ts';
import { Asked, numberOf } from './asked.ts';
import { drawing } from './drawing.ts';
import { problemBox } from './problem-box.ts';
import { StepPart } from './step-part.ts';

/** Length of the pictures, px: that of the largest column they stand in. */
const SIDE = 150;

const DEFAULT: BaseKind = 'teeth';

export class BaseLayerPanel extends StepPart {
  readonly #asked = new Asked<BaseLayers>(this);

  protected override willUpdate(): void {
    const { model, parts, changes, dark } = this.state;
    // The chosen kind changes no picture.
    const { 'adhesion.kind': _, ...others } = changes;
    const key =
      model.kind === 'open' ? `${numberOf(model)} ${numberOf(parts)} ${dark} ${JSON.stringify(others)}` : undefined;
    const { session } = this;
    if (session === undefined) return;
    this.#asked.want(key, () => session.study<BaseLayers>({ about: 'baseLayers', side: SIDE, dark }));
  }

  protected override render(): TemplateResult | typeof nothing {
    if (this.state.model.kind !== 'open') return nothing;
    const { answer, problem, waiting } = this.#asked;
    return html`<section class="card base-layers" aria-labelledby="base-heading" aria-busy=${waiting}>
      <h2 id="base-heading">${t.panels.base.heading}</h2>
      ${problem === undefined ? nothing : problemBox(problem)}
      ${answer === undefined ? html`<p class="hint">${problem === undefined ? t.panels.waiting : ''}</p>` : this.#choices(answer)}
    </section>`;
  }

  #choices({ recommendation, kinds }: BaseLayers): TemplateResult {
    const chosen = this.#chosen();
    const shown = kinds.find(({ kind }) => kind === chosen);
    const { reasons } = recommendation;
    const why = reasons.map((it) => t.panels.base.reasons[it]).join(', ');
    return html`
      <p class="hint">${reasons.length === 0 ? t.panels.base.plain : t.panels.base.why(why)}</p>
      <div class="kinds" role="radiogroup" aria-labelledby="base-heading">
        ${kinds.map((kind) => this.#kind(kind, kind.kind === chosen, kind.kind === recommendation.kind))}
      </div>
      ${shown === undefined ? nothing : this.#details(shown)}
      <details class="all">
        <summary>${t.panels.base.all}</summary>
        ${this.#table(kinds)}
      </details>
    `;
  }

  #chosen(): string {
    return String(this.state.changes['adhesion.kind'] ?? DEFAULT);
  }

  #kind(layer: BaseLayer, chosen: boolean, best: boolean): TemplateResult {
    const words = t.panels.base;
    const name = words.kinds[layer.kind];
    return html`<label class="kind ${chosen ? 'chosen' : ''}">
      <input
        type="radio"
        name="base-kind"
        value=${layer.kind}
        .checked=${chosen}
        aria-describedby="base-${layer.kind}"
        @change=${() => this.#choose(layer.kind)}
      />
      ${drawing(layer.svg, words.picture(name))}
      <span class="kind-name">${name}</span>
      <span class="kind-figures" id="base-${layer.kind}">
        <span title=${words.filament}>${t.format.number(layer.filament_mm3 + 0, 0)} mm³</span> ·
        <span title=${words.attachmentHelp}>${t.format.number(100 * layer.attachment_share, 0)} %</span>
        ${best ? html`<span class="badge best">${words.best}</span>` : nothing}
      </span>
    </label>`;
  }

  #details(layer: BaseLayer): TemplateResult {
    const words = t.panels.base;
    const { teeth } = layer;
    const bites = teeth && t.format.range(teeth.bite_min_mm, teeth.bite_max_mm, 2);
    return html`
      <p>${words.what[layer.kind]}</p>
      ${teeth && bites ? html`<p class="hint">${words.teeth(String(teeth.placed), bites)}</p>` : nothing}
      ${
        layer.warnings.length === 0
          ? nothing
          : html`<ul class="remarks">
            ${layer.warnings.map((it) => html`<li>${it}</li>`)}
          </ul>`
      }
    `;
  }

  #table(kinds: readonly BaseLayer[]): TemplateResult {
    const words = t.panels.base;
    const number = t.format.number;
    const row = (it: BaseLayer): TemplateResult => html`<tr data-kind=${it.kind}>
      <th scope="row">${words.kinds[it.kind]}</th>
      <td>${number(it.filament_mm3 + 0, 1)} mm³</td>
      <td>${t.format.duration(it.time_s + 0)}</td>
      <td>${number(it.bed_contact_mm2 + 0, 0)} mm²</td>
      <td>${number(it.attachment_mm, 1)} mm, ${number(100 * it.attachment_share, 0)} %</td>
    </tr>`;
    return html`<div class="wide-table" tabindex="0" role="region" aria-label=${words.all}>
      <table class="figures-table">
        <thead>
          <tr>
            <th scope="col">${words.kind}</th>
            <th scope="col">${words.filament}</th>
            <th scope="col">${words.time}</th>
            <th scope="col">${words.contact}</th>
            <th scope="col" title=${words.attachmentHelp}>${words.attachment}</th>
          </tr>
        </thead>
        <tbody>
          ${kinds.map(row)}
        </tbody>
      </table>
    </div>`;
  }

  #choose(kind: BaseKind): void {
    const { 'adhesion.kind': _, ...others } = this.state.changes;
    this.store?.update({ changes: kind === DEFAULT ? others : { ...others, 'adhesion.kind': kind } });
  }
}

customElements.define('base-layer-panel', BaseLayerPanel);
