// What the page's elements have in common: they draw into the page itself, so that one stylesheet fits all,
// and draw anew when the language changes. They set styles as properties, since a strict policy refuses attributes.
import { LitElement } from 'lit';
import { onLanguage } from '../i18n/text.ts';

export abstract class Part extends LitElement {
  #forget: (() => void) | undefined;

  override connectedCallback(): void {
    super.connectedCallback();
    this.#forget = onLanguage(() => this.requestUpdate());
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.#forget?.();
  }

  protected override createRenderRoot(): HTMLElement {
    return this;
  }

  /** Sends an event to whoever holds the element. */
  protected tell<T>(name: string, detail?: T): void {
    this.dispatchEvent(new CustomEvent(name, { detail, bubbles: true }));
  }
}
