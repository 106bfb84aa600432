// What the print takes: time, filament, cost, and which colour stands for what.
import { html, nothing, type TemplateResult } from 'lit';
import { t } from '../i18n/text.ts';
import type { LegendEntry } from '../messages.ts';
import { words } from '../settings/fields.ts';
import type { Figures, Remark } from '../state.ts';
import type { RoleColour } from '../view/colours.ts';
import { Part } from './part.ts';

/** Roles that G-code names by one word, so that a layer read from it shows them in one colour. */
const sameWord = [
  ['bottom_skin', 'solid_infill'],
  ['skirt', 'brim', 'teeth'],
  ['raft', 'support'],
];

/** One colour of the picture: its roles in the print, and what they add up to. */
interface Row {
  readonly roles: readonly string[];
  readonly length_mm: number;
  readonly time_s: number;
}

/** Sends `layer-change` when a remark's layer is chosen, `fix`, `drop-parts` or `move-aside` for what mends it, `roles-change` with the roles to leave out. */
export class ResultFigures extends Part {
  static override properties = {
    report: { attribute: false },
    legend: { attribute: false },
    roles: { attribute: false },
    leftOut: { attribute: false },
    filtering: { attribute: false },
    fixing: { attribute: false },
    colours: { attribute: false },
  };
  declare report: Figures | undefined;
  declare legend: readonly LegendEntry[];
  /** Colours of all roles. */
  declare roles: readonly RoleColour[];
  /** Roles that the picture leaves out. */
  declare leftOut: ReadonlySet<string>;
  /** The picture can leave roles out. */
  declare filtering: boolean;
  /** Settings can be changed to what a remark proposes. */
  declare fixing: boolean;
  /** What stands above the colours: by what they are chosen. */
  declare colours: TemplateResult | typeof nothing;

  constructor() {
    super();
    this.report = undefined;
    this.legend = [];
    this.roles = [];
    this.leftOut = new Set();
    this.filtering = false;
    this.fixing = true;
    this.colours = nothing;
  }

  protected override render(): TemplateResult {
    const { report } = this;
    if (report === undefined) return this.#empty();
    return html`
      <section class="card" aria-labelledby="figures-heading">
        <h2 id="figures-heading">${t.figures.heading}</h2>
        ${this.#figures(report)} ${this.#remarks(report.warnings)}
      </section>
      <section class="card" aria-labelledby="colours-heading">
        <h2 id="colours-heading">${t.view.colourBy}</h2>
        ${this.colours} ${this.#legend(report)}
      </section>
    `;
  }

