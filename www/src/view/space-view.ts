// The view in space: the parts on the bed, or the beads of the sliced job. Pointers and keys -> camera -> stage.
import { html, nothing, type TemplateResult } from 'lit';
import { t } from '../i18n/text.ts';
import type { Moves, PictureView } from '../messages.ts';
import { middleOf, type Part, type Room } from '../parts.ts';
import { layersOf } from '../slicer/gcode.ts';
import type { ModelState, Remark, Result } from '../state.ts';
import type { Sheet } from '../studies.ts';
import { Part as Element } from '../ui/part.ts';
import type { Size, Spot } from './camera.ts';
import { type ColourBy, extent, indices, insideRoles, palette, type RoleColour } from './colours.ts';
import { fittedBetween, type Orbit, type Point, panned, sides, turned, zoomed } from './orbit.ts';
import { isBroken, type Painter } from './painter.ts';
import type { Stage } from './stage.ts';

/** Layers whose G-code is read at a time. */
const BATCH_LAYERS = 24;
/** Work on the picture at a time, ms; the rest of a frame is the browser's. */
const FRAME = 8;
/** Pixels that a key press turns the picture. */
const KEY_TURN = 24;
const KEY_ZOOM = 1.25;
/** Zoom per pixel of wheel travel. */
const WHEEL_ZOOM = 0.0018;
/** Models of more triangles are drawn as boxes: they would take the memory that slicing needs. */
const MOST_DRAWN = 6_000_000;
/** What an engine did not answer (a job was cancelled, the engine broke) is asked for again, but not for ever. */
const MOST_TRIES = 3;
/** What the buttons above and the slider of moves below cover of the picture, px. */
const COVERED = [50, 62] as const;
/** A pointer that moved less, px, was a click. */
const CLICK = 4;

/** A place on a part that something is said about. */
export interface Marker {
  readonly at: Point;
  readonly text: string;
}

/** What the pointer does: nothing yet, turn, move the picture, or move a part. */
type Drag = { readonly from: Spot; at: Spot; readonly part?: Part; readonly grip?: Point; readonly pan: boolean };

/**
 * Sends `select` (number or undefined), `move-part` ({id, x, y}: its middle), `face` ({id, triangle}) when a face
 * is asked for, `measured` (mm), `layer-step`, `range` (low and high end of the colours), `no-space` when
 * there is no WebGL.
 */
export class SpaceView extends Element {
  static override properties = {
    painter: { attribute: false },
    show: { attribute: false },
    side: { attribute: false },
    model: { attribute: false },
    parts: { attribute: false },
    selected: { attribute: false },
    room: { attribute: false },
    dark: { attribute: false },
    result: { attribute: false },
    layer: { attribute: false },
    moves: { attribute: false },
    colourBy: { attribute: false },
    leftOut: { attribute: false },
    roles: { attribute: false },
    tool: { attribute: false },
    markers: { attribute: false },
    label: { attribute: false },
    sheets: { attribute: false },
    spots: { state: true },
  };
  declare painter: Painter | undefined;
  declare show: 'parts' | 'beads';
  declare side: PictureView;
  declare model: ModelState;
  declare parts: readonly Part[];
  declare selected: number | undefined;
  declare room: Room;
  declare dark: boolean;
  declare result: Result | undefined;
  declare layer: number;
  /** Moves of the layer that are shown. */
  declare moves: number;
  declare colourBy: ColourBy;
  /** Roles that are not shown. */
  declare leftOut: ReadonlySet<string>;
  declare roles: readonly RoleColour[];
  /** What a click means. */
  declare tool: 'select' | 'flat' | 'measure';
  declare markers: readonly Marker[];
  declare label: string;
  /** Plates of supports, shown with the parts. */
  declare sheets: readonly Sheet[];
  declare spots: readonly (Spot | undefined)[];

  #stage: Stage | undefined;
  #size: Size = { width: 1, height: 1 };
  #orbit: Orbit | undefined;
  #drag: Drag | undefined;
  readonly #pointers = new Map<number, Spot>();
  #batches: Moves[] = [];
  /** What the stage shows, so that only changes are told to it. */
  /** Where the parts were when the bed changed; the picture follows them once. */
  #leaving: readonly Part[] | undefined;
  #told: Partial<
    Record<'models' | 'result' | 'side' | 'colours' | 'palette' | 'bed' | 'room' | 'opened' | 'seen', unknown>
  > = {};
  #measured: Point | undefined;
  /** Parts when they were shown last: the camera looks at all of them when there are more. */
  #count = 0;
  #reading = 0;
  /** Models whose triangles are on their way, and how often they were asked for. */
  readonly #loading = new Set<number>();
  readonly #tries = new Map<number, number>();

