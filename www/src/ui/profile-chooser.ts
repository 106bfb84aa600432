// Printer, material and quality by name, and what an import of settings left out.
import { html, nothing, type TemplateResult } from 'lit';
import { t } from '../i18n/text.ts';
import { type Kind, type Profile, printers, usbOf } from '../profiles/catalog.ts';
import { offered } from '../profiles/choice.ts';
import type { Layers } from '../profiles/layers.ts';
import { Part } from './part.ts';

/** A profile chosen; without an id none. */
export interface ProfileChange {
  readonly kind: Kind;
  readonly id: string | undefined;
}

/** Sends `profile-change` with a ProfileChange. */
export class ProfileChooser extends Part {
  static override properties = { chosen: { attribute: false }, notes: { attribute: false } };
  declare chosen: Layers;
  /** What there is to say about the settings imported last. */
  declare notes: readonly string[];

  constructor() {
    super();
    this.chosen = {};
    this.notes = [];
  }

  protected override render(): TemplateResult {
    return html`
      <section class="card" aria-labelledby="profiles-heading">
        <h2 id="profiles-heading">${t.profiles.heading}</h2>
        <div class="fields">${this.#select('printer')} ${this.#select('material')} ${this.#select('quality')}</div>
        ${this.#usb()}
        <div role="status">${this.#notes()}</div>
      </section>
    `;
  }

  /** What came of an import; how each value fared can be long. */
  #notes(): TemplateResult | typeof nothing {
    const [first, ...rest] = this.notes.map((note) => html`<p class="remark">${note}</p>`);
    if (first === undefined) return nothing;
    if (rest.length === 0) return first;
    return html`${first}<details><summary>${t.profiles.notTaken}</summary>${rest}</details>`;
  }

  #select(kind: Kind): TemplateResult {
    const chosen = this.chosen[kind] ?? '';
    const change = (event: Event): void => {
      const id = (event.target as HTMLSelectElement).value;
      this.tell<ProfileChange>('profile-change', { kind, id: id === '' ? undefined : id });
    };
    return html`<div class="field">
      <label for="profile-${kind}">${t.profiles[kind]}</label>
      <select id="profile-${kind}" .value=${chosen} @change=${change}>
        <option value="" ?selected=${chosen === ''}>${t.profiles.none[kind]}</option>
        ${offered[kind].map((it) => html`<option value=${it.id} ?selected=${chosen === it.id}>${nameOf(it)}</option>`)}
      </select>
    </div>`;
  }

  #usb(): TemplateResult | typeof nothing {
    const { printer } = this.chosen;
    return printer === undefined ? nothing : html`<p class="hint">${t.profiles.usb[usbOf(printer)]}</p>`;
  }
}

/** With its maker's name, if it is a printer. */
export function nameOf({ id, name }: Profile): string {
  const vendor = printers.find((it) => it.id === id)?.vendor;
  return vendor === undefined ? name : `${vendor} ${name}`;
}

customElements.define('profile-chooser', ProfileChooser);
