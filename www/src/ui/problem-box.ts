// An error in words, with what to do about it.
import { html, nothing, type TemplateResult } from 'lit';
import type { ProblemName } from '../i18n/en.ts';
import { t } from '../i18n/text.ts';
import type { Edit } from '../messages.ts';
import { pathIn } from '../settings/fields.ts';
import type { Problem } from '../state.ts';

/** What the title says already. */
const TITLE = /^does not fit the printer: /;

/**
 * `mend` makes the change that the problem proposes, `show` goes to the setting that it is about; without them
 * neither is offered.
 */
export function problemBox(
  problem: Problem,
  mend?: (fix: Edit) => void,
  show?: (path: string) => void,
): TemplateResult {
  const { fix, file } = problem;
  const path = problem.name === 'SettingsError' ? pathIn(problem.message) : undefined;
  const known = t.problem[problem.name in t.problem ? (problem.name as ProblemName) : 'InternalError'];
  return html`
    <div class="problem" role="alert">
      <p class="problem-title">${known.title}</p>
      <p>${file === undefined ? '' : `${file}: `}${problem.message.replace(TITLE, '')}</p>
      <p class="advice">${file === undefined ? known.advice : t.model.unreadable}</p>
      ${
        fix === undefined || mend === undefined
          ? nothing
          : html`<button type="button" class="button small" @click=${() => mend(fix)}>${nameOf(fix)}</button>`
      }
      ${
        path === undefined || show === undefined
          ? nothing
          : html`<button type="button" class="button small" @click=${() => show(path)}>${t.settings.show}</button>`
      }
    </div>
  `;
}

/** What a change to the parts is called. */
function nameOf(edit: Edit): string {
  switch (edit.kind) {
    case 'turn':
      return t.mend.turn(edit.angle_deg);
    case 'turn_up':
      return t.mend.lay;
    case 'scale':
      return t.mend.scale(100 * edit.factors[0]);
    case 'drop':
      return t.mend.drop;
    default:
      return t.job.slice;
  }
}
