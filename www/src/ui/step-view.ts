// The view that the steps share: the parts in space, the beads in space, or one layer flat, with their sliders.
import { html, nothing, type TemplateResult } from 'lit';
import { t } from '../i18n/text.ts';
import type { Bounds, Edit, LegendEntry, PictureView } from '../messages.ts';
import { asStanding } from '../parts.ts';
import { roomOf } from '../settings/room.ts';
import { heightOf, layerOf } from '../slicer/gcode.ts';
import type { Result, Step } from '../state.ts';
import type { Sheet } from '../studies.ts';
import type { LayerText, Painter } from '../view/painter.ts';
import { type Marker, markersOf } from '../view/space-view.ts';
import { canDrawSpace } from '../view/webgl.ts';
import '../view/layer-view.ts';
import { Asked, numberOf } from './asked.ts';
import './layer-slider.ts';
import './move-slider.ts';
import { StepPart } from './step-part.ts';

const NO_SHEETS: readonly Sheet[] = [];

const sides: readonly PictureView[] = ['iso', 'top', 'front'];

/** What each step shows. */
const shows: Readonly<Record<Step, 'model' | 'layers'>> = {
  prepare: 'model',
  preview: 'layers',
  print: 'layers',
  learn: 'layers',
};

export class StepView extends StepPart {
  static override properties = {
    ...StepPart.properties,
    painter: { attribute: false },
    space: { state: true },
    layerMoves: { state: true },
    moves: { state: true },
    measuring: { state: true },
    measured: { state: true },
  };
  declare painter: Painter | undefined;
  /** The browser draws in space. */
  declare space: boolean;
  /** Moves in each layer, once they are read. */
  declare layerMoves: readonly number[];
  /** Moves of the layer that are shown. */
  declare moves: number;
  declare measuring: boolean;
  declare measured: number | undefined;

  /** The layer shown and what it was made of; kept while neither changes. */
  #shown: (LayerText & { readonly result: Result; readonly layer: number; readonly height: string }) | undefined;
  #markers: readonly Marker[] = [];
  readonly #sheets = new Asked<readonly Sheet[]>(this);

  constructor() {
    super();
    this.painter = undefined;
    this.space = canDrawSpace();
    this.layerMoves = [];
    this.moves = Number.POSITIVE_INFINITY;
    this.measuring = false;
    this.measured = undefined;
  }

  protected override willUpdate(): void {
    this.#askSheets();
    const { result, layer } = this.state;
    if (result === this.#shown?.result && layer === this.#shown?.layer) return;
    if (result !== this.#shown?.result) this.#markers = result === undefined ? [] : placesOf(result);
    const text = result === undefined ? new Uint8Array() : layerOf(result.gcode, layer);
    const marks = layer === 0 && result !== undefined ? result.gcode.joined.marks : new Uint8Array();
    this.#shown = result && { result, layer, text, marks, settings: result.settings, height: heightOf(text) };
    this.moves = Number.POSITIVE_INFINITY;
  }

  /** Plates are shown while parts are prepared, where supports are made of them. */
  #askSheets(): void {
    const { model, parts, changes, step } = this.state;
    const { session } = this;
    if (session === undefined || step !== 'prepare') return;
    const shown = model.kind === 'open' && changes['support.method'] === 'plates';
    const key = shown ? `${numberOf(parts)} ${JSON.stringify(changes)}` : undefined;
    this.#sheets.want(key, () => session.study<readonly Sheet[]>({ about: 'sheets' }));
  }

  protected override render(): TemplateResult {
    const show = shows[this.state.step];
    const flat = !this.space || (show === 'layers' && this.state.flat);
    return html`<section class="view" aria-label=${t.view.heading}>
      <div class="pictures">
        ${this.space ? this.#inSpace(show, flat) : nothing} ${this.#onCanvas(show, flat)}
        <div class="over-view">
          ${show === 'model' || !flat ? this.#sides() : nothing} ${show === 'layers' ? this.#kinds(flat) : nothing}
          ${flat ? nothing : this.#measure()} ${show === 'layers' && flat ? this.#marks() : nothing}
        </div>
        ${show === 'layers' && !flat ? this.#moves() : nothing}
      </div>
      ${show === 'layers' ? this.#slider() : nothing}
    </section>`;
  }

  #inSpace(show: 'model' | 'layers', flat: boolean): TemplateResult {
    const { model, parts, selected, changes, dark, result, layer, colourBy, hidden, side, laying } = this.state;
    return html`<space-view
      ?hidden=${flat}
      .painter=${this.painter}
      .show=${show === 'model' ? 'parts' : 'beads'}
      .side=${side}
      .model=${model}
      .parts=${parts}
      .sheets=${this.#sheets.answer ?? NO_SHEETS}
      .selected=${selected}
      .room=${roomOf(changes)}
      .dark=${dark}
      .result=${result}
      .layer=${layer}
      .moves=${this.moves}
      .colourBy=${colourBy}
      .leftOut=${hidden}
      .roles=${this.state.roles}
      .tool=${this.measuring ? 'measure' : laying ? 'flat' : 'select'}
      .markers=${this.#markers}
      .label=${this.#label()}
      @select=${({ detail }: CustomEvent<number | null>) => this.session?.select(detail ?? undefined)}
      @move-part=${({ detail }: CustomEvent<{ id: number; x: number; y: number }>) =>
        void this.session?.moveTo(detail.id, detail.x, detail.y)}
      @remove-part=${() => selected !== undefined && void this.session?.remove(selected)}
      @face=${({ detail: { id, triangle } }: CustomEvent<{ id: number; triangle: number }>) =>
        this.#layFlat(id, { kind: 'lay_flat', triangle })}
      @measured=${({ detail }: CustomEvent<number | null>) => {
        this.measured = detail ?? undefined;
      }}
      @layer-moves=${({ detail }: CustomEvent<number[]>) => {
        this.layerMoves = detail;
      }}
      @range=${({ detail }: CustomEvent<readonly [number, number] | null>) => this.store?.update({ range: detail ?? undefined })}
      @layer-step=${({ detail }: CustomEvent<number>) => this.session?.showLayer(layer + detail)}
      @no-space=${() => {
        this.space = false;
      }}
    ></space-view>`;
  }

