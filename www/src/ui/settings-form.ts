// The settings: what is used most first, then every stage's, all made from the engine's schema.
import { html, nothing, type TemplateResult } from 'lit';
import { groupLabel, labelOf, valueLabel } from '../i18n/settings.ts';
import { spoken, t } from '../i18n/text.ts';
import { type Changes, fault, parse } from '../settings/changes.ts';
import { type Depth, depthOf, depths, found, shownAt } from '../settings/depths.ts';
import { type Field, type Group, groupsOf, type Schema, type Value } from '../settings/fields.ts';
import { Part } from './part.ts';

export interface SettingChange {
  readonly field: Field;
  readonly value: Value;
}

/**
 * The form for the plate, made from `schema`, or for a part's own settings, made from `own`. Sends `setting-change`
 * with a SettingChange, `settings-import` with a File, `settings-export`, `settings-reset`.
 */
export class SettingsForm extends Part {
  static override properties = {
    schema: { attribute: false },
    own: { attribute: false },
    partName: { type: String },
    changes: { attribute: false },
    faults: { state: true },
    depth: { state: true },
    search: { state: true },
    pointed: { state: true },
  };
  declare schema: Schema | undefined;
  /** The settings that the part can have; fields default to what the plate has. */
  declare own: readonly Group[] | undefined;
  /** Name of the part whose own settings these are; empty for the plate's. */
  declare partName: string;
  declare changes: Changes;
  /** Why an input's text was not taken, by path. */
  declare faults: Readonly<Record<string, string>>;
  declare depth: Depth;
  declare search: string;
  /** Path of the setting that somebody is led to. */
  declare pointed: string | undefined;
  #groups: readonly Group[] = [];

  constructor() {
    super();
    this.schema = undefined;
    this.own = undefined;
    this.partName = '';
    this.changes = {};
    this.faults = {};
    this.depth = 'basic';
    this.search = '';
    this.pointed = undefined;
  }

  protected override willUpdate(changed: Map<string, unknown>): void {
    if (changed.has('schema') && this.schema !== undefined) this.#groups = groupsOf(this.schema);
    if (this.own !== undefined) this.#groups = this.own;
  }

  protected override render(): TemplateResult {
    const searching = this.search.trim() !== '';
    const shown = searching
      ? found(this.#groups, this.search, (field) => labelOf(field, spoken()))
      : shownAt(this.depth, this.#groups);
    const changed = Object.keys(this.changes).length;
    return html`
      <section class=${this.own === undefined ? 'card' : 'own-settings'} aria-labelledby=${this.#id('heading')}>
        ${this.own === undefined ? this.#head(changed) : this.#ownHead(changed)}
        <div class="choice wide" role="group" aria-label=${t.settings.depth}>
          ${depths.map(
            (
              it,
            ) => html`<button type="button" aria-pressed=${!searching && it === this.depth} @click=${() => this.#go(it)}>
              ${t.settings.depths[it]}
            </button>`,
          )}
        </div>
        <input
          type="search"
          class="search"
          aria-label=${t.settings.search}
          placeholder=${t.settings.search}
          .value=${this.search}
          @input=${(event: Event) => {
            this.search = (event.target as HTMLInputElement).value;
          }}
        />
        ${shown.length === 0 ? html`<p class="hint">${t.settings.none}</p>` : nothing}
        ${shown.map((group) => (this.depth === 'all' && !searching ? this.#folded(group) : this.#open(group)))}
      </section>
    `;
  }

  #head(changed: number): TemplateResult {
    return html`<div class="row spread">
      <h2 id=${this.#id('heading')}>${t.settings.heading} ${badge(changed)}</h2>
      ${this.#files(changed > 0)}
    </div>`;
  }

  #ownHead(changed: number): TemplateResult {
    return html`<div class="row spread">
      <h3 id=${this.#id('heading')}>${t.settings.own(this.partName)} ${badge(changed)}</h3>
      ${changed > 0 ? link(t.settings.resetAll, () => this.tell('settings-reset')) : nothing}
    </div>`;
  }

  /** A name in the page for something of this form. */
  #id(name: string): string {
    return this.own === undefined ? `settings-${name}` : `own-settings-${name}`;
  }

