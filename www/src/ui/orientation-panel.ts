// "Which way up?": directions with the supports that each would need, drawn, charted and compared.
import { html, nothing, svg, type TemplateResult } from 'lit';
import type { OrientationReport } from '../generated/report.ts';
import { t } from '../i18n/text.ts';
import type { Problem, State } from '../state.ts';
import { numberOf } from './asked.ts';
import { problemBox } from './problem-box.ts';
import { StepPart } from './step-part.ts';

type Candidate = OrientationReport['directions'][number];

/** Size of a candidate's picture, px. */
const PICTURE = { width: 104, height: 84 };

/** Pixels of a picture per CSS px. */
const SHARPNESS = 2;

/** The chart's plane: width, height and room for the axes, px. */
const CHART = { width: 320, height: 176, left: 40, bottom: 34, top: 20, right: 26 };

const axes = ['+z', '−z', '+x', '−x', '+y', '−y'];

type Stage =
  | { readonly kind: 'idle' }
  | { readonly kind: 'running'; readonly done: number; readonly total: number }
  | { readonly kind: 'failed'; readonly problem: Problem }
  | { readonly kind: 'compared'; readonly report: OrientationReport };

export class OrientationPanel extends StepPart {
  static override properties = { ...StepPart.properties, stage: { state: true }, looked: { state: true } };
  declare stage: Stage;
  /** The candidate whose figures are shown. */
  declare looked: number;
  #running: AbortController | undefined;
  /** The model that the stage is about. */
  #model = 0;
  readonly #drawn = new Set<string>();

  constructor() {
    super();
    this.stage = { kind: 'idle' };
    this.looked = 1;
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.#running?.abort();
  }

  protected override willUpdate(): void {
    const model = modelOf(this.state);
    if (model === this.#model) return;
    this.#model = model;
    this.#running?.abort();
    this.stage = { kind: 'idle' };
    this.#drawn.clear();
  }

  protected override updated(): void {
    if (this.stage.kind === 'compared') void this.#draw(this.stage.report);
  }

  protected override render(): TemplateResult | typeof nothing {
    if (this.state.model.kind !== 'open') return nothing;
    const words = t.panels.orientation;
    return html`<details class="card looked">
      <summary>${words.heading}</summary>
      ${this.#body()}
    </details>`;
  }

  #body(): TemplateResult {
    const { stage } = this;
    const words = t.panels.orientation;
    const find = html`<button type="button" class="button" @click=${() => void this.#find()}>
      ${stage.kind === 'compared' ? words.again : words.find}
    </button>`;
    switch (stage.kind) {
      case 'idle':
        return html`<p class="hint">${words.hint}</p>
          ${find}`;
      case 'running':
        return html`<progress aria-label=${words.progress} max=${stage.total} .value=${stage.done}></progress>
          <button type="button" class="button" @click=${() => this.#running?.abort()}>${t.panels.stop}</button>`;
      case 'failed':
        return html`${problemBox(stage.problem)} ${find}`;
      case 'compared':
        return html`${this.#strip(stage.report)} ${this.#figures(stage.report)} ${chart(stage.report, this.looked)}
        ${network(stage.report)} ${find}`;
      default:
        return stage satisfies never;
    }
  }

