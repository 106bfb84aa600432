// Temperatures: as they are, what they shall be, and how they went.
import { html, nothing, svg, type TemplateResult } from 'lit';
import { t } from '../i18n/text.ts';
import { hasJob } from '../printer/link.ts';
import type { Temperatures } from '../printer/messages.ts';
import type { Sample } from '../printer/print-state.ts';
import { PrintPart } from './print-part.ts';

/** Size of the drawing; it is stretched to the width that there is. */
const [WIDTH, HEIGHT] = [320, 110];

/** Time that the chart covers at least and at most, ms. */
const [SHORTEST, LONGEST] = [2 * 60_000, 10 * 60_000];

type Reading = Temperatures['tools'][number];

interface Heater {
  readonly name: string;
  readonly color: string;
  of(temperatures: Temperatures): Reading | undefined;
}

export class TemperatureChart extends PrintPart {
  static override properties = { ...PrintPart.properties, nozzle: { type: Number }, bed: { type: Number } };
  /** What preheating heats to, degrees Celsius. */
  declare nozzle: number;
  declare bed: number;

  constructor() {
    super();
    this.nozzle = 0;
    this.bed = 0;
  }

  protected override render(): TemplateResult {
    const { samples, printer } = this.print;
    const last = samples.at(-1);
    return html`<section class="card" aria-label=${t.printing.temperature.heading}>
      <h2>${t.printing.temperature.heading}</h2>
      ${last === undefined ? html`<p class="hint">${t.printing.temperature.none}</p>` : this.#readings(last, samples)}
      ${hasJob(printer) ? nothing : this.#preheat(printer === 'ready')}
    </section>`;
  }

  #readings({ temperatures }: Sample, samples: readonly Sample[]): TemplateResult {
    const heaters = heatersOf(temperatures);
    const words = t.printing.temperature;
    return html`
      ${chart(heaters, samples)}
      <table class="legend">
        <caption class="unseen">${words.heading}</caption>
        <thead><tr><th scope="col">${words.heater}</th><th scope="col">${words.now}</th><th scope="col">${words.target}</th></tr></thead>
        <tbody>
          ${heaters.map((heater) => {
            const reading = heater.of(temperatures);
            return html`<tr>
              <th scope="row"><span class="swatch" .style=${`background:${heater.color}`}></span>${heater.name}</th>
              <td>${degrees(reading?.now)}</td>
              <td>${reading?.target === 0 ? words.off : degrees(reading?.target)}</td>
            </tr>`;
          })}
        </tbody>
      </table>
    `;
  }

  #preheat(ready: boolean): TemplateResult {
    const { nozzle, bed } = this;
    const words = t.printing.temperature;
    const send = (lines: readonly string[]): void => {
      if (ready) this.printing?.send(lines);
    };
    return html`<div class="row buttons">
      <button
        type="button"
        class="button"
        aria-disabled=${!ready}
        @click=${() => send([`M140 S${bed}`, `M104 S${nozzle}`])}
      >
        ${words.preheat(t.format.number(nozzle, 0), t.format.number(bed, 0))}
      </button>
      <button type="button" class="button" aria-disabled=${!ready} @click=${() => send(['M104 S0', 'M140 S0'])}>
        ${words.cool}
      </button>
    </div>`;
  }
}

/** The heaters that the printer tells of. */
function heatersOf({ tools, bed, chamber }: Temperatures): Heater[] {
  const words = t.printing.temperature;
  const nozzles = tools.map((_, k) => ({
    name: tools.length === 1 ? words.nozzle : `${words.nozzle} ${k + 1}`,
    color: `var(--heat-${1 + (k % 2) * 3})`,
    of: (it: Temperatures) => it.tools[k],
  }));
  const isThere = (reading: Reading | null | undefined): boolean => reading !== null && reading !== undefined;
  return [
    ...nozzles,
    ...(isThere(bed)
      ? [{ name: words.bed, color: 'var(--heat-2)', of: (it: Temperatures) => it.bed ?? undefined }]
      : []),
    ...(isThere(chamber)
      ? [{ name: words.chamber, color: 'var(--heat-3)', of: (it: Temperatures) => it.chamber ?? undefined }]
      : []),
  ];
}

/** The picture; its figures stand in the table below. */
function chart(heaters: readonly Heater[], samples: readonly Sample[]): TemplateResult {
  const end = samples.at(-1)?.at ?? 0;
  const span = Math.min(Math.max(end - (samples[0]?.at ?? end), SHORTEST), LONGEST);
  const shown = samples.filter(({ at }) => end - at <= span);
  const values = heaters.flatMap((it) => shown.map(({ temperatures }) => it.of(temperatures)));
  const most = Math.max(60, ...values.map((it) => Math.max(it?.now ?? 0, it?.target ?? 0)));
  const top = 50 * Math.ceil((most + 10) / 50);
  const x = (at: number): string => (WIDTH * (1 - (end - at) / span)).toFixed(1);
  const y = (value: number): string => (HEIGHT * (1 - value / top)).toFixed(1);
  const line = (read: (it: Temperatures) => number | null | undefined): string =>
    shown
      .flatMap(({ at, temperatures }) => {
        const value = read(temperatures);
        return typeof value === 'number' ? [`${x(at)},${y(value)}`] : [];
      })
      .join(' ');
  const minutes = Math.round(span / 60_000);
  return html`<svg
    class="heat-chart"
    viewBox="0 0 ${WIDTH} ${HEIGHT}"
    preserveAspectRatio="none"
    role="img"
    aria-label=${t.printing.temperature.chart(minutes)}
  >
    ${[0, top / 2].map((value) => svg`<line class="grid" x1="0" x2=${WIDTH} y1=${y(value)} y2=${y(value)} />`)}
    ${heaters.map(
      (it) => svg`
        <polyline class="wanted" .style=${`stroke:${it.color}`} points=${line((now) => it.of(now)?.target)} />
        <polyline .style=${`stroke:${it.color}`} points=${line((now) => it.of(now)?.now)} />`,
    )}
  </svg>
  <p class="hint heat-axis" aria-hidden="true"><span>0–${top} °C</span><span>${t.printing.temperature.span(minutes)}</span></p>`;
}

function degrees(value: number | null | undefined): string {
  return typeof value === 'number' ? `${t.format.number(value, 1)} °C` : '–';
}

customElements.define('temperature-chart', TemperatureChart);
