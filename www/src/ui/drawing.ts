// A picture that the engine drew as SVG, in the page.
import { html, type TemplateResult } from 'lit';
import { unsafeHTML } from 'lit/directives/unsafe-html.js';

/** `svg` comes from the engine, which writes nothing into it but numbers, colours and escaped labels. */
export function drawing(svg: string, label: string): TemplateResult {
  return html`<div class="drawing" role="img" aria-label=${label}>${unsafeHTML(svg)}</div>`;
}
