// Which layer is shown.
import { html, type TemplateResult } from 'lit';
import { t } from '../i18n/text.ts';
import { Part } from './part.ts';

/** Sends `layer-change` with the layer's index, from 0. */
export class LayerSlider extends Part {
  static override properties = { layer: { type: Number }, total: { type: Number }, height: { type: String } };
  declare layer: number;
  declare total: number;
  /** Of the layer shown, in mm, as the G-code says it; empty when it says nothing. */
  declare height: string;

  constructor() {
    super();
    this.layer = 0;
    this.total = 0;
    this.height = '';
  }

  protected override render(): TemplateResult {
    const shown = this.layer + 1;
    return html`
      <div class="slider">
        <button type="button" class="icon-button" aria-label=${t.view.next} @click=${() => this.#go(this.layer + 1)}>
          <span class="up" aria-hidden="true"></span>
        </button>
        <input
          type="range"
          aria-label=${t.view.layer}
          aria-valuetext=${t.view.layerValue(shown, this.total, this.height)}
          min="1"
          max=${this.total}
          .value=${String(shown)}
          @input=${(event: Event) => this.#go(Number((event.target as HTMLInputElement).value) - 1)}
        />
        <button type="button" class="icon-button" aria-label=${t.view.previous} @click=${() => this.#go(this.layer - 1)}>
          <span class="down" aria-hidden="true"></span>
        </button>
        <p class="slider-value" aria-hidden="true">
          <b>${shown}</b><span> / ${this.total}</span>${this.height === '' ? '' : html`<br />${this.height} mm`}
        </p>
      </div>
    `;
  }

  #go(layer: number): void {
    this.tell('layer-change', Math.min(Math.max(layer, 0), this.total - 1));
  }
}

customElements.define('layer-slider', LayerSlider);