  #strip(report: OrientationReport): TemplateResult {
    const words = t.panels.orientation;
    const sorted = [...report.directions].sort((a, b) => a.total_mm3 - b.total_mm3 || a.id - b.id);
    return html`<div class="strip" role="radiogroup" aria-label=${words.heading}>
      ${sorted.map((it) => this.#candidate(it, report))}
    </div>`;
  }

  #candidate(it: Candidate, { chosen }: OrientationReport): TemplateResult {
    const words = t.panels.orientation;
    const name = words.candidate(it.id);
    return html`<label class="kind candidate ${it.id === this.looked ? 'chosen' : ''}" data-id=${it.id}>
      <input
        type="radio"
        name="candidate"
        .checked=${it.id === this.looked}
        aria-label=${name}
        aria-describedby="candidate-${it.id}"
        @change=${() => {
          this.looked = it.id;
        }}
      />
      <canvas width=${PICTURE.width * SHARPNESS} height=${PICTURE.height * SHARPNESS} role="img" aria-label=${name}></canvas>
      <span class="kind-figures" id="candidate-${it.id}">
        ${t.format.volume(it.support_mm3)}
        ${it.id === chosen ? html`<span class="badge best">${words.chosen}</span>` : nothing}
        ${it.pareto && it.id !== chosen ? html`<span class="badge" title=${words.bestHelp}>${words.best}</span>` : nothing}
      </span>
    </label>`;
  }

  #figures(report: OrientationReport): TemplateResult | typeof nothing {
    const it = report.directions.find(({ id }) => id === this.looked);
    if (it === undefined) return nothing;
    const { history } = this.state;
    const words = t.panels.orientation.figures;
    const { number } = t.format;
    const figures = [
      [words.support, t.format.volume(it.support_mm3)],
      [words.filament, t.format.metres(it.support_filament_mm)],
      [words.structures, number(it.structures, 0)],
      [words.contact, `${number(it.bed_contact_mm2 / 100, 2)} cm²`],
      [words.height, `${number(it.height_mm, 1)} mm`],
      [words.time, t.format.duration(it.time_surrogate_s)],
      [words.scars, `${number(it.scarred_mm2 / 100, 2)} cm²`],
    ];
    return html`<dl class="figures">
      ${figures.map(([name, value]) => html`<div><dt>${name}</dt><dd>${value}</dd></div>`)}
      </dl>
      <div class="row">
        <button type="button" class="button primary" @click=${() => void this.#turn(it.up)}>
          ${t.panels.orientation.pick}
        </button>
        <button
          type="button"
          class="button"
          ?disabled=${history.past.length === 0}
          @click=${() => this.session?.undo()}
        >
          ${t.panels.orientation.undo}
        </button>
      </div>`;
  }

  /** Turns every part of the first model this way up. */
  async #turn(up: readonly number[]): Promise<void> {
    for (const { id, model } of this.state.parts) {
      if (model === 0) await this.session?.change(id, { kind: 'turn_up', up });
    }
  }

  async #find(): Promise<void> {
    const { session } = this;
    if (session === undefined) return;
    const running = new AbortController();
    this.#running = running;
    this.stage = { kind: 'running', done: 0, total: 1 };
    const report = await session.orient(running.signal, (done, total) => {
      if (this.#running === running) this.stage = { kind: 'running', done, total };
    });
    if (this.#running !== running) return;
    this.#running = undefined;
    this.#drawn.clear();
    if (report === undefined) this.stage = { kind: 'idle' };
    else if ('name' in report) this.stage = { kind: 'failed', problem: report };
    else {
      this.looked = report.chosen;
      this.stage = { kind: 'compared', report };
    }
  }

  /** Asks for each candidate's picture once, in their order. */
  async #draw({ directions }: OrientationReport): Promise<void> {
    const model = this.#model;
    for (const { id, up } of directions) {
      const context = this.querySelector<HTMLCanvasElement>(`[data-id="${id}"] canvas`)?.getContext('2d');
      const key = `${model} ${id}`;
      if (!context || this.#drawn.has(key)) continue;
      this.#drawn.add(key);
      const { width, height } = context.canvas;
      const image = await this.session?.thumbnail(up, width, height).catch(() => undefined);
      if (image === undefined || model !== this.#model) return;
      context.putImageData(image, 0, 0);
    }
  }
}

function modelOf({ model }: State): number {
  return model.kind === 'open' ? numberOf(model) : 0;
}

/** Support volume against structures: few and little is best, down and left. */
function chart({ directions, chosen }: OrientationReport, looked: number): TemplateResult {
  const words = t.panels.orientation;
  const { width, height, left, right, top, bottom } = CHART;
  const most = Math.max(1e-3, ...directions.map((it) => it.support_mm3 / 1000));
  const many = Math.max(2, ...directions.map((it) => it.structures));
  const x = (mm3: number): number => left + ((width - left - right) * mm3) / 1000 / most;
  const y = (count: number): number => top + (height - top - bottom) * (1 - (count - 1) / (many - 1));
  const names = namesAt(directions, (it) => `${Math.round(x(it.support_mm3) / 8)} ${Math.round(y(it.structures) / 8)}`);
  const mark = (it: Candidate) => {
    const kinds = `${it.pareto ? 'pareto' : ''} ${it.id === chosen ? 'best' : ''} ${it.id === looked ? 'looked-at' : ''}`;
    const said = `${words.candidate(it.id)}: ${t.format.volume(it.support_mm3)}, ${it.structures} ${words.chartStructures}`;
    return svg`<g class="mark ${kinds}" role="img" aria-label=${said}>
      <circle cx=${x(it.support_mm3)} cy=${y(it.structures)} r=${it.id === looked ? 7 : 5} />
      ${names.has(it.id) ? svg`<text x=${x(it.support_mm3) + 8} y=${y(it.structures) - 6}>${names.get(it.id)}</text>` : nothing}
    </g>`;
  };
  return html`<svg class="chart" viewBox="0 0 ${width} ${height}" role="group" aria-label=${words.chart}>
    <path class="axis" d="M${left} ${top}V${height - bottom}H${width - right}" />
    <text x=${left} y=${height - bottom + 14}>0</text>
    <text x=${width - right} y=${height - bottom + 14} text-anchor="end">${t.format.number(most, 1)}</text>
    <text x=${(left + width - right) / 2} y=${height - 6} text-anchor="middle">${words.chartVolume}</text>
    <text x=${left - 6} y=${y(1) + 4} text-anchor="end">1</text>
    <text x=${left - 6} y=${y(many) + 4} text-anchor="end">${many}</text>
    <text x="12" y=${(top + height - bottom) / 2} text-anchor="middle" transform="rotate(-90 12 ${(top + height - bottom) / 2})">
      ${words.chartStructures}
    </text>
    ${directions.map(mark)}
  </svg>`;
}

/** The ids at each place of the chart, under the first of them: marks on one another have one label. */
function namesAt(directions: readonly Candidate[], place: (it: Candidate) => string): ReadonlyMap<number, string> {
  const found = new Map<string, number[]>();
  for (const it of directions) found.set(place(it), [...(found.get(place(it)) ?? []), it.id]);
  return new Map([...found.values()].map((ids) => [ids[0] ?? 0, ids.join(', ')]));
}

/** What the network says of the six axes beside the exact minima. */
function network({ o1, exact, directions }: OrientationReport): TemplateResult {
  const words = t.panels.orientation;
  const row = (name: string, ones: readonly number[]): TemplateResult => html`<tr>
    <th scope="row">${name}</th>
    ${ones.map((one) => html`<td class=${one === 1 ? 'yes' : ''}>${one === 1 ? words.yes : words.no}</td>`)}
  </tr>`;
  const agree = o1.every((one, k) => one === exact[k]);
  return html`<details class="all">
    <summary>${words.network}</summary>
    <div class="wide-table" tabindex="0" role="region" aria-label=${words.network}>
      <table class="figures-table">
        <thead>
          <tr>
            <td></td>
            ${axes.map((axis) => html`<th scope="col">${axis}</th>`)}
          </tr>
        </thead>
        <tbody>
          <tr>
            <th scope="row">mm³</th>
            ${directions.slice(0, 6).map((it) => html`<td>${t.format.number(it.total_mm3, 0)}</td>`)}
          </tr>
          ${row(words.networkSays, o1)} ${row(words.exactSays, exact)}
        </tbody>
      </table>
    </div>
    <p class="hint">${agree ? words.agree : words.differ}</p>
  </details>`;
}

customElements.define('orientation-panel', OrientationPanel);