  constructor() {
    super();
    this.painter = undefined;
    this.show = 'parts';
    this.side = 'iso';
    this.model = { kind: 'none' };
    this.parts = [];
    this.selected = undefined;
    this.room = [220, 220, 250, 0, 0, false];
    this.dark = false;
    this.result = undefined;
    this.layer = 0;
    this.moves = Number.POSITIVE_INFINITY;
    this.colourBy = 'role';
    this.leftOut = new Set();
    this.roles = [];
    this.tool = 'select';
    this.markers = [];
    this.label = '';
    this.sheets = [];
    this.spots = [];
  }

  protected override render(): TemplateResult {
    return html`<div
      class="stage space ${this.tool}"
      tabindex="0"
      role="application"
      aria-label=${t.view.space}
      @pointerdown=${this.#down}
      @pointermove=${this.#move}
      @pointerup=${this.#up}
      @pointercancel=${this.#leave}
      @dblclick=${() => this.#fit()}
      @contextmenu=${(event: Event) => event.preventDefault()}
      @keydown=${this.#key}
    >
      <canvas class="space-canvas" role="img" aria-label=${this.label}></canvas>
      ${this.markers.map((marker, k) => this.#marker(marker, this.spots[k]))}
      <div class="zoom-buttons">
        ${button(t.view.zoomIn, '+', () => this.#turn((orbit) => zoomed(orbit, KEY_ZOOM)))}
        ${button(t.view.zoomOut, '−', () => this.#turn((orbit) => zoomed(orbit, 1 / KEY_ZOOM)))}
        ${button(t.view.fit, '⤢', () => this.#fit())}
      </div>
    </div>`;
  }

