// What the page's elements have in common: they draw into the page itself, so that one stylesheet fits all.
import { LitElement } from 'lit';

export abstract class Part extends LitElement {
  protected override createRenderRoot(): HTMLElement {
    return this;
  }

  /** Sends an event to whoever holds the element. */
  protected tell<T>(name: string, detail?: T): void {
    this.dispatchEvent(new CustomEvent(name, { detail, bubbles: true }));
  }
}
