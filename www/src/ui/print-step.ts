// Print: the printer at this computer by Web Serial, or a print server; the emergency stop stays in sight.
import { html, nothing, type TemplateResult } from 'lit';
import { t } from '../i18n/text.ts';
import type { PrintFile, PrintSession } from '../printer/print-session.ts';
import { partsOf } from '../slicer/gcode.ts';
import type { Result } from '../state.ts';
import './print-job.ts';
import './print-network.ts';
import './print-standing.ts';
import './printer-console.ts';
import './printer-move.ts';
import './printer-port.ts';
import { StepPart } from './step-part.ts';
import './temperature-chart.ts';

export class PrintStep extends StepPart {
  static override properties = { ...StepPart.properties, printing: { attribute: false } };
  declare printing: PrintSession | undefined;

  constructor() {
    super();
    this.printing = undefined;
  }

  protected override render(): TemplateResult {
    const { print, result } = this.state;
    const file = result && (() => fileOf(result));
    if (!print.supported) {
      return html`
        <section class="card"><p class="remark">${t.printing.unsupported}</p></section>
        <print-network .print=${print} .printing=${this.printing} .file=${file}></print-network>
      `;
    }
    const open = print.port.kind === 'open';
    return html`
      ${open ? this.#stop() : nothing}
      <printer-port .print=${print} .printing=${this.printing}></printer-port>
      <print-standing .print=${print} .printing=${this.printing}></print-standing>
      <print-job .print=${print} .printing=${this.printing} .file=${file}></print-job>
      ${open ? this.#machine() : nothing}
      <print-network .print=${print} .printing=${this.printing} .file=${file}></print-network>
    `;
  }

  #stop(): TemplateResult {
    return html`<button type="button" class="button emergency" @click=${() => this.printing?.emergencyStop()}>
      ${t.printing.stop}
    </button>`;
  }

  #machine(): TemplateResult {
    const { print } = this.state;
    const { nozzle, bed } = temperaturesOf(this.state.result);
    return html`
      <temperature-chart .print=${print} .printing=${this.printing} .nozzle=${nozzle} .bed=${bed}></temperature-chart>
      <printer-move .print=${print} .printing=${this.printing}></printer-move>
      <printer-console .print=${print} .printing=${this.printing}></printer-console>
    `;
  }
}

/** The sliced job as a file; the browser may keep its bytes on disk. */
function fileOf(result: Result): PrintFile {
  const text = new Blob(partsOf(result.gcode), { type: 'text/x.gcode' });
  return { name: result.gcode.joined.fileName, text, result };
}

/** What to preheat to: the job's settings, or what suits the commonest material. */
function temperaturesOf(result: Result | undefined): { nozzle: number; bed: number } {
  const { filament } = JSON.parse(result?.settings ?? '{}') as { filament?: Readonly<Record<string, number>> };
  return {
    nozzle: filament?.['first_layer_nozzle_temp'] ?? 210,
    bed: filament?.['first_layer_bed_temp'] ?? 60,
  };
}

customElements.define('print-step', PrintStep);
