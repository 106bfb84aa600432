// The picture: one layer's paths, or the model on the bed. Events -> camera -> the engine paints.
import { html, nothing, type TemplateResult } from 'lit';
import { keyed } from 'lit/directives/keyed.js';
import { t } from '../i18n/text.ts';
import type { Bounds, LegendEntry, PictureView, Standing, Theme } from '../messages.ts';
import { Part } from '../ui/part.ts';
import { type Camera, fitTo, numbers, pan, type Size, type Spot, zoom } from './camera.ts';
import { listen } from './gestures.ts';
import { isBroken, type LayerText, type Painter } from './painter.ts';

/** A layer whose lane broke is tried again so often. */
const MOST_TRIES = 3;

/** What stands in the view: its bounds, and the camera once it was shown. */
interface Shown {
  readonly key: unknown;
  readonly bounds: Bounds;
}

/** Sends `legend` with the layer's legend, `layer-step` with a number of layers. */
export class LayerView extends Part {
  static override properties = {
    painter: { attribute: false },
    show: { attribute: false },
    side: { attribute: false },
    model: { attribute: false },
    standing: { attribute: false },
    layer: { attribute: false },
    job: { attribute: false },
    extent: { attribute: false },
    label: { attribute: false },
    dark: { attribute: false },
    lane: { state: true },
  };
  declare painter: Painter | undefined;
  declare show: 'model' | 'layers';
  declare side: PictureView;
  /** Changes when another model is open; undefined when none is. */
  declare model: unknown;
  /** How the parts stand that the model's picture shows. */
  declare standing: Standing | undefined;
  declare layer: LayerText | undefined;
  /** Changes when another job's layers are shown: the camera then starts anew. */
  declare job: unknown;
  /** What all layers together cover; the camera starts with it, so that it stands still from layer to layer. */
  declare extent: Bounds | undefined;
  declare label: string;
  declare dark: boolean;
  /** The view lane that the layer's canvas is for; 0 before one has it. */
  declare lane: number;

  readonly #cameras = new Map<unknown, Camera>();
  #size: Size = { width: 1, height: 1 };
  #pictured: (Shown & { side: PictureView }) | undefined;
  #layered: (Shown & { lane: number }) | undefined;
  /** The job whose layers the camera was set up for. */
  #job: unknown;
  /** How often in turn a lane broke. */
  #broken = 0;
  #drawing = false;
  #again = false;

  constructor() {
    super();
    this.painter = undefined;
    this.show = 'model';
    this.side = 'iso';
    this.model = undefined;
    this.standing = undefined;
    this.layer = undefined;
    this.job = undefined;
    this.extent = undefined;
    this.label = '';
    this.dark = false;
    this.lane = 0;
  }

  protected override render(): TemplateResult {
    return html`
      <div class="stage" tabindex="0" role="application" aria-label=${t.view.canvas}>
        ${keyed(
          this.lane,
          html`<canvas class="layer-canvas" role="img" aria-label=${this.label} ?hidden=${this.show !== 'layers'}></canvas>`,
        )}
        <canvas class="model-canvas" role="img" aria-label=${this.label} ?hidden=${this.show !== 'model'}></canvas>
        ${this.show === 'layers' && this.layer === undefined ? html`<p class="empty">${t.view.empty}</p>` : nothing}
        <div class="zoom-buttons">
          ${this.#button(t.view.zoomIn, '+', () => this.#zoom(1.25))}
          ${this.#button(t.view.zoomOut, '−', () => this.#zoom(0.8))}
          ${this.#button(t.view.fit, '⤢', () => this.#fit())}
        </div>
      </div>
    `;
  }

  protected override firstUpdated(): void {
    const stage = this.querySelector<HTMLElement>('.stage');
    if (stage === null) return;
    listen(stage, {
      pan: (right, down) => this.#move((camera) => pan(camera, right, down)),
      zoom: (factor, spot) => this.#zoom(factor, spot),
      fit: () => this.#fit(),
      step: (layers) => this.tell('layer-step', layers),
    });
    new ResizeObserver(([entry]) => {
      if (entry === undefined) return;
      this.#size = { width: entry.contentRect.width, height: entry.contentRect.height };
      this.#request();
    }).observe(stage);
  }

