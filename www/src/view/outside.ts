// Which beads of some layers can be seen from outside, for devices that are too slow to draw all while the picture
// moves.
import type { Moves } from '../messages.ts';
import { type Detail, layersDrawnAs } from './pace.ts';

/** Layers that the coarsest detail draws as one. */
const MOST_LAYERS = 8;

/** Side of the squares of the bed, mm, in each of which a layer has a bead or none: about a line wide. */
const CELL = 0.5;

/** Squares of the bed at most; beyond, they are larger. */
const MOST_CELLS = 1_000_000;

/** The coarsest detail that shows layer `k` of a batch: the uppermost of eight layers stands for them all. */
export function coarsestWith(k: number): Detail {
  const place = (k % MOST_LAYERS) + 1;
  return place % 8 === 0 ? 4 : place % 4 === 0 ? 3 : place % 2 === 0 ? 2 : 1;
}

/** Roles, as moves count them, that are not seen from outside. */
export interface Inside {
  /** Seen only where nothing lies on them. */
  readonly covered: ReadonlySet<number>;
  /** Never seen. */
  readonly hidden: ReadonlySet<number>;
}

type Layers = Pick<Moves, 'ends' | 'sizes' | 'roles' | 'layers'>;

/**
 * Positions of the moves that can be seen from outside: four lists by the coarsest detail that shows them, and those
 * that lie on the bed (`onBed`: the first layer does), which stand for no layer but their own. `above` are the layers
 * that follow, if they are known.
 */
export function sharesOf(moves: Layers, inside: Inside, onBed: boolean, above?: Layers): Uint32Array[] {
  const shares: number[][] = [[], [], [], [], []];
  const cover = new Cover(moves);
  const count = moves.layers.length;
  const higher = Math.min(above?.layers.length ?? 0, MOST_LAYERS);
  const last = count + higher - 1;
  for (let k = higher - 1; k >= 0 && above !== undefined; k--) cover.lay(above, k, count + k);
  for (let layer = count - 1; layer >= 0; layer--) {
    const coarsest = coarsestWith(layer);
    const [from, to] = movesOf(moves, layer);
    for (let k = from; k < to; k++) {
      const role = moves.roles[k] ?? 0;
      if ((moves.sizes[2 * k] ?? 0) <= 0 || inside.hidden.has(role)) continue;
      const isTop = !cover.lies(moves, k, layer + 1);
      // The next layer drawn above may leave open what lies under those between.
      const next = Math.min(layer + layersDrawnAs(coarsest), last);
      const isOpen = isTop || !inside.covered.has(role) || !cover.lies(moves, k, next);
      if (!isOpen) continue;
      const share = onBed && layer === 0 ? 5 : isTop ? 4 : coarsest;
      shares[share - 1]?.push(k);
    }
    cover.lay(moves, layer, layer);
  }
  return shares.map((share) => Uint32Array.from(share).sort());
}

function movesOf({ layers }: Layers, layer: number): readonly [from: number, to: number] {
  return [layers[layer - 1] ?? 0, layers[layer] ?? 0];
}

/** Where the bed is covered by the beads of a layer, for the last eight layers laid. */
class Cover {
  readonly #cell: number;
  readonly #low: readonly [number, number];
  readonly #columns: number;
  readonly #rows: number;
  /** The number of the last layer in each square, of eight that take turns; one more, as 0 is none. */
  readonly #layers: Uint32Array;

  constructor({ ends, sizes }: Layers) {
    const low: [number, number] = [Number.POSITIVE_INFINITY, Number.POSITIVE_INFINITY];
    const high: [number, number] = [Number.NEGATIVE_INFINITY, Number.NEGATIVE_INFINITY];
    for (let k = 0; k < sizes.length / 2; k++) {
      if ((sizes[2 * k] ?? 0) <= 0) continue;
      for (const at of [6 * k, 6 * k + 3]) {
        for (const axis of [0, 1] as const) {
          const x = ends[at + axis] ?? 0;
          low[axis] = Math.min(low[axis], x);
          high[axis] = Math.max(high[axis], x);
        }
      }
    }
    // Layers without beads reach nowhere.
    const [width, depth] = [Math.max(high[0] - low[0], 0), Math.max(high[1] - low[1], 0)];
    this.#cell = Math.max(CELL, Math.sqrt((width * depth) / MOST_CELLS), Math.max(width, depth) / MOST_CELLS);
    this.#low = [low[0], low[1]];
    this.#columns = Math.floor(width / this.#cell) + 1;
    this.#rows = Math.floor(depth / this.#cell) + 1;
    this.#layers = new Uint32Array(MOST_LAYERS * this.#columns * this.#rows);
  }

  /** Lays the beads of layer `layer` of some moves as layer `as`. */
  lay(moves: Layers, layer: number, as: number): void {
    const [from, to] = movesOf(moves, layer);
    for (let k = from; k < to; k++) {
      if ((moves.sizes[2 * k] ?? 0) > 0) this.#along(moves, k, (cell) => this.#mark(cell, as));
    }
  }

  /** Whether layer `layer` lies on most of move `k`. */
  lies(moves: Layers, k: number, layer: number): boolean {
    let [covered, all] = [0, 0];
    this.#along(moves, k, (cell) => {
      all++;
      if (this.#layers[MOST_LAYERS * cell + (layer % MOST_LAYERS)] === layer + 1) covered++;
    });
    return 2 * covered > all;
  }

  #mark(cell: number, layer: number): void {
    this.#layers[MOST_LAYERS * cell + (layer % MOST_LAYERS)] = layer + 1;
  }

  /** Goes along a move by half squares. */
  #along({ ends }: Layers, k: number, visit: (cell: number) => void): void {
    const at = 6 * k;
    const [x, y] = [(ends[at] ?? 0) - this.#low[0], (ends[at + 1] ?? 0) - this.#low[1]];
    const [dx, dy] = [(ends[at + 3] ?? 0) - this.#low[0] - x, (ends[at + 4] ?? 0) - this.#low[1] - y];
    const steps = Math.ceil((2 * Math.hypot(dx, dy)) / this.#cell) + 1;
    for (let step = 0; step < steps; step++) {
      const share = (step + 0.5) / steps;
      const column = Math.floor((x + share * dx) / this.#cell);
      const row = Math.floor((y + share * dy) / this.#cell);
      if (column >= 0 && column < this.#columns && row >= 0 && row < this.#rows) visit(row * this.#columns + column);
    }
  }
}
