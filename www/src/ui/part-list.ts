// The parts on the bed: which there are, which is chosen, and everything that can be done to it.
import { html, nothing, type TemplateResult } from 'lit';
import { t } from '../i18n/text.ts';
import type { Edit } from '../messages.ts';
import { hasOwn, isOutside, middleOf, type Part, type Room, scaleOf, sizeOf } from '../parts.ts';
import { type Changes, withChange } from '../settings/changes.ts';
import { ownGroups } from '../settings/own.ts';
import type { OpenModel } from '../state.ts';
import { Part as Element } from './part.ts';
import './settings-form.ts';
import type { SettingChange } from './settings-form.ts';

const axes = ['X', 'Y', 'Z'] as const;

interface NumberField {
  readonly label: string;
  /** What stands in front of it. */
  readonly sign: string;
  readonly value: number;
  readonly unit: string;
  /** It must be more than this. */
  readonly least?: number;
}

/**
 * Sends `select-part`, `duplicate-part`, `remove-part` with a part's number, `edit-part` ({id, edit}),
 * `move-part` ({id, x, y}), `own-part` ({id, own}), `arrange-parts`, `lay-flat`.
 */
export class PartList extends Element {
  static override properties = {
    models: { attribute: false },
    parts: { attribute: false },
    selected: { attribute: false },
    room: { attribute: false },
    laying: { type: Boolean },
    canClick: { type: Boolean },
    plate: { attribute: false },
    uniform: { state: true },
    showsOwn: { state: true },
  };
  declare models: readonly OpenModel[];
  declare parts: readonly Part[];
  declare selected: number | undefined;
  declare room: Room;
  /** A face is being chosen that shall lie on the bed. */
  declare laying: boolean;
  /** Faces can be clicked. */
  declare canClick: boolean;
  /** The plate's settings. */
  declare plate: Changes;
  /** All three sizes change together. */
  declare uniform: boolean;
  /** The form of the chosen part's own settings is open. */
  declare showsOwn: boolean;

  constructor() {
    super();
    this.models = [];
    this.parts = [];
    this.selected = undefined;
    this.room = [220, 220, 250, 0, 0, false];
    this.laying = false;
    this.canClick = false;
    this.plate = {};
    this.uniform = true;
    this.showsOwn = false;
  }

  protected override render(): TemplateResult {
    const chosen = this.parts.find(({ id }) => id === this.selected);
    return html`
      <ul class="parts" aria-label=${t.parts.heading}>
        ${this.parts.map((part) => this.#row(part))}
      </ul>
      ${chosen === undefined ? nothing : this.#tools(chosen)}
    `;
  }