  protected override updated(): void {
    this.#request();
  }

  #button(label: string, sign: string, act: () => void): TemplateResult {
    return html`<button type="button" class="icon-button" aria-label=${label} title=${label} @click=${act}>
      <span aria-hidden="true">${sign}</span>
    </button>`;
  }

  #zoom(factor: number, spot?: Spot): void {
    const middle = { x: this.#size.width / 2, y: this.#size.height / 2 };
    this.#move((camera) => zoom(camera, factor, spot ?? middle, this.#size));
  }

  #fit(): void {
    this.#cameras.delete(this.#cameraKey());
    this.#request();
  }

  #move(change: (camera: Camera) => Camera): void {
    const camera = this.#cameras.get(this.#cameraKey());
    if (camera === undefined) return;
    this.#cameras.set(this.#cameraKey(), change(camera));
    this.#request();
  }

  /** Each side of the model and the layers have a camera of their own. */
  #cameraKey(): string {
    return this.show === 'layers' ? 'layers' : this.side;
  }

  /** Paints in the next frame; one picture is under way at a time, and only the latest wish counts. */
  #request(): void {
    if (this.#drawing) {
      this.#again = true;
      return;
    }
    this.#drawing = true;
    requestAnimationFrame(() => void this.#draw());
  }

  async #draw(): Promise<void> {
    try {
      if (this.painter !== undefined)
        await (this.show === 'layers' ? this.#drawLayer(this.painter) : this.#drawModel(this.painter));
      this.#broken = 0;
    } catch (error) {
      // A cancelled job ends the lead in the middle of a picture, an engine may break: the next frame asks the new one.
      if (isBroken(error) && ++this.#broken < MOST_TRIES) this.#again = true;
    } finally {
      this.#drawing = false;
      if (this.#again) {
        this.#again = false;
        this.#request();
      }
    }
  }

  async #drawLayer(painter: Painter): Promise<void> {
    const { layer, job } = this;
    if (layer === undefined) return;
    if (!this.hidden) await this.#adopt(painter);
    const { lanes } = painter;
    if (this.#layered?.key !== layer.text || this.#layered.lane !== lanes) {
      const { bounds, legend } = await painter.layer(layer);
      if (this.#job !== job) this.#cameras.delete('layers');
      this.#job = job;
      this.#layered = { key: layer.text, bounds, lane: lanes };
      this.tell<readonly LegendEntry[]>('legend', legend);
    }
    if (this.hidden) return;
    await painter.paintLayer(this.#view('layers', this.extent ?? this.#layered.bounds), this.#theme());
  }

  async #drawModel(painter: Painter): Promise<void> {
    const { model, side } = this;
    if (model === undefined) return;
    if (this.#pictured?.key !== model || this.#pictured.side !== side) {
      const bounds = await painter.picture(side, this.standing);
      if (this.#pictured?.key !== model) for (const it of ['iso', 'top', 'front']) this.#cameras.delete(it);
      this.#pictured = { key: model, bounds, side };
    }
    const bitmap = await painter.paintPicture(this.#view(side, this.#pictured.bounds), this.#theme());
    if (bitmap === undefined) {
      this.#pictured = undefined;
      this.#again = true;
      return;
    }
    this.querySelector<HTMLCanvasElement>('.model-canvas')
      ?.getContext('bitmaprenderer')
      ?.transferFromImageBitmap(bitmap);
  }

  #view(key: string, bounds: Bounds): ReturnType<typeof numbers> {
    const camera = this.#cameras.get(key) ?? fitTo(bounds, this.#size);
    this.#cameras.set(key, camera);
    return numbers(camera, this.#size, devicePixelRatio);
  }

  #theme(): Theme {
    return this.dark ? 'dark' : 'light';
  }

  /** Gives the lane a canvas; a new lane needs a new one. */
  async #adopt(painter: Painter): Promise<void> {
    if (this.lane === painter.lanes) return;
    this.lane = painter.lanes;
    await this.updateComplete;
    const canvas = this.querySelector<HTMLCanvasElement>('.layer-canvas');
    if (canvas !== null) await painter.adopt(canvas.transferControlToOffscreen());
  }
}

customElements.define('layer-view', LayerView);