  #layFlat(id: number, edit: Edit): void {
    this.store?.update({ laying: false });
    void this.session?.change(id, edit);
  }

  #onCanvas(show: 'model' | 'layers', flat: boolean): TemplateResult {
    const { side, result, layer, model, dark, parts, arranged } = this.state;
    return html`<layer-view
      ?hidden=${!flat}
      .painter=${this.painter}
      .show=${show}
      .side=${side}
      .dark=${dark}
      .model=${model.kind === 'open' && !this.space ? parts : undefined}
      .standing=${asStanding(parts, arranged && parts.length === 1)}
      .job=${result}
      .extent=${result && extentOf(result)}
      .layer=${this.#shown}
      .label=${this.#label()}
      @legend=${({ detail }: CustomEvent<readonly LegendEntry[]>) => this.store?.update({ legend: detail })}
      @layer-step=${({ detail }: CustomEvent<number>) => this.session?.showLayer(layer + detail)}
    ></layer-view>`;
  }

  #sides(): TemplateResult {
    return html`<div class="choice" role="group" aria-label=${t.view.side}>
      ${sides.map((it) => choice(t.view.sides[it], it === this.state.side, () => this.store?.update({ side: it })))}
    </div>`;
  }

  #kinds(flat: boolean): TemplateResult | typeof nothing {
    if (!this.space) return nothing;
    return html`<div class="choice" role="group" aria-label=${t.view.kind}>
      ${choice(t.view.inSpace, !flat, () => this.store?.update({ flat: false }))}
      ${choice(t.view.flat, flat, () => this.store?.update({ flat: true }))}
    </div>`;
  }

  /** What the marks over the beads mean, where teeth have some. */
  #marks(): TemplateResult | typeof nothing {
    if (this.#shown === undefined || this.#shown.marks.length === 0) return nothing;
    const { marks, marksHeading } = t.view;
    return html`<ul class="inks bubble" aria-label=${marksHeading}>
      <li class="ink-outline">${marks.outline}</li>
      <li class="ink-rail">${marks.rail}</li>
      <li class="ink-tip">${marks.tip}</li>
      <li class="ink-bite">${marks.bite}</li>
    </ul>`;
  }

  #measure(): TemplateResult {
    const told = this.measured === undefined ? t.view.measureHow : t.view.distance(this.measured);
    return html`<div class="choice">
        ${choice(t.view.measure, this.measuring, () => {
          this.measuring = !this.measuring;
          this.measured = undefined;
        })}
      </div>
      ${this.measuring ? html`<output class="bubble">${told}</output>` : nothing}`;
  }

  #slider(): TemplateResult | typeof nothing {
    const { result, layer } = this.state;
    if (result === undefined) return nothing;
    return html`<layer-slider
      .layer=${layer}
      .total=${result.gcode.layers.length}
      .height=${this.#shown?.height ?? ''}
      @layer-change=${({ detail }: CustomEvent<number>) => this.session?.showLayer(detail)}
    ></layer-slider>`;
  }

  #moves(): TemplateResult | typeof nothing {
    const { result, layer } = this.state;
    const total = this.layerMoves[layer];
    if (result === undefined || total === undefined) return nothing;
    return html`<move-slider
      .moves=${Math.min(this.moves, total)}
      .total=${total}
      @moves-change=${({ detail }: CustomEvent<number>) => {
        this.moves = detail;
      }}
      @moves-end=${() => layer + 1 < result.gcode.layers.length && this.session?.showLayer(layer + 1)}
    ></move-slider>`;
  }

  #label(): string {
    const { result, layer, model, step } = this.state;
    if (shows[step] === 'layers') return t.view.layerPicture(layer + 1, result?.gcode.layers.length ?? 0);
    return model.kind === 'open'
      ? t.view.modelPicture(model.models.map(({ source }) => source.name).join(', '))
      : t.view.heading;
  }
}

/** Room around the model for what is printed beside it, mm. */
const MARGIN = 6;

/** What the layers of a result cover on the bed. */
function extentOf({ report }: Result): Bounds {
  const [min, max] = report.model.bounds;
  return [min[0] - MARGIN, min[1] - MARGIN, max[0] + MARGIN, max[1] + MARGIN];
}

/** Where the remarks of a result are. */
function placesOf({ report, gcode }: Result): Marker[] {
  const height = (layer: number): number => Number(heightOf(gcode.layers[layer] ?? new Uint8Array()));
  return markersOf(report.warnings, height);
}

function choice(label: string, chosen: boolean, choose: () => void): TemplateResult {
  return html`<button type="button" aria-pressed=${chosen} @click=${choose}>${label}</button>`;
}

customElements.define('step-view', StepView);
