// How far the layer shown is printed, and playing it.
import { html, type TemplateResult } from 'lit';
import { t } from '../i18n/text.ts';
import { Part } from './part.ts';

/** A layer plays for so long, s, however many moves it has. */
const LAYER_SECONDS = 4;

/** Sends `moves-change` with a number of moves, `moves-end` when playing has come to the end of the layer. */
export class MoveSlider extends Part {
  static override properties = { moves: { type: Number }, total: { type: Number }, playing: { state: true } };
  declare moves: number;
  declare total: number;
  declare playing: boolean;

  #at = 0;
  #last = 0;

  constructor() {
    super();
    this.moves = 0;
    this.total = 0;
    this.playing = false;
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.playing = false;
  }

  protected override render(): TemplateResult {
    return html`<div class="move-slider">
      <button
        type="button"
        class="icon-button"
        aria-label=${this.playing ? t.view.stop : t.view.play}
        title=${this.playing ? t.view.stop : t.view.play}
        @click=${() => this.#toggle()}
      >
        <svg viewBox="0 0 16 16" width="14" height="14" aria-hidden="true" fill="currentColor">
          <path d=${this.playing ? 'M3 2h4v12H3zM9 2h4v12H9z' : 'M4 2l10 6-10 6z'} />
        </svg>
      </button>
      <input
        type="range"
        aria-label=${t.view.moves}
        aria-valuetext=${t.view.movesValue(this.moves, this.total)}
        min="0"
        max=${this.total}
        .value=${String(this.moves)}
        @input=${(event: Event) => this.#show(Number((event.target as HTMLInputElement).value))}
      />
    </div>`;
  }

  #show(moves: number): void {
    this.playing = false;
    this.tell('moves-change', moves);
  }

  #toggle(): void {
    this.playing = !this.playing;
    if (!this.playing) return;
    this.#at = this.moves >= this.total ? 0 : this.moves;
    this.#last = performance.now();
    requestAnimationFrame(this.#frame);
  }

  #frame = (now: number): void => {
    if (!this.playing) return;
    this.#at += ((now - this.#last) / 1000) * (this.total / LAYER_SECONDS);
    this.#last = now;
    if (this.#at >= this.total) {
      this.tell('moves-end');
      this.#at = 0;
    }
    this.tell('moves-change', Math.floor(this.#at));
    requestAnimationFrame(this.#frame);
  };
}

customElements.define('move-slider', MoveSlider);
