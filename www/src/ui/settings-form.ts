// The settings: what is used most first, then every stage's, all made from the engine's schema.
import { html, nothing, type TemplateResult } from 'lit';
import { t } from '../i18n/text.ts';
import { type Changes, fault, parse } from '../settings/changes.ts';
import { type Field, type Group, groupsOf, type Schema, type Value, words } from '../settings/fields.ts';
import { Part } from './part.ts';

/** Shown without opening anything; those that the schema does not have are left out. */
const basic = [
  'layers.height',
  'walls.count',
  'infill.density',
  'infill.pattern',
  'adhesion.kind',
  'support.method',
  'orientation.mode',
  'filament.nozzle_temp',
  'filament.bed_temp',
];

export interface SettingChange {
  readonly field: Field;
  readonly value: Value;
}

/** Sends `setting-change` with a SettingChange. */
export class SettingsForm extends Part {
  static override properties = {
    schema: { attribute: false },
    changes: { attribute: false },
    faults: { state: true },
  };
  declare schema: Schema | undefined;
  declare changes: Changes;
  /** Why an input's text was not taken, by path. */
  declare faults: Readonly<Record<string, string>>;
  #groups: readonly Group[] = [];

  constructor() {
    super();
    this.schema = undefined;
    this.changes = {};
    this.faults = {};
  }

  protected override willUpdate(changed: Map<string, unknown>): void {
    if (changed.has('schema') && this.schema !== undefined) this.#groups = groupsOf(this.schema);
  }

  protected override render(): TemplateResult {
    const fields = this.#groups.flatMap((group) => group.fields);
    const first = basic.map((path) => fields.find((field) => field.path === path)).filter((it) => it !== undefined);
    return html`
      <section class="card" aria-labelledby="settings-heading">
        <h2 id="settings-heading">${t.settings.heading}</h2>
        <div class="fields">${first.map((field) => this.#row(field, 'basic'))}</div>
        <details class="all">
          <summary>${t.settings.all}</summary>
          ${this.#groups.map((group) => this.#group(group))}
        </details>
      </section>
    `;
  }

  #group(group: Group): TemplateResult {
    const changed = group.fields.filter((field) => field.path in this.changes).length;
    return html`<details class="group">
      <summary>
        ${group.path === '' ? t.settings.general : groupLabel(group.path)}
        ${changed > 0 ? html`<span class="badge">${changed} ${t.settings.changed}</span>` : nothing}
      </summary>
      <div class="fields">${group.fields.map((field) => this.#row(field, 'all'))}</div>
    </details>`;
  }

  #row(field: Field, where: string): TemplateResult {
    const id = `${where}-${field.path}`;
    const changed = field.path in this.changes;
    return html`<div class="field ${changed ? 'changed' : ''} ${field.kind}">
      <label for=${id} title=${field.help}>${field.label}</label>
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
        return html`<select id=${id} .value=${String(value)} @change=${change}>
          ${field.choices.map(
            (it) =>
              html`<option value=${it.value} title=${it.help} ?selected=${it.value === value}>${words(it.value)}</option>`,
          )}
        </select>`;
      case 'switch':
        return html`<input id=${id} type="checkbox" .checked=${value === true} @change=${change} />`;
      case 'text':
        return html`<textarea id=${id} rows="4" spellcheck="false" .value=${String(value)} @change=${change}></textarea>`;
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
    const label = t.settings.reset(field.label, textOf(field.default));
    return html`<button type="button" class="reset" aria-label=${label} title=${label} @click=${() => this.#set(field, field.default)}>
      <span aria-hidden="true">↺</span>
    </button>`;
  }

  /** Why the text was not taken; otherwise the range, for screen readers alone. */
  #note(field: Field, id: string): TemplateResult | typeof nothing {
    if (field.kind !== 'number' && field.kind !== 'numbers') return nothing;
    const reason = this.faults[field.path];
    return html`<p id="${id}-note" class=${reason === undefined ? 'unseen' : 'fault'}>${reason ?? rangeOf(field)}</p>`;
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

function groupLabel(path: string): string {
  const [first = '', ...rest] = path.split('.').map((name) => name.replaceAll('_', ' '));
  const label = [first, ...rest].join(', ');
  return label.charAt(0).toUpperCase() + label.slice(1);
}

customElements.define('settings-form', SettingsForm);
