// Boxes in which supports are wanted (enforcers) or forbidden (blockers).
import { html, nothing, type TemplateResult } from 'lit';
import { t } from '../i18n/text.ts';
import { extentOf } from '../parts.ts';
import type { Changes } from '../settings/changes.ts';
import type { Value } from '../settings/fields.ts';
import { StepPart } from './step-part.ts';

type Kind = 'enforcers' | 'blockers';

/** x0, y0, z0, x1, y1, z1, mm on the bed. */
type Box = readonly number[];

const kinds: readonly Kind[] = ['enforcers', 'blockers'];
const axes = ['x', 'y', 'z'] as const;

export class ZonePanel extends StepPart {
  protected override render(): TemplateResult | typeof nothing {
    const { model, changes } = this.state;
    if (model.kind !== 'open' || (changes['support.method'] ?? 'none') === 'none') return nothing;
    const words = t.panels.zones;
    return html`<details class="card looked">
      <summary>${words.heading}</summary>
      <p class="hint">${words.hint}</p>
      ${kinds.map((kind) => boxesOf(changes, kind).map((box, index) => this.#box(kind, box, index)))}
      <div class="row">
        <button type="button" class="button" @click=${() => this.#add('enforcers')}>${words.addEnforcer}</button>
        <button type="button" class="button" @click=${() => this.#add('blockers')}>${words.addBlocker}</button>
      </div>
    </details>`;
  }

  #box(kind: Kind, box: Box, index: number): TemplateResult {
    const words = t.panels.zones;
    const name = `${words[kind]} ${index + 1}`;
    return html`<fieldset class="zone ${kind}">
      <legend>${name}</legend>
      ${[words.low, words.high].map(
        (end, row) => html`<span>${end}</span>
          ${axes.map(
            (axis, column) => html`<input
              type="number"
              step="any"
              aria-label=${words.axis(name, axis, end)}
              .value=${String(box[3 * row + column] ?? 0)}
              @change=${({ target }: Event) => this.#set(kind, index, 3 * row + column, target)}
            />`,
          )}`,
      )}
      <button type="button" class="icon-button" aria-label=${words.remove(name)} @click=${() => this.#remove(kind, index)}>×</button>
    </fieldset>`;
  }

  /** A new box around the left half of the parts. */
  #add(kind: Kind): void {
    const { parts, changes } = this.state;
    const [x0 = 0, y0 = 0, z0 = 0, x1 = 0, y1 = 0, z1 = 0] = extentOf(parts) ?? [];
    const round = (mm: number): number => Math.round(10 * mm) / 10;
    const box = [x0, y0, z0, (x0 + x1) / 2, y1, z1].map(round);
    this.#store(kind, [...boxesOf(changes, kind), box]);
  }

  #set(kind: Kind, index: number, place: number, target: EventTarget | null): void {
    const value = target instanceof HTMLInputElement ? target.valueAsNumber : Number.NaN;
    if (!Number.isFinite(value)) {
      this.requestUpdate();
      return;
    }
    const changed = (box: Box): Box => box.map((it, k) => (k === place ? value : it));
    this.#store(
      kind,
      boxesOf(this.state.changes, kind).map((box, k) => (k === index ? changed(box) : box)),
    );
  }

  #remove(kind: Kind, index: number): void {
    this.#store(
      kind,
      boxesOf(this.state.changes, kind).filter((_, k) => k !== index),
    );
  }

  #store(kind: Kind, boxes: readonly Box[]): void {
    const { [`support.${kind}`]: _, ...others } = this.state.changes;
    // The form has no field for lists of boxes; the engine reads them all the same.
    const value = boxes as unknown as Value;
    this.store?.update({ changes: boxes.length === 0 ? others : { ...others, [`support.${kind}`]: value } });
  }
}

function boxesOf(changes: Changes, kind: Kind): readonly Box[] {
  return (changes[`support.${kind}`] ?? []) as unknown as readonly Box[];
}

customElements.define('zone-panel', ZonePanel);