  #go(depth: Depth): void {
    this.depth = depth;
    this.search = '';
  }

  /** Shows a setting in the depth and group that have it, marks it and takes the focus there. */
  async reveal(path: string): Promise<void> {
    const depth = depthOf(path, this.#groups);
    if (depth === undefined) return;
    if (!shownAt(this.depth, this.#groups).some(({ fields }) => fields.some((it) => it.path === path))) {
      this.depth = depth;
    }
    this.search = '';
    this.pointed = path;
    await this.updateComplete;
    const row = this.querySelector<HTMLElement>('.field.pointed');
    const group = row?.closest('details');
    if (group) group.open = true;
    row?.querySelector<HTMLElement>('input, select, textarea')?.focus({ preventScroll: true });
    // With the focus comes the help below it.
    row?.scrollIntoView({ block: 'center' });
  }

  #files(changed: boolean): TemplateResult {
    return html`<span class="row tight">
      ${changed ? link(t.settings.resetAll, () => this.tell('settings-reset')) : nothing}
      ${link(t.settings.import, () => this.querySelector<HTMLInputElement>('input[type=file]')?.click())}
      ${link(t.settings.export, () => this.tell('settings-export'))}
      <input
        type="file"
        accept=".json,.ini,.gcode,.cfg,.curaprofile,application/json"
        hidden
        @change=${(event: Event) => {
          const input = event.target as HTMLInputElement;
          const file = input.files?.[0];
          if (file !== undefined) this.tell('settings-import', file);
          input.value = '';
        }}
      />
    </span>`;
  }

  #open(group: Group): TemplateResult {
    return html`<div class="open-group">
      ${group.label === '' ? nothing : html`<h3>${groupLabel(group.path, spoken())}</h3>`}
      <div class="fields">${group.fields.map((field) => this.#row(field, 'open'))}</div>
    </div>`;
  }

  #folded(group: Group): TemplateResult {
    const changed = group.fields.filter((field) => field.path in this.changes).length;
    return html`<details class="group">
      <summary>
        ${group.path === '' ? t.settings.general : groupLabel(group.path, spoken())}
        ${badge(changed)}
      </summary>
      <div class="fields">${group.fields.map((field) => this.#row(field, 'all'))}</div>
    </details>`;
  }

  #row(field: Field, where: string): TemplateResult {
    const id = this.own === undefined ? `${where}-${field.path}` : `own-${where}-${field.path}`;
    const changed = field.path in this.changes;
    return html`<div class="field ${changed ? 'changed' : ''} ${field.kind === 'text' ? 'text' : ''} ${field.path === this.pointed ? 'pointed' : ''}">
      <label for=${id}>${labelOf(field, spoken())}</label>
      ${this.#control(field, id)}
      <span class="unit">${'unit' in field ? t.settings.unit(field.unit) : ''}</span>
      ${changed ? this.#reset(field) : nothing} ${this.#note(field, id)}
    </div>`;
  }

  #control(field: Field, id: string): TemplateResult {
    const value = this.changes[field.path] ?? field.default;
    const change = (event: Event): void => this.#change(field, inputText(event.target));
    switch (field.kind) {
      case 'choice':
        return html`<select id=${id} aria-describedby="${id}-note" .value=${String(value)} @change=${change}>
          ${field.choices.map(
            (it) =>
              html`<option value=${it.value} title=${it.help} ?selected=${it.value === value}>${valueLabel(it.value, spoken())}</option>`,
          )}
        </select>`;
      case 'switch':
        return html`<input id=${id} type="checkbox" aria-describedby="${id}-note" .checked=${value === true} @change=${change} />`;
      case 'text':
        return html`<textarea id=${id} aria-describedby="${id}-note" rows="4" spellcheck="false" .value=${String(value)} @change=${change}></textarea>`;
      case 'number':
      case 'numbers':
        return html`<input
          id=${id}
          type="text"
          inputmode="decimal"
          autocomplete="off"
          aria-invalid=${field.path in this.faults}
          aria-describedby="${id}-note"
          .value=${textOf(value)}
          @change=${change}
        />`;
      default:
        return field satisfies never;
    }
  }

  #reset(field: Field): TemplateResult {
    const label = t.settings.reset(labelOf(field, spoken()), textOf(field.default));
    return html`<button type="button" class="reset" aria-label=${label} title=${label} @click=${() => this.#set(field, field.default)}>
      <span aria-hidden="true">↺</span>
    </button>`;
  }

  /** Why the text was not taken; else help and range, which show while the row has the focus. */
  #note(field: Field, id: string): TemplateResult {
    const reason = this.faults[field.path];
    const help = [field.help, rangeOf(field)].filter((it) => it !== '').join(' ');
    return html`<p id="${id}-note" class=${reason === undefined ? 'help' : 'fault'}>${reason ?? help}</p>`;
  }

  #change(field: Field, text: string): void {
    const value = parse(field, text);
    const reason = fault(field, value);
    if (reason !== undefined || value === undefined) {
      const why = reason === 'range' ? rangeOf(field) : t.settings[reason ?? 'number'];
      this.faults = { ...this.faults, [field.path]: String(why) };
      return;
    }
    this.#set(field, value);
  }

  #set(field: Field, value: Value): void {
    const { [field.path]: _, ...others } = this.faults;
    this.faults = others;
    if (field.path === this.pointed) this.pointed = undefined;
    this.tell<SettingChange>('setting-change', { field, value });
    this.requestUpdate();
  }
}

function inputText(target: EventTarget | null): string {
  if (target instanceof HTMLInputElement && target.type === 'checkbox') return String(target.checked);
  return target instanceof HTMLInputElement ||
    target instanceof HTMLSelectElement ||
    target instanceof HTMLTextAreaElement
    ? target.value
    : '';
}

function textOf(value: Value): string {
  return typeof value === 'object' ? value.join(' × ') : String(value);
}

function rangeOf(field: Field): string {
  if (!('unit' in field) || field.low === undefined || field.high === undefined) return '';
  return t.settings.range(String(field.low), String(field.high), t.settings.unit(field.unit));
}

function badge(changed: number): TemplateResult | typeof nothing {
  return changed > 0 ? html`<span class="badge">${changed} ${t.settings.changed}</span>` : nothing;
}

function link(label: string, act: () => void): TemplateResult {
  return html`<button type="button" class="link" @click=${act}>${label}</button>`;
}

customElements.define('settings-form', SettingsForm);
