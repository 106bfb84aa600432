// Which face shall lie on the bed, chosen by pictures of the part on its largest faces: for the keyboard, and where
// faces can't be clicked.
import { html, type nothing, type TemplateResult } from 'lit';
import { t } from '../i18n/text.ts';
import type { Up } from '../messages.ts';
import type { Part } from '../parts.ts';
import { Asked, numberOf } from './asked.ts';
import { problemBox } from './problem-box.ts';
import { StepPart } from './step-part.ts';

/** Size of a picture, px, and its pixels per CSS px. */
const PICTURE = { width: 104, height: 84 };
const SHARPNESS = 2;

interface Way {
  readonly up: Up;
  readonly picture: ImageData;
}

/** Sends `edit-part` ({id, edit}) when a picture is chosen. */
export class FaceChooser extends StepPart {
  static override properties = { ...StepPart.properties, subject: { attribute: false } };
  declare subject: Part | undefined;
  readonly #ways = new Asked<readonly Way[]>(this);

  constructor() {
    super();
    this.subject = undefined;
  }

  protected override willUpdate(): void {
    const { session, subject: part } = this;
    const { model } = this.state;
    if (session === undefined || part === undefined || model.kind !== 'open') return;
    this.#ways.want(`${numberOf(model.models)} ${part.model}`, async () => {
      const { width, height } = PICTURE;
      const ups = await session.faces(part.model);
      const drawn = ups.map((up) => session.thumbnail(up, width * SHARPNESS, height * SHARPNESS, part.model));
      return (await Promise.all(drawn)).map((picture, k) => ({ picture, up: ups[k] ?? [0, 0, 1] }));
    });
  }

  protected override updated(): void {
    const ways = this.#ways.answer ?? [];
    this.querySelectorAll('canvas').forEach((canvas, k) => {
      const picture = ways[k]?.picture;
      if (picture !== undefined) canvas.getContext('2d')?.putImageData(picture, 0, 0);
    });
  }

  protected override render(): TemplateResult | typeof nothing {
    const { answer, problem } = this.#ways;
    if (problem !== undefined) return problemBox(problem);
    if (answer === undefined) return html`<p class="hint">${t.parts.drawing}</p>`;
    return html`<div class="strip" role="group" aria-label=${t.parts.layFlat}>
      ${answer.map(({ up }, k) => this.#way(up, t.parts.layOn(k + 1)))}
    </div>`;
  }

  #way(up: Up, name: string): TemplateResult {
    return html`<button type="button" class="kind candidate" aria-label=${name} title=${name} @click=${() => this.#lay(up)}>
      <canvas width=${PICTURE.width * SHARPNESS} height=${PICTURE.height * SHARPNESS} aria-hidden="true"></canvas>
    </button>`;
  }

  #lay(up: Up): void {
    if (this.subject !== undefined) this.tell('edit-part', { id: this.subject.id, edit: { kind: 'turn_up', up } });
  }
}

customElements.define('face-chooser', FaceChooser);
