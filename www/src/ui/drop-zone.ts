// The model: opens a file by button or by dropping it anywhere on the page, and says what is open.
import { html, nothing, type TemplateResult } from 'lit';
import { t } from '../i18n/text.ts';
import type { ModelState } from '../state.ts';
import { Part } from './part.ts';
import { problemBox } from './problem-box.ts';

/** Sends `open-file` with a File. */
export class DropZone extends Part {
  static override properties = { model: { attribute: false }, starting: { type: Boolean }, over: { state: true } };
  declare model: ModelState;
  /** The engine is not there yet. */
  declare starting: boolean;
  declare over: boolean;

  constructor() {
    super();
    this.model = { kind: 'none' };
    this.starting = false;
    this.over = false;
  }

  override connectedCallback(): void {
    super.connectedCallback();
    window.addEventListener('dragover', this.#dragOver);
    window.addEventListener('dragleave', this.#dragLeave);
    window.addEventListener('drop', this.#drop);
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    window.removeEventListener('dragover', this.#dragOver);
    window.removeEventListener('dragleave', this.#dragLeave);
    window.removeEventListener('drop', this.#drop);
  }

  protected override render(): TemplateResult {
    return html`
      <section class="card" aria-labelledby="model-heading">
        <h2 id="model-heading">${t.model.heading}</h2>
        ${this.#facts()}
        <div class="row">
          <button type="button" class="button" @click=${this.#choose}>${t.model.open}</button>
          <span class="hint">${t.model.hint}</span>
        </div>
        <input type="file" accept=".stl,model/stl" hidden @change=${this.#chosen} />
      </section>
      ${this.over ? html`<div class="drop-cover" aria-hidden="true"><p>${t.model.drop}</p></div>` : nothing}
    `;
  }

  #facts(): TemplateResult | typeof nothing {
    switch (this.model.kind) {
      case 'none':
        return this.starting ? html`<p class="hint">${t.loading}</p>` : nothing;
      case 'reading':
        return html`<p class="model-name">${t.model.reading(this.model.source.name)}</p>`;
      case 'failed':
        return problemBox(this.model.problem);
      case 'open': {
        const { source, facts } = this.model;
        return html`
          <p class="model-name">${source.name}</p>
          <p class="facts">
            <span>${t.format.size(facts.size)}</span><span>${t.format.volume(facts.volume_mm3)}</span
            ><span>${t.model.triangles(facts.triangles)}</span>
          </p>
          ${facts.warnings.map(({ message }) => html`<p class="remark">${message}</p>`)}
        `;
      }
      default:
        return this.model satisfies never;
    }
  }

  #choose(): void {
    this.querySelector<HTMLInputElement>('input[type=file]')?.click();
  }

  #chosen(event: Event): void {
    const input = event.target as HTMLInputElement;
    this.#open(input.files?.[0]);
    input.value = '';
  }

  #open(file: File | undefined): void {
    if (file !== undefined) this.tell('open-file', file);
  }

  #dragOver = (event: DragEvent): void => {
    if (event.dataTransfer?.types.includes('Files') !== true) return;
    event.preventDefault();
    this.over = true;
  };

  #dragLeave = (event: DragEvent): void => {
    if (event.relatedTarget === null) this.over = false;
  };

  #drop = (event: DragEvent): void => {
    event.preventDefault();
    this.over = false;
    this.#open(event.dataTransfer?.files[0]);
  };
}

customElements.define('drop-zone', DropZone);
