// The job: print, how far it is, pause, cancel, speed and flow, and how it ended.
import { html, nothing, type TemplateResult } from 'lit';
import { t } from '../i18n/text.ts';
import { hasJob } from '../printer/link.ts';
import type { PrintFile } from '../printer/print-session.ts';
import { type JobEnd, type PrintJob, progressOf } from '../printer/print-state.ts';
import { PrintPart } from './print-part.ts';
import { pauseText, stopText } from './print-words.ts';

export class PrintJobPart extends PrintPart {
  static override properties = { ...PrintPart.properties, file: { attribute: false } };
  /** The sliced file, if there is one. */
  declare file: (() => PrintFile) | undefined;

  constructor() {
    super();
    this.file = undefined;
  }

  protected override render(): TemplateResult {
    const { job, printer, doubt } = this.print;
    const running = job !== undefined && hasJob(printer);
    return html`<section class="card" aria-label=${t.printing.job}>
      <h2>${t.printing.job}</h2>
      ${running ? this.#running(job) : doubt === undefined ? this.#idle() : this.#doubt(doubt.line + 1, doubt.word)}
      ${this.#end()}
    </section>`;
  }

  #idle(): TemplateResult {
    const ready = this.print.printer === 'ready';
    const can = ready && this.file !== undefined;
    return html`
      <div class="row buttons">
        <button
          type="button"
          class="button ${can ? 'primary' : ''}"
          aria-disabled=${!can}
          @click=${() => can && this.file && this.printing?.print(this.file())}
        >
          ${t.printing.print}
        </button>
        <button
          type="button"
          class="button"
          aria-disabled=${!ready}
          @click=${() => ready && this.querySelector<HTMLInputElement>('input[type=file]')?.click()}
        >
          ${t.printing.openFile}
        </button>
        <input type="file" accept=".gcode,.gco,.g,.nc" hidden @change=${this.#file} />
      </div>
      ${can ? nothing : html`<p class="hint">${ready ? t.printing.nothing : t.printing.connectFirst}</p>`}
    `;
  }

  #doubt(line: number, word: string): TemplateResult {
    return html`
      <p class="remark" role="alert">${t.printing.doubt(line, word)}</p>
      <div class="row buttons">
        <button type="button" class="button" @click=${() => this.printing?.dropDoubt()}>${t.printing.dont}</button>
        <button type="button" class="button" @click=${() => this.printing?.printAnyway()}>${t.printing.printAnyway}</button>
      </div>
    `;
  }

  #running({ name, outline, began }: PrintJob): TemplateResult {
    const { journal, paused, printer, resends } = this.print;
    const { share, left } = progressOf(outline, journal);
    const line = (journal?.acked_line ?? -1) + 1;
    const layers = outline.layers.length;
    return html`
      <p class="model-name">${name}</p>
      <progress aria-label=${t.printing.progress} max="1" .value=${share}></progress>
      <p class="facts">
        <span>${Math.floor(100 * share)} %</span>
        <span>${t.printing.line(t.format.number(line, 0), t.format.number(outline.lines, 0))}</span>
        ${layers === 0 ? nothing : html`<span>${t.printing.layer(journal?.layer ?? 0, layers)}</span>`}
        ${left === undefined ? nothing : html`<span>${t.printing.left(t.format.duration(left))}</span>`}
        <span>${t.printing.elapsed(t.format.duration((Date.now() - began) / 1000))}</span>
        ${resends === 0 ? nothing : html`<span>${t.printing.resends(resends)}</span>`}
      </p>
      ${paused === undefined ? nothing : html`<p class="remark" role="status">${pauseText(paused)}</p>`}
      <p class="unseen" role="status">${t.printing.percentDone(10 * Math.floor(10 * share))}</p>
      <div class="row buttons">${this.#pauseOrResume(printer)}
        <button
          type="button"
          class="button"
          aria-disabled=${printer === 'cancelling'}
          @click=${() => printer !== 'cancelling' && this.printing?.cancel()}
        >
          ${t.printing.cancel}
        </button>
      </div>
      ${this.#percent(t.printing.moveSpeed, this.print.speed, 300, (value) => this.printing?.setSpeed(value))}
      ${this.#percent(t.printing.flow, this.print.flow, 150, (value) => this.printing?.setFlow(value))}
    `;
  }

  /** One button, so that focus stays when it changes its meaning. */
  #pauseOrResume(printer: string): TemplateResult {
    const waits = printer === 'paused' || printer === 'parking';
    const can = waits || printer === 'printing' || printer === 'finishing' || printer === 'returning';
    return html`<button
      type="button"
      class="button ${waits ? 'primary' : ''}"
      aria-disabled=${!can}
      @click=${() => can && (waits ? this.printing?.resume() : this.printing?.pause())}
    >
      ${waits ? t.printing.resume : t.printing.pause}
    </button>`;
  }

  #percent(label: string, value: number, most: number, set: (value: number) => void): TemplateResult {
    return html`<label class="line">
      <span>${label}</span>
      <input
        type="range"
        min="10"
        max=${most}
        step="5"
        .value=${String(value)}
        aria-valuetext="${value} ${t.printing.percent}"
        @change=${(event: Event) => set(Number((event.target as HTMLInputElement).value))}
      />
      <span class="value">${value} %</span>
    </label>`;
  }

  #end(): TemplateResult | typeof nothing {
    const { end, job } = this.print;
    return end === undefined || job === undefined ? nothing : ended(end, job);
  }

  #file = (event: Event): void => {
    const input = event.target as HTMLInputElement;
    const file = input.files?.[0];
    input.value = '';
    if (file !== undefined) this.printing?.print({ name: file.name, text: file, result: undefined });
  };
}

function ended(end: JobEnd, { name, began }: PrintJob): TemplateResult {
  if (end.kind === 'stopped') return html`<p class="problem" role="alert">${stopText(end.reason)}</p>`;
  return html`<p role="status">
    ${t.printing.finished(name)} ${t.printing.elapsed(t.format.duration((end.at - began) / 1000))}.
  </p>`;
}

customElements.define('print-job', PrintJobPart);
