// Learn: each method step by step on the open part, each step a picture with two sentences.
import { html, nothing, type TemplateResult } from 'lit';
import settingsSchema from '../../../schema/settings.schema.json';
import type { Fact } from '../i18n/panels/en.ts';
import { t } from '../i18n/text.ts';
import { addressOf, type Knob, knobs, lessons, type Place, withoutPlace } from '../lesson/steps.ts';
import { extentOf } from '../parts.ts';
import { withChange } from '../settings/changes.ts';
import { type Field, groupsOf, type Schema } from '../settings/fields.ts';
import { lastPart, namedModel, SAMPLE } from '../source.ts';
import type { Lesson, LessonStep } from '../studies.ts';
import { Asked, numberOf } from './asked.ts';
import { drawing } from './drawing.ts';
import { problemBox } from './problem-box.ts';
import { StepPart } from './step-part.ts';

const fields: ReadonlyMap<string, Field> = new Map(
  groupsOf(settingsSchema as Schema).flatMap((group) => group.fields.map((field) => [field.path, field])),
);

/** The model that a link to this page opens. */
const linkedModel = (): string => lastPart(namedModel(location.href) ?? SAMPLE);

interface StepWords {
  readonly title: string;
  text(fact: Fact): string;
}

export class LearnStep extends StepPart {
  static override properties = { ...StepPart.properties, copied: { state: true }, width: { state: true } };
  declare copied: boolean;
  /** Room for the picture, CSS px. */
  declare width: number;
  readonly #asked = new Asked<readonly LessonStep[]>(this);
  readonly #room = new ResizeObserver(([entry]) => {
    // Coarse, so that not every pixel of a resized window asks anew.
    if (entry !== undefined) this.width = Math.max(240, Math.ceil(entry.contentRect.width / 80) * 80);
  });

  constructor() {
    super();
    this.copied = false;
    this.width = 640;
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.#room.disconnect();
    if (this.state.frame === 'page') history.replaceState(history.state, '', withoutPlace(location.href));
  }

  protected override willUpdate(): void {
    const { model, parts, changes, dark, place } = this.state;
    const { session, width } = this;
    if (session === undefined) return;
    const { lesson, at } = place;
    const side = Math.min(width, 760);
    const key =
      model.kind === 'open'
        ? `${numberOf(model)} ${numberOf(parts)} ${lesson} ${at} ${side} ${dark} ${JSON.stringify(changes)}`
        : undefined;
    this.#asked.want(key, () => session.lesson(lesson, at, side, dark));
  }

  protected override updated(): void {
    const stage = this.querySelector('.lesson-pictures');
    if (stage !== null) this.#room.observe(stage);
    const { place, changes, frame } = this.state;
    // Another site's address is its own.
    if (frame !== 'page') return;
    const address = addressOf(location.href, place, changes);
    if (address !== location.href) history.replaceState(history.state, '', address);
  }

  protected override render(): TemplateResult {
    const { model, place } = this.state;
    const words = t.panels.learn;
    const { answer, problem, waiting } = this.#asked;
    return html`
      <section class="card lesson-words" aria-labelledby="learn-heading">
        <h2 id="learn-heading">${words.heading}</h2>
        <div class="lessons" role="group" aria-labelledby="learn-heading">
          ${lessons.map(
            (it) => html`<button type="button" aria-pressed=${it === place.lesson} @click=${() => this.#learn(it)}>
              ${words.lessons[it]}
            </button>`,
          )}
        </div>
        ${model.kind === 'open' ? nothing : html`<p class="hint">${words.noModel}</p>`}
        ${problem === undefined ? nothing : problemBox(problem)}
        ${answer === undefined ? nothing : this.#steps(answer)} ${this.#change()}
      </section>
      <section class="card lesson-stage" aria-label=${words.lessons[place.lesson]} aria-busy=${waiting}>
        ${answer === undefined ? nothing : this.#shown(answer)}
        <div class="lesson-pictures">${answer === undefined ? html`<p class="hint">${waiting ? t.panels.waiting : ''}</p>` : this.#pictures(answer)}</div>
      </section>
    `;
  }

  #steps(steps: readonly LessonStep[]): TemplateResult {
    const now = this.#current(steps);
    return html`<ol class="lesson-steps" aria-label=${t.panels.learn.steps}>
      ${steps.map(
        ({ id }, index) => html`<li>
          <button type="button" aria-current=${index === now ? 'step' : 'false'} @click=${() => this.#go({ step: index })}>
            ${this.#words(id)?.title ?? id}
          </button>
        </li>`,
      )}
    </ol>`;
  }

  /** Title, sentences, and the way to the next step. */
  #shown(steps: readonly LessonStep[]): TemplateResult | typeof nothing {
    const now = this.#current(steps);
    const step = steps[now];
    const said = step && this.#words(step.id);
    if (step === undefined || said === undefined) return nothing;
    const words = t.panels.learn;
    const fact: Fact = (name, digits = 0) => t.format.number(step.facts[name] ?? 0, digits);
    return html`
      <div class="row">
        <h3 class="grow">${said.title}</h3>
        <span class="hint">${words.of(now + 1, steps.length)}</span>
        <button type="button" class="button" ?disabled=${now === 0} @click=${() => this.#go({ step: now - 1 })}>${words.previous}</button>
        <button type="button" class="button primary" ?disabled=${now === steps.length - 1} @click=${() => this.#go({ step: now + 1 })}>
          ${words.next}
        </button>
      </div>
      <p class="lesson-text" data-step=${step.id} data-facts=${JSON.stringify(step.facts)} aria-live="polite">
        ${said.text(fact)}
      </p>
    `;
  }

  #pictures(steps: readonly LessonStep[]): TemplateResult {
    const step = steps[this.#current(steps)];
    const title = step === undefined ? '' : (this.#words(step.id)?.title ?? step.id);
    const words = t.panels.learn;
    const captions = { compare: [words.paper, words.ours], crossing: [words.sheets, words.layer] }[step?.id ?? ''];
    return html`${(step?.svgs ?? []).map((svg, index) => {
      const caption = captions?.[index];
      return html`<figure>
        ${drawing(svg, caption === undefined ? title : `${title}: ${caption}`)}
        ${caption === undefined ? nothing : html`<figcaption>${caption}</figcaption>`}
      </figure>`;
    })}`;
  }

  #change(): TemplateResult {
    const { place } = this.state;
    const words = t.panels.learn;
    return html`
      <h3>${words.change}</h3>
      <div class="knobs">
        ${this.#where()} ${knobs[place.lesson].map((knob) => this.#knob(knob))}
      </div>
      ${this.state.frame === 'page' ? this.#link() : nothing}
      <p class="hint source">${words.source[place.lesson]}</p>
    `;
  }

  #link(): TemplateResult {
    const { model } = this.state;
    const words = t.panels.learn;
    return html`
      <div class="row">
        <button type="button" class="button" @click=${() => void this.#copy()}>${words.link}</button>
        ${this.copied ? html`<span class="hint" role="status">${words.copied}</span>` : nothing}
      </div>
      ${model.kind === 'open' && model.source.name !== linkedModel() ? html`<p class="hint">${words.ownModel}</p>` : nothing}
    `;
  }

  #knob({ path, low, high, step }: Knob): TemplateResult | typeof nothing {
    const field = fields.get(path);
    if (field?.kind !== 'number') return nothing;
    const value = Number(this.state.changes[path] ?? field.default);
    return this.#slider(
      field.label,
      `${t.format.number(value, 2)} ${t.settings.unit(field.unit)}`,
      { low, high, step, value },
      (to) => this.store?.update({ changes: withChange(this.state.changes, field, to) }),
    );
  }

  /** The plane, or the layer, that is looked at. */
  #where(): TemplateResult | typeof nothing {
    const { place, parts, changes } = this.state;
    const words = t.panels.learn;
    const box = extentOf(parts);
    if (box === undefined) return nothing;
    if (place.lesson === 'plates') {
      const [low = 0, high = 1] = [box[1], box[4]];
      const value = Number(/^y=(.+)$/.exec(place.at)?.[1] ?? (low + high) / 2);
      const range = { low: low + 0.1, high: high - 0.1, step: 0.1, value };
      return this.#slider(words.plane, `y = ${t.format.number(value, 1)} mm`, range, (to) =>
        this.#go({ at: `y=${to}` }),
      );
    }
    if (place.lesson === 'features') {
      const height = Number(changes['layers.height'] ?? 0.2);
      const count = Math.max(2, Math.round((box[5] ?? 0) / height));
      const shown = this.#asked.answer?.[0]?.facts['layer'];
      const value = place.at === '' ? (shown ?? 1) : Number(place.at);
      const range = { low: 1, high: count - 1, step: 1, value };
      return this.#slider(words.layerBelow, t.format.number(value, 0), range, (to) => this.#go({ at: String(to) }));
    }
    return nothing;
  }

  #slider(
    label: string,
    shown: string,
    { low, high, step, value }: { low: number; high: number; step: number; value: number },
    change: (to: number) => void,
  ): TemplateResult {
    return html`<label class="knob">
      <span>${label}</span><span class="knob-value" aria-hidden="true">${shown}</span>
      <input
        type="range"
        min=${low}
        max=${high}
        step=${step}
        aria-label=${label}
        aria-valuetext=${shown}
        .value=${String(value)}
        @input=${({ target }: Event) => change(Number((target as HTMLInputElement).value))}
      />
    </label>`;
  }

  #words(id: string): StepWords | undefined {
    const words: Readonly<Record<string, StepWords>> = t.panels.learn[this.state.place.lesson];
    return words[id];
  }

  #current(steps: readonly LessonStep[]): number {
    return Math.min(this.state.place.step, Math.max(0, steps.length - 1));
  }

  #learn(lesson: Lesson): void {
    this.#go({ lesson, step: 0, at: '' });
  }

  #go(change: Partial<Place>): void {
    this.copied = false;
    this.store?.update({ place: { ...this.state.place, ...change } });
  }

  async #copy(): Promise<void> {
    await navigator.clipboard.writeText(location.href);
    this.copied = true;
  }
}

customElements.define('learn-step', LearnStep);