  /** The number of a part among its copies; empty for a single one. */
  #numberOf(part: Part): string {
    const copies = this.parts.filter((it) => it.model === part.model);
    return copies.length > 1 ? ` ${copies.indexOf(part) + 1}` : '';
  }

  #row(part: Part): TemplateResult {
    const model = this.models[part.model];
    const number = this.#numberOf(part);
    const chosen = part.id === this.selected;
    return html`<li>
      <button type="button" class="part" aria-pressed=${chosen} @click=${() => this.tell('select-part', chosen ? undefined : part.id)}>
        <span class="model-name"><span>${model?.source.name}</span>${number}</span>
        <span class="facts"><span>${t.format.size(sizeOf(part))}</span></span>
        ${hasOwn(part) ? html`<span class="badge">${t.parts.own}</span>` : nothing}
        ${isOutside(part, this.room) ? html`<span class="remark">${t.parts.outside}</span>` : nothing}
      </button>
      <button
        type="button"
        class="icon-button quiet"
        aria-label=${t.parts.remove(`${model?.source.name ?? ''}${number}`)}
        title=${t.parts.remove(`${model?.source.name ?? ''}${number}`)}
        @click=${() => this.tell('remove-part', part.id)}
      >
        <span aria-hidden="true">×</span>
      </button>
    </li>`;
  }

  #tools(part: Part): TemplateResult {
    const [x, y] = middleOf(part);
    const size = sizeOf(part);
    const edit = (change: Edit): void => this.tell('edit-part', { id: part.id, edit: change });
    return html`<div class="part-tools">
      <div class="part-row" role="group" aria-label=${t.parts.position}>
        <span aria-hidden="true">${t.parts.position}</span>
        ${this.#number({ label: t.parts.at('X'), sign: 'X', value: x, unit: 'mm' }, (to) => this.tell('move-part', { id: part.id, x: to, y }))}
        ${this.#number({ label: t.parts.at('Y'), sign: 'Y', value: y, unit: 'mm' }, (to) => this.tell('move-part', { id: part.id, x, y: to }))}
      </div>
      <div class="part-row" role="group" aria-label=${t.parts.size}>
        <span aria-hidden="true">${t.parts.size}</span>
        ${axes.map((axis, k) =>
          this.#number({ label: t.parts.sizeOf(axis), sign: axis, value: size[k] ?? 0, unit: 'mm', least: 0 }, (to) =>
            edit(this.#scaling(k, to / (size[k] ?? 1))),
          ),
        )}
        ${this.#number({ label: t.parts.scale, sign: '%', value: 100 * scaleOf(part), unit: '%', least: 0 }, (to) => {
          const factor = to / (100 * scaleOf(part));
          edit({ kind: 'scale', factors: [factor, factor, factor] });
        })}
        <label class="check"
          ><input type="checkbox" .checked=${this.uniform} @change=${() => {
            this.uniform = !this.uniform;
          }} />${t.parts.uniform}</label
        >
      </div>
      <div class="part-row" role="group" aria-label=${t.parts.turn}>
        <span aria-hidden="true">${t.parts.turn}</span>
        ${axes.map(
          (axis, k) => html`<span class="turn">
          <button type="button" class="icon-button" aria-label=${t.parts.turnBy(axis, -90)} title=${t.parts.turnBy(axis, -90)}
            @click=${() => edit({ kind: 'turn', axis: k, angle_deg: -90 })}><span aria-hidden="true">↺</span></button>
          ${this.#number({ label: t.parts.turnAbout(axis), sign: axis, value: 0, unit: '°' }, (to) => edit({ kind: 'turn', axis: k, angle_deg: to }))}
          <button type="button" class="icon-button" aria-label=${t.parts.turnBy(axis, 90)} title=${t.parts.turnBy(axis, 90)}
            @click=${() => edit({ kind: 'turn', axis: k, angle_deg: 90 })}><span aria-hidden="true">↻</span></button>
        </span>`,
        )}
      </div>
      <div class="part-row" role="group" aria-label=${t.parts.mirroring}>
        <span aria-hidden="true">${t.parts.mirroring}</span>
        ${axes.map(
          (axis, k) => html`<button
          type="button"
          class="button small"
          aria-label=${t.parts.mirror(axis)}
          @click=${() => edit({ kind: 'mirror', axis: k })}
        >
          ${axis}
        </button>`,
        )}
      </div>
      <div class="row">
        ${small(t.parts.layFlat, () => this.tell('lay-flat', !this.laying), this.laying)}
        ${small(t.parts.drop, () => edit({ kind: 'drop' }))}
        ${small(t.parts.duplicate, () => this.tell('duplicate-part', part.id))}
        ${small(
          t.parts.ownSettings,
          () => {
            this.showsOwn = !this.showsOwn;
          },
          this.showsOwn,
        )}
      </div>
      ${this.laying ? html`<p class="hint">${this.canClick ? t.parts.layHow : t.parts.layChoose}</p>` : nothing}
      ${this.showsOwn ? this.#own(part) : nothing}
    </div>`;
  }

  /** The settings that the part has of its own. */
  #own(part: Part): TemplateResult {
    const { id, own = {} } = part;
    const give = (event: Event, changes: Changes): void => {
      event.stopPropagation();
      this.tell('own-part', { id, own: changes });
    };
    return html`<settings-form
      .own=${ownGroups(this.plate)}
      .partName=${`${this.models[part.model]?.source.name ?? ''}${this.#numberOf(part)}`}
      .changes=${own}
      @setting-change=${(event: CustomEvent<SettingChange>) =>
        give(event, withChange(own, event.detail.field, event.detail.value))}
      @settings-reset=${(event: Event) => give(event, {})}
    ></settings-form>`;
  }

  #scaling(axis: number, factor: number): Edit {
    const factors = [0, 1, 2].map((k) => (this.uniform || k === axis ? factor : 1)) as [number, number, number];
    return { kind: 'scale', factors };
  }

  /** A number to type; what makes no sense is set back. */
  #number(
    { label, sign, value, unit, least = Number.NEGATIVE_INFINITY }: NumberField,
    change: (to: number) => void,
  ): TemplateResult {
    const shown = String(Math.round(value * 100) / 100);
    return html`<label class="amount"
      ><span aria-hidden="true">${sign}</span
      ><input
        type="text"
        inputmode="decimal"
        autocomplete="off"
        aria-label="${label}, ${unit}"
        .value=${shown}
        @change=${(event: Event) => {
          const input = event.target as HTMLInputElement;
          const to = Number(input.value.replace(',', '.'));
          const fits = input.value.trim() !== '' && Number.isFinite(to) && to > least;
          input.value = shown;
          if (fits) change(to);
        }}
    /></label>`;
  }
}

function small(label: string, act: () => void, pressed?: boolean): TemplateResult {
  return html`<button type="button" class="button small" aria-pressed=${pressed ?? nothing} @click=${act}>${label}</button>`;
}

customElements.define('part-list', PartList);
