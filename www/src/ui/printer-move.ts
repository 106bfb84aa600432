// Moves the head by hand, and home.
import { html, type TemplateResult } from 'lit';
import { t } from '../i18n/text.ts';
import { hasJob } from '../printer/link.ts';
import { PrintPart } from './print-part.ts';

const STEPS = [0.1, 1, 10, 50];

/** Buttons of the pad: axis, direction, sign on it. */
const PAD = [
  ['Y', 1, '↑', 'back'],
  ['X', -1, '←', 'left'],
  ['X', 1, '→', 'right'],
  ['Y', -1, '↓', 'front'],
  ['Z', 1, 'Z+', 'up'],
  ['Z', -1, 'Z−', 'down'],
] as const;

/** Speeds by hand, mm/min. */
const SPEED = { X: 3000, Y: 3000, Z: 600 };

export class PrinterMove extends PrintPart {
  #step = 10;

  protected override render(): TemplateResult {
    const { printer } = this.print;
    const words = t.printing.move;
    return html`<section class="card" aria-label=${words.heading}>
      <h2>${words.heading}</h2>
      ${hasJob(printer) ? html`<p class="hint">${words.busy}</p>` : this.#controls(printer === 'ready')}
    </section>`;
  }

  #controls(ready: boolean): TemplateResult {
    const words = t.printing.move;
    return html`
      <div class="choice" role="group" aria-label=${words.step}>
        ${STEPS.map(
          (step) => html`<button type="button" aria-pressed=${step === this.#step} @click=${() => this.#choose(step)}>
            ${t.format.number(step, 1)}
          </button>`,
        )}
      </div>
      <div class="pad">
        ${PAD.map(
          ([axis, sign, text, place]) => html`<button
            type="button"
            class="icon-button ${place}"
            aria-label=${words.jog(axis, t.format.number(sign * this.#step, 1))}
            aria-disabled=${!ready}
            @click=${() => this.#send(ready, ['G91', `G1 ${axis}${sign * this.#step} F${SPEED[axis]}`, 'G90'])}
          >
            <span aria-hidden="true">${text}</span>
          </button>`,
        )}
      </div>
      <div class="row buttons">
        <button type="button" class="button" aria-disabled=${!ready} @click=${() => this.#send(ready, ['G28'])}>
          ${words.home}
        </button>
        <button type="button" class="button" aria-disabled=${!ready} @click=${() => this.#send(ready, ['G28 X Y'])}>
          ${words.homeXY}
        </button>
      </div>
    `;
  }

  #choose(step: number): void {
    this.#step = step;
    this.requestUpdate();
  }

  #send(ready: boolean, lines: readonly string[]): void {
    if (ready) this.printing?.send(lines);
  }
}

customElements.define('printer-move', PrinterMove);
