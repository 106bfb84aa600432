// Prepare: what is printed, and how.
import { html, nothing, type TemplateResult } from 'lit';
import settingsSchema from '../../../schema/settings.schema.json';
import { t } from '../i18n/text.ts';
import type { Edit, ModelSource } from '../messages.ts';
import { isOutside, type Part } from '../parts.ts';
import { chosenIn, offered, withProfile } from '../profiles/choice.ts';
import { type Changes, withChange } from '../settings/changes.ts';
import type { Schema } from '../settings/fields.ts';
import { roomOf } from '../settings/room.ts';
import { canDrawSpace } from '../view/webgl.ts';
import './base-layer-panel.ts';
import './drop-zone.ts';
import type { ScaleModel } from './drop-zone.ts';
import './face-chooser.ts';
import './orientation-panel.ts';
import './part-list.ts';
import './plane-panel.ts';
import { problemBox } from './problem-box.ts';
import { nameOf, type ProfileChange } from './profile-chooser.ts';
import './settings-form.ts';
import './zone-panel.ts';
import type { SettingChange } from './settings-form.ts';
import { StepPart } from './step-part.ts';

export class PrepareStep extends StepPart {
  readonly #canClick = canDrawSpace();

  protected override render(): TemplateResult {
    const { model, engine, changes, settingsNotes, frame } = this.state;
    if (frame === 'locked') return this.#locked();
    return html`
      <section class="card" aria-labelledby="model-heading">
        <div class="row spread">
          <h2 id="model-heading">${t.model.heading}</h2>
          ${this.#history()}
        </div>
        <drop-zone
          .model=${model}
          .starting=${engine === 'starting'}
          @open-files=${({ detail }: CustomEvent<readonly File[]>) => this.#open(detail)}
          @add-files=${({ detail }: CustomEvent<readonly File[]>) => void this.session?.add(detail.map(sourceOf))}
          @scale-model=${({ detail: { model, factor } }: CustomEvent<ScaleModel>) =>
            void this.session?.changeAll({ kind: 'scale', factors: [factor, factor, factor] }, model)}
        ></drop-zone>
        ${model.kind === 'open' ? this.#parts(model.models) : nothing}
      </section>
      <profile-chooser
        .chosen=${chosenIn(changes)}
        .notes=${settingsNotes}
        @profile-change=${({ detail: { kind, id } }: CustomEvent<ProfileChange>) =>
          this.store?.update({ changes: withProfile(changes, kind, id), settingsNotes: [] })}
      ></profile-chooser>
      <base-layer-panel .state=${this.state} .store=${this.store} .session=${this.session}></base-layer-panel>
      <orientation-panel .state=${this.state} .store=${this.store} .session=${this.session}></orientation-panel>
      <plane-panel .state=${this.state} .store=${this.store} .session=${this.session}></plane-panel>
      <zone-panel .state=${this.state} .store=${this.store} .session=${this.session}></zone-panel>
      <settings-form
        .schema=${settingsSchema as Schema}
        .changes=${changes}
        @setting-change=${({ detail: { field, value } }: CustomEvent<SettingChange>) =>
          this.store?.update({ changes: withChange(changes, field, value) })}
        @settings-import=${({ detail }: CustomEvent<File>) => void this.session?.importSettings(detail)}
        @settings-export=${() => this.session?.exportSettings()}
        @settings-reset=${() => this.store?.update({ changes: {} })}
      ></settings-form>
    `;
  }

