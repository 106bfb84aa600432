// The printer: connect it, what it is, and why it is not there.
import { html, nothing, type TemplateResult } from 'lit';
import { t } from '../i18n/text.ts';
import { hasJob } from '../printer/link.ts';
import { PrintPart } from './print-part.ts';
import { problemText } from './print-words.ts';

/** Speeds to choose from, baud. */
const SPEEDS = [250000, 115200, 1000000, 500000, 230400, 57600, 38400, 19200, 9600];

export class PrinterPort extends PrintPart {
  /** Undefined: find out. */
  #speed: number | undefined;

  protected override render(): TemplateResult {
    const { port, problem } = this.print;
    return html`<section class="card" aria-label=${t.printing.printer}>
      ${port.kind === 'open' ? this.#open(port.speed) : port.kind === 'trying' ? this.#trying(port.speed) : this.#closed()}
      ${
        problem === undefined
          ? nothing
          : html`<div class="problem" role="alert">
              <p>${problemText(problem)}</p>
              ${'message' in problem && problem.message !== '' ? html`<p class="advice">${problem.message}</p>` : nothing}
            </div>`
      }
    </section>`;
  }

  #closed(): TemplateResult {
    const known = this.print.firmware !== undefined;
    return html`
      <h2>${t.printing.printer}</h2>
      <div class="row buttons">
        <button type="button" class="button primary" @click=${() => this.#connect(false)}>
          ${known ? t.printing.reconnect : t.printing.connect}
        </button>
        ${
          known
            ? html`<button type="button" class="button" @click=${() => this.#connect(true)}>${t.printing.another}</button>`
            : nothing
        }
      </div>
      <label class="line">
        <span>${t.printing.speed}</span>
        <select @change=${this.#choose}>
          <option value="" ?selected=${this.#speed === undefined}>${t.printing.auto}</option>
          ${SPEEDS.map((it) => html`<option value=${it} ?selected=${this.#speed === it}>${it}</option>`)}
        </select>
      </label>
      ${known ? nothing : html`<p class="hint">${t.printing.hint}</p>`}
    `;
  }

  #trying(speed: number | undefined): TemplateResult {
    return html`
      <h2>${t.printing.printer}</h2>
      <p role="status">${speed === undefined ? t.printing.opening : t.printing.trying(speed)}</p>
      <div class="row buttons">
        <button type="button" class="button" @click=${() => this.printing?.disconnect()}>${t.printing.stopTrying}</button>
      </div>
    `;
  }

  #open(speed: number): TemplateResult {
    const { firmware, printer } = this.print;
    return html`
      <div class="printer-name">
        <h2>${t.printing.printer}</h2>
        <span class="badge state-${printer}">${t.printing.states[printer]}</span>
      </div>
      <p class="model-name">${firmware?.machine ?? t.printing.unnamed}</p>
      <p class="hint">${firmware?.name ?? ''} ${t.printing.at(speed)}</p>
      ${
        hasJob(printer)
          ? nothing
          : html`<div class="row buttons">
              <button type="button" class="button" @click=${() => this.printing?.disconnect()}>${t.printing.disconnect}</button>
            </div>`
      }
    `;
  }

  #choose = (event: Event): void => {
    const value = Number((event.target as HTMLSelectElement).value);
    this.#speed = value === 0 ? undefined : value;
  };

  #connect(anew: boolean): void {
    void this.printing?.connect(this.#speed, anew);
  }
}

customElements.define('printer-port', PrinterPort);
