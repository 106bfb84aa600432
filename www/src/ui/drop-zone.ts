// The model: opens a file by button or by dropping it anywhere on the page, and says what is open.
import { html, nothing, type TemplateResult } from 'lit';
import { t } from '../i18n/text.ts';
import type { ModelState } from '../state.ts';
import { Part } from './part.ts';
import { problemBox } from './problem-box.ts';
import { surroundings } from './surroundings.ts';

/** Remarks that guess another unit than mm, and how many mm it has. */
const unitFactors: Readonly<Record<string, number>> = { unit_inch: 25.4, unit_metre: 1000 };

/** A model that shall be so many times as large. */
export interface ScaleModel {
  readonly model: number;
  readonly factor: number;
}

/** Sends `open-files` and `add-files` with a list of Files, `scale-model` with a ScaleModel. */
export class DropZone extends Part {
  static override properties = {
    model: { attribute: false },
    starting: { type: Boolean },
    fixed: { type: Boolean },
    over: { state: true },
  };
  declare model: ModelState;
  /** The engine is not there yet. */
  declare starting: boolean;
  /** Others choose the model. */
  declare fixed: boolean;
  declare over: boolean;
  #how: 'open' | 'add' = 'open';
  #deaf: AbortController | undefined;

  constructor() {
    super();
    this.model = { kind: 'none' };
    this.starting = false;
    this.fixed = false;
    this.over = false;
  }

  override connectedCallback(): void {
    super.connectedCallback();
    this.#deaf = new AbortController();
    const { signal } = this.#deaf;
    const place = surroundings(this);
    place.addEventListener('dragover', this.#dragOver, { signal });
    place.addEventListener('dragleave', this.#dragLeave, { signal });
    place.addEventListener('drop', this.#drop, { signal });
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.#deaf?.abort();
  }

  protected override render(): TemplateResult {
    if (this.fixed) return html`${this.#facts()}`;
    return html`
      ${this.#facts()}
      <div class="row">
        <button type="button" class="button" @click=${() => this.#choose('open')}>${t.model.open}</button>
        ${
          this.model.kind === 'open'
            ? html`<button type="button" class="button" @click=${() => this.#choose('add')}>${t.model.add}</button>`
            : nothing
        }
        <span class="hint">${t.model.hint}</span>
      </div>
      <input type="file" multiple accept=".stl,.3mf,.obj,.gcode,.gco,.g,.bgcode,model/stl,model/3mf,model/obj" hidden @change=${this.#chosen} />
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
        const remarks = this.model.models.flatMap((it, model) =>
          it.facts.warnings.map((remark) => ({ ...remark, model })),
        );
        const volume = this.model.models.reduce((sum, it) => sum + it.facts.volume_mm3, 0);
        const triangles = this.model.models.reduce((sum, it) => sum + it.facts.triangles, 0);
        return html`
          <p class="facts">
            <span>${t.format.volume(volume)}</span><span>${t.model.triangles(triangles)}</span>
          </p>
          ${remarks.map(({ message, code, model }) => html`<p class="remark">${message} ${this.#unit(code, model)}</p>`)}
        `;
      }
      default:
        return this.model satisfies never;
    }
  }

  /** The size that a guess at the file's unit gives; nothing is scaled unasked. */
  #unit(code: string, model: number): TemplateResult | typeof nothing {
    const factor = unitFactors[code];
    if (factor === undefined) return nothing;
    return html`<button type="button" class="link" @click=${() => this.tell<ScaleModel>('scale-model', { model, factor })}>
      ${t.mend.times(factor)}
    </button>`;
  }

  #choose(how: 'open' | 'add'): void {
    this.#how = how;
    this.querySelector<HTMLInputElement>('input[type=file]')?.click();
  }

  #chosen(event: Event): void {
    const input = event.target as HTMLInputElement;
    this.#send(this.#how, input.files);
    input.value = '';
  }

  #send(how: 'open' | 'add', files: FileList | null | undefined): void {
    if (files != null && files.length > 0) this.tell<readonly File[]>(`${how}-files`, [...files]);
  }

  #dragOver = (event: Event): void => {
    if (this.fixed || !(event instanceof DragEvent) || event.dataTransfer?.types.includes('Files') !== true) return;
    event.preventDefault();
    this.over = true;
  };

  #dragLeave = (event: Event): void => {
    // Within a page's element what is left for is seen only from outside of it.
    const isOut = event.currentTarget !== window || (event instanceof DragEvent && event.relatedTarget === null);
    if (isOut) this.over = false;
  };

  #drop = (event: Event): void => {
    if (this.fixed || !(event instanceof DragEvent)) return;
    event.preventDefault();
    this.over = false;
    this.#send('open', event.dataTransfer?.files);
  };
}

customElements.define('drop-zone', DropZone);
