// Supports from the side: a plane through the part that a slider moves, as [Zhao]'s method sees it.
import { html, nothing, type TemplateResult } from 'lit';
import { t } from '../i18n/text.ts';
import { extentOf } from '../parts.ts';
import type { PlaneStudy } from '../studies.ts';
import { Asked, numberOf } from './asked.ts';
import { drawing } from './drawing.ts';
import { problemBox } from './problem-box.ts';
import { StepPart } from './step-part.ts';

/** Length of the picture, px: the width of the panel. */
const SIDE = 340;

export class PlanePanel extends StepPart {
  static override properties = {
    ...StepPart.properties,
    open: { state: true },
    axis: { state: true },
    share: { state: true },
  };
  declare open: boolean;
  declare axis: 'x' | 'y';
  /** Where the plane stands between the part's two ends, 0 to 1. */
  declare share: number;
  readonly #asked = new Asked<PlaneStudy>(this);

  constructor() {
    super();
    this.open = false;
    this.axis = 'y';
    this.share = 0.5;
  }

  protected override willUpdate(): void {
    const { model, parts, changes, dark } = this.state;
    const { session, open } = this;
    if (session === undefined) return;
    const plane = this.#plane();
    const key =
      open && model.kind === 'open'
        ? `${numberOf(model)} ${numberOf(parts)} ${plane} ${dark} ${JSON.stringify(changes)}`
        : undefined;
    this.#asked.want(key, () => session.study<PlaneStudy>({ about: 'plane', plane, side: SIDE, dark }));
  }

  protected override render(): TemplateResult | typeof nothing {
    if (this.state.model.kind !== 'open') return nothing;
    return html`<details
      class="card looked"
      .open=${this.open}
      @toggle=${({ currentTarget }: Event) => {
        this.open = (currentTarget as HTMLDetailsElement).open;
      }}
    >
      <summary>${t.panels.plane.heading}</summary>
      ${this.open ? this.#body() : nothing}
    </details>`;
  }

  #body(): TemplateResult {
    const words = t.panels.plane;
    const at = t.format.number(this.#at(), 1);
    return html`
      <div class="row">
        <div class="choice" role="group" aria-label=${words.axis}>
          ${(['x', 'y'] as const).map(
            (axis) => html`<button type="button" aria-pressed=${axis === this.axis} @click=${() => this.#turn(axis)}>
              ${axis}
            </button>`,
          )}
        </div>
        <input
          type="range"
          class="grow"
          min="0.5"
          max="99.5"
          step="0.5"
          aria-label=${words.place}
          aria-valuetext="${this.axis} = ${at} mm"
          .value=${String(100 * this.share)}
          @input=${({ target }: Event) => this.#move(target)}
        />
        <output>${this.axis} = ${at}</output>
      </div>
      ${this.#picture()}
    `;
  }

  #picture(): TemplateResult {
    const words = t.panels.plane;
    const { answer, problem } = this.#asked;
    if (problem?.name === 'UsageError') return html`<p class="hint">${words.beside}</p>`;
    if (problem !== undefined) return problemBox(problem);
    if (answer === undefined) return html`<p class="hint">${t.panels.waiting}</p>`;
    const area = t.format.number(answer.area_mm2, 1);
    const zero = t.format.number(answer.at_zero_mm2, 1);
    return html`
      ${drawing(answer.svg, words.picture(this.#plane()))}
      <p class="hint" data-area=${answer.area_mm2}>${words.figures(area, zero)}</p>
      <ul class="inks">
        <li class="ink-hanging">${words.legend.hanging}</li>
        <li class="ink-held">${words.legend.held}</li>
        <li class="ink-zero">${words.legend.zero}</li>
        <li class="ink-s">${words.legend.s}</li>
        <li class="ink-io">${words.legend.io}</li>
        <li class="ink-g">${words.legend.g}</li>
      </ul>
    `;
  }

  #turn(axis: 'x' | 'y'): void {
    this.axis = axis;
  }

  #move(target: EventTarget | null): void {
    if (target instanceof HTMLInputElement) this.share = Number(target.value) / 100;
  }

  #plane(): string {
    return `${this.axis}=${this.#at().toFixed(2)}`;
  }

  #at(): number {
    const box = extentOf(this.state.parts) ?? [0, 0, 0, 1, 1, 1];
    const side = this.axis === 'x' ? 0 : 1;
    const [low = 0, high = 1] = [box[side], box[side + 3]];
    return low + this.share * (high - low);
  }
}

customElements.define('plane-panel', PlanePanel);
