// What concerns the page itself: its language and its colours.
import { html, type TemplateResult } from 'lit';
import { type Language, languages, t, tables } from '../i18n/text.ts';
import type { ThemeChoice } from '../preferences.ts';
import { Part } from './part.ts';

/** Sends `language-change` with a Language, `theme-change` with a ThemeChoice. */
export class PageMenu extends Part {
  static override properties = { language: { attribute: false }, dark: { type: Boolean } };
  declare language: Language;
  declare dark: boolean;

  constructor() {
    super();
    this.language = 'en';
    this.dark = false;
  }

  protected override render(): TemplateResult {
    return html`
      <button
        type="button"
        class="icon-button"
        role="switch"
        aria-checked=${this.dark}
        aria-label=${t.page.dark}
        title=${t.page.dark}
        @click=${() => this.tell<ThemeChoice>('theme-change', this.dark ? 'light' : 'dark')}
      >
        <svg viewBox="0 0 20 20" width="18" height="18" aria-hidden="true">
          <circle cx="10" cy="10" r="7.25" fill="none" stroke="currentColor" stroke-width="1.5" />
          <path d="M10 2.75a7.25 7.25 0 0 1 0 14.5z" fill="currentColor" />
        </svg>
      </button>
      <select
        aria-label=${t.page.language}
        @change=${(event: Event) => this.tell('language-change', (event.target as HTMLSelectElement).value)}
      >
        ${languages.map(
          (it) =>
            html`<option value=${it} lang=${it} ?selected=${it === this.language}>${tables[it].language}</option>`,
        )}
      </select>
    `;
  }
}

customElements.define('page-menu', PageMenu);
