// The view that the steps share: the model on the bed, or the layers with their slider.
import { html, nothing, type TemplateResult } from 'lit';
import { t } from '../i18n/text.ts';
import type { Bounds, LegendEntry, PictureView } from '../messages.ts';
import { heightOf, layerOf } from '../slicer/gcode.ts';
import type { Result, Step } from '../state.ts';
import type { LayerText, Painter } from '../view/painter.ts';
import '../view/layer-view.ts';
import './layer-slider.ts';
import { StepPart } from './step-part.ts';

const sides: readonly PictureView[] = ['iso', 'top', 'front'];

/** What each step shows. */
const shows: Readonly<Record<Step, 'model' | 'layers'>> = {
  prepare: 'model',
  preview: 'layers',
  print: 'layers',
  learn: 'layers',
};

export class StepView extends StepPart {
  static override properties = { ...StepPart.properties, painter: { attribute: false } };
  declare painter: Painter | undefined;

  /** The layer shown and what it was made of; kept while neither changes. */
  #shown: (LayerText & { readonly result: Result; readonly layer: number; readonly height: string }) | undefined;

  constructor() {
    super();
    this.painter = undefined;
  }

  protected override willUpdate(): void {
    const { result, layer } = this.state;
    if (result === this.#shown?.result && layer === this.#shown?.layer) return;
    const text = result === undefined ? new Uint8Array() : layerOf(result.gcode, layer);
    this.#shown = result && { result, layer, text, settings: result.settings, height: heightOf(text) };
  }

  protected override render(): TemplateResult {
    const { side, result, layer, model, step, dark } = this.state;
    const show = shows[step];
    return html`<section class="view" aria-label=${t.view.heading}>
      <layer-view
        .painter=${this.painter}
        .show=${show}
        .side=${side}
        .dark=${dark}
        .model=${model.kind === 'open' ? model : undefined}
        .job=${result}
        .extent=${result && extentOf(result)}
        .layer=${this.#shown}
        .label=${this.#label()}
        @legend=${({ detail }: CustomEvent<readonly LegendEntry[]>) => this.store?.update({ legend: detail })}
        @layer-step=${({ detail }: CustomEvent<number>) => this.session?.showLayer(layer + detail)}
      ></layer-view>
      ${show === 'model' ? this.#sides() : this.#slider()}
    </section>`;
  }

  #sides(): TemplateResult {
    return html`<div class="choice over-view" role="group" aria-label=${t.view.side}>
      ${sides.map(
        (it) => html`<button
          type="button"
          aria-pressed=${it === this.state.side}
          @click=${() => this.store?.update({ side: it })}
        >
          ${t.view.sides[it]}
        </button>`,
      )}
    </div>`;
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

  #label(): string {
    const { result, layer, model, step } = this.state;
    if (shows[step] === 'layers') return t.view.layerPicture(layer + 1, result?.gcode.layers.length ?? 0);
    return model.kind === 'open' ? t.view.modelPicture(model.source.name) : t.view.heading;
  }
}

/** Room around the model for what is printed beside it, mm. */
const MARGIN = 6;

/** What the layers of a result cover on the bed. */
function extentOf({ report }: Result): Bounds {
  const [min, max] = report.model.bounds;
  return [min[0] - MARGIN, min[1] - MARGIN, max[0] + MARGIN, max[1] + MARGIN];
}

customElements.define('step-view', StepView);
