// Preview: what the sliced job costs, which colour stands for what, and when each layer is printed.
import { html, nothing, svg, type TemplateResult } from 'lit';
import { t } from '../i18n/text.ts';
import type { Result } from '../state.ts';
import { type ColourBy, colourings, scaleColour } from '../view/colours.ts';
import './result-figures.ts';
import { StepPart } from './step-part.ts';

/** Bars of the time line at the most; longer jobs share them. */
const MOST_BARS = 120;

export class PreviewStep extends StepPart {
  protected override render(): TemplateResult {
    const { result, legend, roles, hidden, colourBy, flat, frame } = this.state;
    return html`
      <result-figures
        .report=${result?.report}
        .legend=${legend}
        .roles=${roles}
        .leftOut=${hidden}
        .fixing=${frame !== 'locked'}
        .filtering=${!flat && colourBy === 'role'}
        .colours=${flat ? nothing : this.#colours()}
        @layer-change=${({ detail }: CustomEvent<number>) => this.session?.showLayer(detail)}
        @fix=${({ detail }: CustomEvent<readonly string[]>) => void this.session?.fix(detail)}
        @drop-parts=${() => void this.session?.mend({ kind: 'drop' })}
        @move-aside=${() => void this.session?.moveAside()}
        @roles-change=${({ detail }: CustomEvent<ReadonlySet<string>>) => this.store?.update({ hidden: detail })}
      >
      </result-figures>
      ${result === undefined ? nothing : this.#timeLine(result)}
    `;
  }

  #colours(): TemplateResult {
    const { colourBy, range } = this.state;
    return html`<div class="choice wide" role="group" aria-labelledby="colours-heading">
        ${colourings.map(
          (it) => html`<button
            type="button"
            aria-pressed=${it === colourBy}
            @click=${() => this.store?.update({ colourBy: it })}
          >
            ${t.view.colours[it]}
          </button>`,
        )}
      </div>
      ${range === undefined || colourBy === 'role' || colourBy === 'tool' ? nothing : scaleOf(colourBy, range)}`;
  }

  #timeLine({ gcode }: Result): TemplateResult {
    const times = [...gcode.joined.times];
    const { layer } = this.state;
    const reached = times.slice(0, layer).reduce((sum, time) => sum + time, 0);
    const bars = barsOf(times);
    const highest = Math.max(...bars, 1e-9);
    const at = ((layer + 0.5) / times.length) * 100;
    return html`<section class="card" aria-labelledby="time-heading">
      <h2 id="time-heading">${t.view.timeline}</h2>
      <svg class="time-line" viewBox="0 0 100 30" preserveAspectRatio="none" aria-hidden="true" @click=${this.#jump}>
        ${bars.map((time, k) => {
          const width = 100 / bars.length;
          const height = (28 * time) / highest;
          return svg`<rect x=${k * width} y=${30 - height} width=${width * 0.86} height=${height} />`;
        })}
        <line x1=${at} x2=${at} y1="0" y2="30" />
      </svg>
      <p class="hint">${t.view.timeOf(t.format.duration(times[layer] ?? 0), t.format.duration(reached))}</p>
    </section>`;
  }

  #jump = (event: MouseEvent): void => {
    const box = (event.currentTarget as Element).getBoundingClientRect();
    const total = this.state.result?.gcode.layers.length ?? 0;
    this.session?.showLayer(Math.floor(((event.clientX - box.left) / box.width) * total));
  };
}

/** The times, added up to bars of as many layers each. */
function barsOf(times: readonly number[]): number[] {
  const layers = Math.ceil(times.length / MOST_BARS);
  return Array.from({ length: Math.ceil(times.length / layers) }, (_, k) =>
    times.slice(k * layers, (k + 1) * layers).reduce((sum, time) => sum + time, 0),
  );
}

function scaleOf(by: Exclude<ColourBy, 'role' | 'tool'>, [low, high]: readonly [number, number]): TemplateResult {
  const stops = Array.from({ length: 9 }, (_, k) => scaleColour(k / 8)).join(', ');
  return html`<div class="colour-scale">
    <span>${t.format.number(low, 2)}</span>
    <i .style=${`background:linear-gradient(to right, ${stops})`} aria-hidden="true"></i>
    <span>${t.format.number(high, 2)} ${t.view.units[by]}</span>
  </div>`;
}

customElements.define('preview-step', PreviewStep);
