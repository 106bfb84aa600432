// Preview: what the sliced job costs, and which colour stands for what.
import { html, type TemplateResult } from 'lit';
import './result-figures.ts';
import { StepPart } from './step-part.ts';

export class PreviewStep extends StepPart {
  protected override render(): TemplateResult {
    const { result, legend } = this.state;
    return html`<result-figures
      .report=${result?.report}
      .legend=${legend}
      @layer-change=${({ detail }: CustomEvent<number>) => this.session?.showLayer(detail)}
    ></result-figures>`;
  }
}

customElements.define('preview-step', PreviewStep);
