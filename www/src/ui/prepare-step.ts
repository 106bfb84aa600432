// Prepare: what is printed, and how.
import { html, type TemplateResult } from 'lit';
import settingsSchema from '../../../schema/settings.schema.json';
import { withChange } from '../settings/changes.ts';
import type { Schema } from '../settings/fields.ts';
import './drop-zone.ts';
import './settings-form.ts';
import type { SettingChange } from './settings-form.ts';
import { StepPart } from './step-part.ts';

export class PrepareStep extends StepPart {
  protected override render(): TemplateResult {
    const { model, engine, changes } = this.state;
    return html`
      <drop-zone
        .model=${model}
        .starting=${engine === 'starting'}
        @open-file=${({ detail }: CustomEvent<File>) => void this.session?.open({ name: detail.name, file: detail })}
      ></drop-zone>
      <settings-form
        .schema=${settingsSchema as Schema}
        .changes=${changes}
        @setting-change=${({ detail: { field, value } }: CustomEvent<SettingChange>) =>
          this.store?.update({ changes: withChange(changes, field, value) })}
      ></settings-form>
    `;
  }
}

customElements.define('prepare-step', PrepareStep);
