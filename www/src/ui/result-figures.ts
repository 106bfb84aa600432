// What the print takes: time, filament, cost, and which colour stands for what.
import { html, nothing, type TemplateResult } from 'lit';
import type { Report, RoleUse } from '../generated/report.ts';
import { en } from '../i18n/en.ts';
import type { LegendEntry } from '../messages.ts';
import { words } from '../settings/fields.ts';
import type { Remark } from '../state.ts';
import { Part } from './part.ts';

/** Sends `layer-change` when a remark's layer is chosen. */
export class ResultFigures extends Part {
  static override properties = {
    report: { attribute: false },
    legend: { attribute: false },
  };
  declare report: Report | undefined;
  declare legend: readonly LegendEntry[];
  /** Colours of the roles seen so far: a layer's legend names only those on it. */
  readonly #colours = new Map<string, string>();

  constructor() {
    super();
    this.report = undefined;
    this.legend = [];
  }

  protected override willUpdate(): void {
    for (const { role, color } of this.legend) this.#colours.set(role, color);
  }

  protected override render(): TemplateResult {
    const { report } = this;
    if (report === undefined) return this.#empty();
    return html`
      <section class="card" aria-labelledby="figures-heading">
        <h2 id="figures-heading">${en.figures.heading}</h2>
        ${this.#figures(report)} ${this.#legend(report)} ${this.#remarks(report.warnings)}
      </section>
    `;
  }

  #empty(): TemplateResult {
    return html`<section class="card" aria-labelledby="figures-heading">
      <h2 id="figures-heading">${en.figures.heading}</h2>
      <p class="hint">${en.figures.empty}</p>
    </section>`;
  }

  #figures(report: Report): TemplateResult {
    const { filament, time_s, layers } = report;
    const figures = [
      [en.figures.time, en.figures.duration(time_s)],
      [en.figures.layers, String(layers)],
      [en.figures.filament, en.figures.metres(filament.length_mm)],
      [en.figures.mass, en.figures.grams(filament.mass_g)],
      [en.figures.cost, en.figures.money(filament.cost)],
    ];
    return html`<dl class="figures">
      ${figures.map(([name, value]) => html`<div><dt>${name}</dt><dd>${value}</dd></div>`)}
    </dl>`;
  }

  #legend(report: Report): TemplateResult {
    const shown = new Map(this.legend.map((entry) => [entry.role, entry]));
    const rows = Object.entries(report.by_role).filter(([, it]) => it.length_mm > 0);
    return html`<table class="legend">
      <caption>${en.figures.legend}</caption>
      <thead>
        <tr>
          <th scope="col">${en.figures.role}</th>
          <th scope="col">${en.figures.thisLayer}</th>
          <th scope="col">${en.figures.length}</th>
          <th scope="col">${en.figures.share}</th>
        </tr>
      </thead>
      <tbody>
        ${rows.map(([role, it]) => this.#row(role, shown.get(role), it))}
      </tbody>
    </table>`;
  }

  #row(role: string, shown: LegendEntry | undefined, { length_mm, time_s }: RoleUse): TemplateResult {
    const colour = this.#colours.get(role);
    return html`<tr>
      <th scope="row">
        <i class="swatch" style=${colour === undefined ? '' : `background:${colour}`} aria-hidden="true"></i>${words(role)}
      </th>
      <td>${shown === undefined ? '' : en.figures.metres(shown.length_mm)}</td>
      <td>${en.figures.metres(length_mm)}</td>
      <td>${en.figures.duration(time_s)}</td>
    </tr>`;
  }

  #remarks(remarks: readonly Remark[]): TemplateResult | typeof nothing {
    if (remarks.length === 0) return nothing;
    return html`<h3>${en.figures.warnings}</h3>
      <ul class="remarks">
        ${remarks.map((remark) => html`<li>${remark.message} ${this.#place(remark)}</li>`)}
      </ul>`;
  }

  #place({ layer }: Remark): TemplateResult | typeof nothing {
    if (layer === undefined || layer === null) return nothing;
    return html`<button type="button" class="link" @click=${() => this.tell('layer-change', layer)}>
      ${en.figures.showLayer(layer + 1)}
    </button>`;
  }
}

customElements.define('result-figures', ResultFigures);
