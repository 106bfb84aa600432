// The parts on the bed: each is an open model with a matrix from its file's coordinates to the bed's. Matrices
// are changed by the engine; the page only moves parts along the bed.
import type { Standing } from './messages.ts';
import { asSettings, type Changes } from './settings/changes.ts';

/** A part that stands on the bed. */
export interface Part {
  /** Names the part in lists and pictures; never used twice. */
  readonly id: number;
  /** Position of its model in the list of open models. */
  readonly model: number;
  /** 16 numbers, the columns of the matrix from file to bed coordinates. */
  readonly matrix: readonly number[];
  /** The box around it: lowest x y z, highest x y z, mm. */
  readonly box: readonly number[];
  /** Settings of its own, where they differ from the plate's. */
  readonly own?: Changes;
}

/** Bed width and depth and the printer's height, mm; x and y of the bed's front left corner; whether it is round. */
export type Room = readonly [width: number, depth: number, height: number, x: number, y: number, round: boolean];

/** A matrix that leaves everything where it is. */
export const UNMOVED: readonly number[] = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];

/** Free space between parts, mm. */
const GAP = 10;
/** Steps in which a free spot is looked for, mm. */
const STEP = 5;
/** A part may stand so far over the edge by rounding, mm. */
const EDGE = 1e-3;

/** The part with the matrix and the box of the engine's answer. */
export function standing(id: number, model: number, stand: Float64Array): Part {
  return { id, model, matrix: [...stand.subarray(0, 16)], box: [...stand.subarray(16, 22)] };
}

/** The part moved along the bed, mm. */
export function moved(part: Part, x: number, y: number): Part {
  const matrix = part.matrix.with(12, at(part.matrix, 12) + x).with(13, at(part.matrix, 13) + y);
  const box = part.box.map((value, k) => value + (k % 3 === 0 ? x : k % 3 === 1 ? y : 0));
  return { ...part, matrix, box };
}

/** The part with its middle at a point of the bed. */
export function movedTo(part: Part, x: number, y: number): Part {
  const [atX, atY] = middleOf(part);
  return moved(part, x - atX, y - atY);
}

export function middleOf({ box }: Part): readonly [number, number] {
  return [(at(box, 0) + at(box, 3)) / 2, (at(box, 1) + at(box, 4)) / 2];
}

export function sizeOf({ box }: Part): readonly [number, number, number] {
  return [at(box, 3) - at(box, 0), at(box, 4) - at(box, 1), at(box, 5) - at(box, 2)];
}

/** The box around all parts: lowest x y z, highest x y z, mm; undefined without parts. */
export function extentOf(parts: readonly Part[]): readonly number[] | undefined {
  const [first, ...others] = parts.map(({ box }) => box);
  return others.reduce(
    (all, box) => all?.map((value, k) => (k < 3 ? Math.min(value, at(box, k)) : Math.max(value, at(box, k)))),
    first,
  );
}

/** How much larger than in its file the part is, as the edge of a cube of its volume would be. */
export function scaleOf({ matrix: m }: Part): number {
  const cofactor = (a: number, b: number, c: number, d: number): number => at(m, a) * at(m, b) - at(m, c) * at(m, d);
  const volume = at(m, 0) * cofactor(5, 10, 6, 9) - at(m, 4) * cofactor(1, 10, 2, 9) + at(m, 8) * cofactor(1, 6, 2, 5);
  return Math.cbrt(Math.abs(volume));
}

/** Whether the part reaches out of the printer. */
export function isOutside({ box }: Part, [width, depth, height, x, y]: Room): boolean {
  const [low, high] = [
    [x, y, 0],
    [x + width, y + depth, height],
  ] as const;
  return [0, 1, 2].some((k) => at(box, k) < at(low, k) - EDGE || at(box, k + 3) > at(high, k) + EDGE);
}

/** The part at the free spot nearest to the middle of the bed; in the middle when there is none. */
export function atFreeSpot(part: Part, others: readonly Part[], room: Room): Part {
  const [width, depth] = sizeOf(part);
  const [roomWidth, roomDepth, , left, front] = room;
  const centre = [left + roomWidth / 2, front + roomDepth / 2] as const;
  const spots: (readonly [number, number])[] = [centre];
  for (let x = left + width / 2; x <= left + roomWidth - width / 2; x += STEP) {
    for (let y = front + depth / 2; y <= front + roomDepth - depth / 2; y += STEP) spots.push([x, y]);
  }
  const far = ([x, y]: readonly [number, number]): number => Math.hypot(x - centre[0], y - centre[1]);
  const isFree = ([x, y]: readonly [number, number]): boolean =>
    !others.some(({ box }) => {
      const beside = Math.abs(x - (at(box, 0) + at(box, 3)) / 2) - (width + at(box, 3) - at(box, 0)) / 2;
      const behind = Math.abs(y - (at(box, 1) + at(box, 4)) / 2) - (depth + at(box, 4) - at(box, 1)) / 2;
      return beside < GAP && behind < GAP;
    });
  const [x, y] = spots.sort((a, b) => far(a) - far(b)).find(isFree) ?? centre;
  return movedTo(part, x, y);
}

/** As the engine takes them; parts that nobody has moved yet are left to it to arrange. */
export function asStanding(parts: readonly Part[], arranged: boolean): Standing {
  return {
    models: parts.map(({ model }) => model),
    placements: arranged ? [] : parts.flatMap(({ matrix }) => matrix),
    own: parts.some(hasOwn) ? parts.map(({ own = {} }) => asSettings(own)) : [],
  };
}

/** Whether the part has settings of its own. */
export function hasOwn({ own = {} }: Part): boolean {
  return Object.keys(own).length > 0;
}

/** A number for a part that no part has. */
export function freeId(parts: readonly Part[]): number {
  return Math.max(0, ...parts.map(({ id }) => id)) + 1;
}

/** Lists of 16 and 6 numbers: the caller knows that the index is inside. */
function at(list: readonly number[], index: number): number {
  return list[index] ?? 0;
}