  #empty(): TemplateResult {
    return html`<section class="card" aria-labelledby="figures-heading">
      <h2 id="figures-heading">${t.figures.heading}</h2>
      <p class="hint">${t.figures.empty}</p>
    </section>`;
  }

  #figures(report: Figures): TemplateResult {
    const { filament, time_s, layers } = report;
    const figures = [
      [t.figures.time, t.format.duration(time_s)],
      [t.figures.layers, String(layers)],
      [t.figures.filament, t.format.metres(filament.length_mm)],
      [t.figures.mass, t.format.grams(filament.mass_g)],
      [t.figures.cost, t.format.money(filament.cost)],
    ];
    return html`<dl class="figures">
      ${figures.map(([name, value]) => html`<div><dt>${name}</dt><dd>${value}</dd></div>`)}
    </dl>`;
  }

  #legend(report: Figures): TemplateResult {
    return html`<table class="legend">
      <caption>${t.figures.legend}</caption>
      <thead>
        <tr>
          <th scope="col">${t.figures.role}</th>
          <th scope="col">${t.figures.thisLayer}</th>
          <th scope="col">${t.figures.length}</th>
          <th scope="col">${t.figures.share}</th>
        </tr>
      </thead>
      <tbody>
        ${rowsOf(report).map((row) => this.#row(row))} ${this.filtering ? this.#travels() : nothing}
      </tbody>
    </table>`;
  }

  #row({ roles, length_mm, time_s }: Row): TemplateResult {
    const drawn = sameWord.find((group) => group.includes(roles[0] ?? '')) ?? roles;
    const colour = this.roles.find(({ role }) => role === drawn[0])?.color;
    const here = this.legend.filter(({ role }) => drawn.includes(role)).reduce((sum, it) => sum + it.length_mm, 0);
    return html`<tr>
      <th scope="row">
        ${this.#name(labelOf(roles), colour, drawn)}
      </th>
      <td>${here === 0 ? '' : t.format.metres(here)}</td>
      <td>${t.format.metres(length_mm)}</td>
      <td>${t.format.duration(time_s)}</td>
    </tr>`;
  }

  /** A role's name with its colour; as a switch where the picture can leave it out. */
  #name(label: string, colour: string | undefined, roles: readonly string[]): TemplateResult {
    const swatch = html`<i class="swatch" .style=${colour === undefined ? '' : `background:${colour}`} aria-hidden="true"></i>`;
    if (!this.filtering) return html`${swatch}${label}`;
    const shown = !roles.some((role) => this.leftOut.has(role));
    return html`<label class="role"
      ><input
        type="checkbox"
        class="unseen"
        aria-label=${t.view.shown(label)}
        .checked=${shown}
        @change=${() => this.#toggle(roles, shown)}
      />${swatch}<span class=${shown ? '' : 'off'}>${label}</span></label
    >`;
  }

  #travels(): TemplateResult {
    return html`<tr>
      <th scope="row">${this.#name(t.view.travels, '#5b8fd9', ['travel'])}</th>
      <td></td>
      <td></td>
      <td></td>
    </tr>`;
  }

  #toggle(roles: readonly string[], hide: boolean): void {
    const hidden = new Set(this.leftOut);
    for (const role of roles) {
      if (hide) hidden.add(role);
      else hidden.delete(role);
    }
    this.tell<ReadonlySet<string>>('roles-change', hidden);
  }

  #remarks(remarks: readonly Remark[]): TemplateResult | typeof nothing {
    if (remarks.length === 0) return nothing;
    return html`<h3>${t.figures.warnings}</h3>
      <ul class="remarks">
        ${remarks.map((remark) => html`<li>${remark.message} ${this.#place(remark)} ${this.#fix(remark)}</li>`)}
      </ul>`;
  }

  #place({ layer }: Remark): TemplateResult | typeof nothing {
    if (layer === undefined || layer === null) return nothing;
    return html`<button type="button" class="link" @click=${() => this.tell('layer-change', layer)}>
      ${t.figures.showLayer(layer + 1)}
    </button>`;
  }

  /** What would mend it, at one press. */
  #fix({ code, fix = [] }: Remark): TemplateResult | typeof nothing {
    const link = (label: string, event: string): TemplateResult =>
      html`<button type="button" class="link" @click=${() => this.tell(event)}>${label}</button>`;
    if (!this.fixing) return nothing;
    if (code === 'not_on_bed') return link(t.mend.drop, 'drop-parts');
    if (code === 'forbidden_zone') return link(t.mend.aside, 'move-aside');
    if (fix.length === 0) return nothing;
    return html`<button type="button" class="link" @click=${() => this.tell<readonly string[]>('fix', fix)}>
      ${t.figures.fix(fix.join(', '))}
    </button>`;
  }
}

/** The report's roles with those of one colour together, in the report's order. */
function rowsOf(report: Figures): readonly Row[] {
  const rows = new Map<unknown, Row>();
  for (const [role, { length_mm, time_s }] of Object.entries(report.by_role)) {
    if (length_mm === 0) continue;
    const key = sameWord.find((group) => group.includes(role)) ?? role;
    const before = rows.get(key) ?? { roles: [], length_mm: 0, time_s: 0 };
    rows.set(key, {
      roles: [...before.roles, role],
      length_mm: before.length_mm + length_mm,
      time_s: before.time_s + time_s,
    });
  }
  return [...rows.values()];
}

/** "Bottom skin, Solid infill" */
function labelOf(roles: readonly string[]): string {
  const names: Readonly<Record<string, string>> = t.roles;
  return roles.map((role) => names[role] ?? words(role)).join(', ');
}

customElements.define('result-figures', ResultFigures);