  /** The model, and what it is printed with, where another site has chosen both. */
  #locked(): TemplateResult {
    const { model, engine, changes } = this.state;
    const chosen = chosenIn(changes);
    const rows = (['printer', 'material', 'quality'] as const).flatMap((kind) => {
      const found = offered[kind].find(({ id }) => id === chosen[kind]);
      return found === undefined ? [] : [html`<div><dt>${t.profiles[kind]}</dt><dd>${nameOf(found)}</dd></div>`];
    });
    return html`
      <section class="card" aria-labelledby="model-heading">
        <h2 id="model-heading">${t.model.heading}</h2>
        ${model.kind === 'open' ? html`<p class="model-name">${model.source.name}</p>` : nothing}
        ${model.kind === 'open' ? html`<p class="facts">${t.format.size(model.facts.size)}</p>` : nothing}
        <drop-zone fixed .model=${model} .starting=${engine === 'starting'}></drop-zone>
        ${rows.length === 0 ? nothing : html`<dl class="fixed">${rows}</dl>`}
      </section>
    `;
  }

  /** Opens models; a file of settings, which one may drop as well, is taken over. */
  #open(files: readonly File[]): void {
    const settings = files.find(({ name }) => /\.(json|ini|cfg|curaprofile)$/i.test(name));
    void (settings === undefined ? this.session?.open(files.map(sourceOf)) : this.session?.importSettings(settings));
  }

  #parts(models: Extract<typeof this.state.model, { kind: 'open' }>['models']): TemplateResult {
    const { parts, selected, changes, laying, trouble } = this.state;
    const chosen = parts.find(({ id }) => id === selected);
    return html`
      <part-list
        .models=${models}
        .parts=${parts}
        .selected=${selected}
        .room=${roomOf(changes)}
        .plate=${changes}
        .laying=${laying}
        .canClick=${this.#canClick}
        @select-part=${({ detail }: CustomEvent<number | null>) => this.session?.select(detail ?? undefined)}
        @duplicate-part=${({ detail }: CustomEvent<number>) => void this.session?.duplicate(detail)}
        @remove-part=${({ detail }: CustomEvent<number>) => void this.session?.remove(detail)}
        @edit-part=${this.#edit}
        @move-part=${({ detail: { id, x, y } }: CustomEvent<{ id: number; x: number; y: number }>) =>
          void this.session?.moveTo(id, x, y)}
        @own-part=${({ detail: { id, own } }: CustomEvent<{ id: number; own: Changes }>) =>
          void this.session?.giveOwn(id, own)}
        @lay-flat=${({ detail }: CustomEvent<boolean>) => this.store?.update({ laying: detail })}
      ></part-list>
      ${laying && chosen !== undefined ? this.#faces(chosen) : nothing}
      <div class="row">
        ${
          parts.length > 1 || parts.some((it) => isOutside(it, roomOf(changes)))
            ? html`<button type="button" class="button small" @click=${() => void this.session?.arrange()}>
              ${t.parts.arrange}
            </button>`
            : nothing
        }
        ${
          parts.length > 0
            ? html`<button type="button" class="button small" @click=${() => void this.session?.exportStl()}>
              ${t.parts.exportStl}
            </button>`
            : nothing
        }
      </div>
      ${trouble === undefined ? nothing : problemBox(trouble, undefined, (path) => this.tell<string>('show-setting', path))}
    `;
  }

  #faces(part: Part): TemplateResult {
    return html`<face-chooser
      .subject=${part}
      .state=${this.state}
      .session=${this.session}
      @edit-part=${this.#edit}
    ></face-chooser>`;
  }

  #edit = ({ detail: { id, edit } }: CustomEvent<{ id: number; edit: Edit }>): void => {
    void this.session?.change(id, edit);
  };

  #history(): TemplateResult {
    const { past, future } = this.state.history;
    return html`<span class="row tight">
      ${icon(t.parts.undo, 'M6 3 2 7l4 4M2 7h8a4 4 0 0 1 0 8H7', past.length > 0, () => this.session?.undo())}
      ${icon(t.parts.redo, 'M10 3l4 4-4 4M14 7H6a4 4 0 0 0 0 8h3', future.length > 0, () => this.session?.redo())}
    </span>`;
  }
}

function icon(label: string, path: string, enabled: boolean, act: () => void): TemplateResult {
  return html`<button
    type="button"
    class="icon-button quiet"
    aria-label=${label}
    title=${label}
    aria-disabled=${!enabled}
    @click=${act}
  >
    <svg viewBox="0 0 16 16" width="16" height="16" aria-hidden="true" fill="none" stroke="currentColor" stroke-width="1.6">
      <path d=${path} />
    </svg>
  </button>`;
}

const sourceOf = (file: File): ModelSource => ({ name: file.name, file });

customElements.define('prepare-step', PrepareStep);
