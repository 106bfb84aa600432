// An error in words, with what to do about it.
import { html, type TemplateResult } from 'lit';
import type { ProblemName } from '../i18n/en.ts';
import { t } from '../i18n/text.ts';
import type { Problem } from '../state.ts';

export function problemBox(problem: Problem): TemplateResult {
  const known = t.problem[problem.name in t.problem ? (problem.name as ProblemName) : 'InternalError'];
  return html`
    <div class="problem" role="alert">
      <p class="problem-title">${known.title}</p>
      <p>${problem.message}</p>
      <p class="advice">${known.advice}</p>
    </div>
  `;
}