  #marker({ text }: Marker, spot: Spot | undefined): TemplateResult | typeof nothing {
    if (spot === undefined) return nothing;
    return html`<span class="marker" .style=${`left:${spot.x}px;top:${spot.y}px`} title=${text} role="img" aria-label=${text}>!</span>`;
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    // An element that is only moved in its page is there again at once.
    queueMicrotask(() => {
      if (this.isConnected) return;
      this.#stage?.dispose();
      this.#stage = undefined;
    });
  }

  protected override firstUpdated(): void {
    const stage = this.querySelector<HTMLElement>('.stage');
    const canvas = this.querySelector('canvas');
    if (stage === null || canvas === null) return;
    stage.addEventListener('wheel', this.#wheel, { passive: false });
    new ResizeObserver(([entry]) => {
      if (entry === undefined) return;
      this.#size = { width: entry.contentRect.width, height: entry.contentRect.height };
      if (this.#size.width > 0) this.#stage?.resize(this.#size, devicePixelRatio);
      this.requestUpdate();
    }).observe(stage);
    void this.#start(canvas);
  }

  async #start(canvas: HTMLCanvasElement): Promise<void> {
    try {
      const { Stage } = await import('./stage.ts');
      if (!this.isConnected) return;
      this.#stage = new Stage(canvas, () => this.tell('no-space'));
      this.#stage.resize(this.#size, devicePixelRatio);
      this.requestUpdate();
    } catch {
      this.tell('no-space');
    }
  }

  protected override updated(): void {
    const stage = this.#stage;
    if (stage === undefined || this.#size.width === 0) return;
    this.#dress(stage);
    this.#showParts(stage);
    this.#showBeads(stage);
    stage.turnTo(this.show);
    this.#aim(stage);
    this.#placeMarkers(stage);
  }

  #dress(stage: Stage): void {
    const bed = `${this.room} ${this.dark}`;
    if (this.#told.bed === bed) return;
    this.#told.bed = bed;
    stage.dress(this.room, this.dark);
    const before = this.#told.room;
    this.#told.room = String(this.room);
    if (before === undefined || before === this.#told.room) return;
    this.#orbit = undefined;
    // The parts move to the middle of the new bed in a moment.
    this.#leaving = this.parts;
  }

  /** An opened file stands where it says, not where the parts are. */
  #opened(): Result | undefined {
    const { result } = this;
    return this.show === 'beads' && result !== undefined && result.sliced === undefined ? result : undefined;
  }

  #showParts(stage: Stage): void {
    const models = this.model.kind === 'open' ? this.model.models : [];
    const first = models[0];
    if (this.#told.models !== first) {
      this.#told.models = first;
      this.#tries.clear();
      stage.forget();
      this.#orbit = undefined;
    }
    const arrived = this.#leaving !== undefined && this.#leaving !== this.parts;
    if (arrived) this.#leaving = undefined;
    if (arrived || this.parts.length > this.#count) this.#orbit = undefined;
    this.#count = this.parts.length;
    for (const model of new Set(this.parts.map((it) => it.model))) {
      const triangles = models[model]?.facts.triangles ?? 0;
      const tried = this.#tries.get(model) ?? 0;
      if (stage.hasShape(model) || triangles > MOST_DRAWN || tried >= MOST_TRIES) continue;
      if (first !== undefined) void this.#load(stage, model, first);
    }
    stage.showParts(this.parts, this.selected, this.room);
    stage.showSheets(this.sheets);
  }

  async #load(stage: Stage, model: number, first: unknown): Promise<void> {
    if (this.#loading.has(model)) return;
    this.#loading.add(model);
    this.#tries.set(model, (this.#tries.get(model) ?? 0) + 1);
    try {
      const shape = await this.painter?.shape(model);
      if (shape !== undefined && this.#told.models === first) stage.addShape(model, shape);
    } catch {
      // A cancelled job ended the lead; the next update asks the new one.
    } finally {
      this.#loading.delete(model);
      this.requestUpdate();
    }
  }

  #showBeads(stage: Stage): void {
    const { result } = this;
    if (this.#told.result !== result) {
      this.#told.result = result;
      this.#batches = [];
      stage.clearBeads();
      this.#told.colours = undefined;
    }
    if (this.show !== 'beads' || result === undefined) return;
    if (this.#batches.length === 0 && this.#reading === 0) void this.#read(stage, result);
    this.#colour(stage);
    stage.showBeads(this.layer, this.moves);
  }

  /** Reads the layers' moves, some at a time; what is read is shown at once. */
  async #read(stage: Stage, result: Result): Promise<void> {
    this.#reading++;
    try {
      const total = result.gcode.layers.length;
      for (let first = 0; first < total && this.#told.result === result; first += BATCH_LAYERS) {
        const moves = await this.#moves(result, first, Math.min(first + BATCH_LAYERS, total));
        if (moves === undefined || this.#told.result !== result) break;
        this.#batches.push(moves);
        stage.addBeads(moves, indices(this.colourBy, moves, this.#range()));
        stage.showBeads(this.layer, this.moves);
      }
    } catch {
      this.tell('no-space');
    } finally {
      this.#reading--;
      this.#told.colours = undefined;
      this.requestUpdate();
    }
  }

  /** The moves of some layers; a view lane that breaks is replaced. */
  async #moves({ gcode, settings }: Result, first: number, last: number): Promise<Moves | undefined> {
    for (let tries = 1; ; tries++) {
      try {
        return await this.painter?.moves({ text: layersOf(gcode, first, last), settings });
      } catch (error) {
        if (!isBroken(error) || tries === MOST_TRIES) throw error;
      }
    }
  }

  #range(): readonly [number, number] | undefined {
    return extent(this.colourBy, this.#batches);
  }

  #colour(stage: Stage): void {
    const palettes = `${this.colourBy} ${[...this.leftOut]} ${this.roles.length}`;
    if (this.#told.palette !== palettes) {
      this.#told.palette = palettes;
      stage.paintBeads(palette(this.colourBy, this.roles, this.leftOut), insideRoles(this.roles));
    }
    const colours = `${this.colourBy} ${this.#reading}`;
    if (this.#told.colours === colours) return;
    this.#told.colours = colours;
    void this.#recolour(stage, colours);
    this.tell('range', this.#range());
    this.tell('layer-moves', this.#layerMoves());
  }

  /** Colours all batches, as many in a frame as do not hold up the page. */
  async #recolour(stage: Stage, colours: string): Promise<void> {
    const [by, range] = [this.colourBy, this.#range()];
    let began = performance.now();
    for (const [k, moves] of [...this.#batches].entries()) {
      stage.colourBeads(k, indices(by, moves, range));
      if (performance.now() - began < FRAME) continue;
      await new Promise(requestAnimationFrame);
      if (this.#told.colours !== colours) return;
      began = performance.now();
    }
  }

  /** Moves in each layer. */
  #layerMoves(): number[] {
    return this.#batches.flatMap(({ layers }) => [...layers].map((end, k) => end - (layers[k - 1] ?? 0)));
  }

  #aim(stage: Stage): void {
    const opened = this.#opened();
    if (this.#told.opened !== opened) {
      this.#told.opened = opened;
      this.#orbit = undefined;
    }
    if (this.#told.side !== this.side) {
      this.#told.side = this.side;
      this.#orbit = undefined;
    }
    this.#orbit ??= fittedBetween(this.#seen(), sides[this.side], this.#size, COVERED);
    stage.look(this.#orbit);
  }

  /** The box that the picture shows at first: the parts, or the bed when there are none. */
  #seen(): readonly number[] {
    const opened = this.#opened();
    if (opened !== undefined) return opened.report.model.bounds.flat();
    const [width, depth, , x, y] = this.room;
    if (this.parts.length === 0) return [x, y, 0, x + width, y + depth, 1];
    const pick = (k: number, best: (...values: number[]) => number): number =>
      best(...this.parts.map(({ box }) => box[k] ?? 0));
    return [0, 1, 2].map((k) => pick(k, Math.min)).concat([3, 4, 5].map((k) => pick(k, Math.max)));
  }

  #placeMarkers(stage: Stage): void {
    const spots = this.markers.map(({ at }) => stage.spotOf(at));
    if (JSON.stringify(spots) !== JSON.stringify(this.spots)) this.spots = spots;
  }

  #turn(change: (orbit: Orbit) => Orbit): void {
    if (this.#orbit === undefined || this.#stage === undefined) return;
    this.#orbit = change(this.#orbit);
    this.#stage.look(this.#orbit);
    if (this.markers.length > 0) this.#placeMarkers(this.#stage);
  }

  #fit(): void {
    this.#orbit = undefined;
    this.requestUpdate();
  }

  #down = (event: PointerEvent): void => {
    if ((event.target as HTMLElement).closest('button') !== null) return;
    const at = this.#spot(event);
    (event.currentTarget as HTMLElement).setPointerCapture(event.pointerId);
    this.#pointers.set(event.pointerId, at);
    const hit = this.show === 'parts' && event.button === 0 ? this.#stage?.pick(at) : undefined;
    const part = this.parts.find(({ id }) => id === hit?.part && id === this.selected && this.tool === 'select');
    const pan = event.button !== 0 || event.shiftKey;
    this.#drag = { from: at, at, pan, ...(part && hit ? { part, grip: hit.at } : {}) };
  };

  #move = (event: PointerEvent): void => {
    const before = this.#pointers.get(event.pointerId);
    if (before === undefined || this.#drag === undefined) return;
    const now = this.#spot(event);
    const other = [...this.#pointers].find(([id]) => id !== event.pointerId)?.[1];
    this.#pointers.set(event.pointerId, now);
    const [right, down] = [now.x - before.x, now.y - before.y];
    this.#drag.at = now;
    if (other !== undefined) {
      const gap = (spot: Spot): number => Math.max(Math.hypot(spot.x - other.x, spot.y - other.y), 1);
      this.#turn((orbit) => panned(zoomed(orbit, gap(now) / gap(before)), right / 2, down / 2, this.#size.height));
    } else if (this.#drag.part !== undefined) {
      this.#shift(this.#drag);
    } else if (this.#drag.pan) {
      this.#turn((orbit) => panned(orbit, right, down, this.#size.height));
    } else {
      this.#turn((orbit) => turned(orbit, right, down));
    }
  };

  #up = (event: PointerEvent): void => {
    const drag = this.#drag;
    this.#leave(event);
    if (drag === undefined) return;
    if (Math.hypot(drag.at.x - drag.from.x, drag.at.y - drag.from.y) < CLICK) {
      if (event.button === 0) this.#click(drag.at);
      return;
    }
    const by = drag.part && this.#shiftOf(drag);
    if (drag.part === undefined || by === undefined) return;
    const [x, y] = middleOf(drag.part);
    this.tell('move-part', { id: drag.part.id, x: x + by[0], y: y + by[1] });
  };

  #leave = (event: PointerEvent): void => {
    this.#pointers.delete(event.pointerId);
    this.#drag = undefined;
  };

  /** How far a drag moves its part, mm. */
  #shiftOf({ at, grip }: Drag): readonly [number, number] | undefined {
    const to = grip && this.#stage?.onPlane(at, grip[2]);
    return to && grip && [to[0] - grip[0], to[1] - grip[1]];
  }

  #shift(drag: Drag): void {
    const by = this.#shiftOf(drag);
    if (by !== undefined && drag.part !== undefined) {
      this.#stage?.shift(drag.part.id, by[0], by[1]);
    }
  }

  #click(spot: Spot): void {
    if (this.tool === 'measure') this.#measure(spot);
    else if (this.show === 'parts') this.#choose(spot);
  }

  #choose(spot: Spot): void {
    const hit = this.#stage?.pick(spot);
    if (this.tool === 'flat' && hit !== undefined && hit.triangle >= 0) {
      this.tell('face', { id: hit.part, triangle: hit.triangle });
    } else {
      this.tell('select', hit?.part);
    }
  }

  /** The first click sets the ruler's start, the second its end. */
  #measure(spot: Spot): void {
    const z = this.show === 'beads' ? this.#heightShown() : 0;
    const at = (this.show === 'parts' ? this.#stage?.pick(spot)?.at : undefined) ?? this.#stage?.onPlane(spot, z);
    if (at === undefined) return;
    const from = this.#measured;
    this.#measured = from === undefined ? at : undefined;
    this.#stage?.measure(from, at);
    this.tell('measured', from && Math.hypot(at[0] - from[0], at[1] - from[1], at[2] - from[2]));
  }

  /** Height of the layer shown, mm. */
  #heightShown(): number {
    let first = 0;
    for (const { layers, ends } of this.#batches) {
      const inside = this.layer - first;
      if (inside < layers.length) return ends[6 * ((layers[inside] ?? 1) - 1) + 5] ?? 0;
      first += layers.length;
    }
    return 0;
  }

  #wheel = (event: WheelEvent): void => {
    event.preventDefault();
    this.#turn((orbit) => zoomed(orbit, Math.exp(-WHEEL_ZOOM * event.deltaY * (event.deltaMode === 1 ? 33 : 1))));
  };

  #key = (event: KeyboardEvent): void => {
    if ((event.target as HTMLElement).closest('button') !== null || event.ctrlKey || event.metaKey || event.altKey)
      return;
    const act = this.#keyAct(event);
    if (act === undefined) return;
    event.preventDefault();
    act();
  };

  #keyAct({ key, shiftKey }: KeyboardEvent): (() => void) | undefined {
    const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[key];
    if (way !== undefined) {
      const [right = 0, down = 0] = way;
      const part = shiftKey && this.show === 'parts' ? this.parts.find(({ id }) => id === this.selected) : undefined;
      if (part === undefined) return () => this.#turn((orbit) => turned(orbit, right * KEY_TURN, down * KEY_TURN));
      const [x, y] = middleOf(part);
      return () => this.tell('move-part', { id: part.id, x: x + right, y: y - down });
    }
    const zoom = (factor: number) => () => this.#turn((orbit) => zoomed(orbit, factor));
    const table: Readonly<Record<string, () => void>> = {
      '+': zoom(KEY_ZOOM),
      '=': zoom(KEY_ZOOM),
      '-': zoom(1 / KEY_ZOOM),
      '0': () => this.#fit(),
      PageUp: () => this.tell('layer-step', 1),
      PageDown: () => this.tell('layer-step', -1),
      Delete: () => this.tell('remove-part'),
    };
    return table[key];
  }

  #spot(event: MouseEvent): Spot {
    const box = this.querySelector('.stage')?.getBoundingClientRect();
    return { x: event.clientX - (box?.left ?? 0), y: event.clientY - (box?.top ?? 0) };
  }
}

/** The remarks of a report that have a place. */
export function markersOf(remarks: readonly Remark[], heights: (layer: number) => number): Marker[] {
  return remarks.flatMap(({ message, layer, at }) => {
    const [x, y] = at ?? [];
    return x === undefined || y === undefined ? [] : [{ at: [x, y, heights(layer ?? 0)] as const, text: message }];
  });
}

function button(label: string, sign: string, act: () => void): TemplateResult {
  return html`<button type="button" class="icon-button" aria-label=${label} title=${label} @click=${act}>
    <span aria-hidden="true">${sign}</span>
  </button>`;
}

customElements.define('space-view', SpaceView);
