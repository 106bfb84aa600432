// What the printer and the user said to each other; arrow up and down bring earlier commands back.
import { html, nothing, type TemplateResult } from 'lit';
import { t } from '../i18n/text.ts';
import type { LogLine } from '../printer/print-state.ts';
import { PrintPart } from './print-part.ts';

export class PrinterConsole extends PrintPart {
  #history: string[] = [];
  /** How far back in the history, from its end. */
  #back = 0;
  #atEnd = true;

  protected override render(): TemplateResult {
    const { log, logAll, port } = this.print;
    const words = t.printing.console;
    return html`<section class="card" aria-label=${words.heading}>
      <h2>${words.heading}</h2>
      <div class="log" role="log" aria-live="off" aria-label=${words.lines} tabindex="0" @scroll=${this.#scrolled}>
        ${log.length === 0 ? html`<p class="hint">${words.empty}</p>` : log.map(lineOf)}
      </div>
      <form class="row" @submit=${this.#submit}>
        <input
          type="text"
          name="command"
          aria-label=${words.command}
          autocomplete="off"
          autocapitalize="characters"
          spellcheck="false"
          placeholder="M115"
          @keydown=${this.#key}
        />
        <button type="submit" class="button" aria-disabled=${port.kind !== 'open'}>${words.send}</button>
      </form>
      <label class="check">
        <input
          type="checkbox"
          .checked=${logAll}
          @change=${(event: Event) => this.printing?.logAll((event.target as HTMLInputElement).checked)}
        />
        ${words.all}
      </label>
    </section>`;
  }

  /** The end stays in sight, unless the user has scrolled back. */
  protected override updated(): void {
    const log = this.querySelector('.log');
    if (log !== null && this.#atEnd) log.scrollTop = log.scrollHeight;
  }

  #scrolled = ({ target }: Event): void => {
    const log = target as HTMLElement;
    this.#atEnd = log.scrollTop + log.clientHeight >= log.scrollHeight - 4;
  };

  #submit = (event: SubmitEvent): void => {
    event.preventDefault();
    const input = this.#input();
    const line = input?.value.trim() ?? '';
    if (input === null || line === '' || this.print.port.kind !== 'open') return;
    this.#history = [...this.#history.filter((it) => it !== line), line].slice(-50);
    this.#back = 0;
    this.#atEnd = true;
    input.value = '';
    this.printing?.send([line]);
  };

  #key = (event: KeyboardEvent): void => {
    const step = { ArrowUp: 1, ArrowDown: -1 }[event.key];
    const input = this.#input();
    if (step === undefined || input === null) return;
    event.preventDefault();
    this.#back = Math.min(Math.max(this.#back + step, 0), this.#history.length);
    input.value = this.#back === 0 ? '' : (this.#history.at(-this.#back) ?? '');
  };

  #input(): HTMLInputElement | null {
    return this.querySelector('input[name=command]');
  }
}

function lineOf({ from, text }: LogLine): TemplateResult {
  const sign = { user: '›', sent: '>', received: '<', printer: '', warning: '!' }[from];
  const who = {
    user: t.printing.console.you,
    warning: t.printing.console.warning,
    sent: '',
    received: '',
    printer: '',
  };
  return html`<p class="from-${from}">
    ${who[from] === '' ? nothing : html`<span class="unseen">${who[from]}: </span>`}
    <span aria-hidden="true">${sign}</span> ${text}
  </p>`;
}

customElements.define('printer-console', PrinterConsole);
