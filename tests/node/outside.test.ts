import { expect, test } from 'vitest';
import { type Inside, sharesOf } from '../../www/src/view/outside.ts';

const [WALL, INNER, INFILL] = [0, 1, 2];
const inside: Inside = { covered: new Set([INNER]), hidden: new Set([INFILL]) };

/** A straight bead along X, or a travel. */
interface Bead {
  readonly role: number;
  readonly y: number;
  readonly from?: number;
  readonly to?: number;
  readonly isTravel?: boolean;
}

function movesOf(layers: readonly (readonly Bead[])[]): Parameters<typeof sharesOf>[0] {
  const all = layers.flatMap((beads, layer) => beads.map((bead) => ({ from: 0, to: 10, z: 0.2 * layer, ...bead })));
  let count = 0;
  return {
    ends: Float32Array.from(all.flatMap(({ from, to, y, z }) => [from, y, z, to, y, z])),
    sizes: Float32Array.from(all.flatMap(({ isTravel }) => (isTravel === true ? [0, 0] : [0.45, 0.2]))),
    roles: Uint8Array.from(all.map(({ role }) => role)),
    layers: Uint32Array.from(layers, (beads) => (count += beads.length)),
  };
}

const positions = (shares: readonly Uint32Array[]): number[][] => shares.map((share) => [...share]);

/** A wall, an inner wall, infill and a travel. */
const layer: readonly Bead[] = [
  { role: WALL, y: 0 },
  { role: INNER, y: 1 },
  { role: INFILL, y: 2 },
  { role: WALL, y: 3, isTravel: true },
];

test('of a straight tower the walls are kept, of its top what lies open', () => {
  const tower = movesOf(Array.from({ length: 9 }, () => layer));
  // Layers 0 to 8; the last one is open.
  expect(positions(sharesOf(tower, inside, false))).toEqual([[0, 8, 16, 24], [4, 20], [12], [28, 32, 33], []]);
  expect(positions(sharesOf(tower, inside, true))).toEqual([[8, 16, 24], [4, 20], [12], [28, 32, 33], [0]]);
});

test('layers that follow cover the last ones', () => {
  const tower = movesOf(Array.from({ length: 8 }, () => layer));
  expect(positions(sharesOf(tower, inside, false, tower))).toEqual([[0, 8, 16, 24], [4, 20], [12], [28], []]);
});

test('a step is shown by each detail, at its height', () => {
  // The inner wall and infill at 1 and 2 end with layer 2.
  const stepped = movesOf([
    ...Array.from({ length: 3 }, () => layer),
    ...Array.from({ length: 5 }, () => [layer[0] ?? { role: WALL, y: 0 }]),
  ]);
  const [, , , always] = sharesOf(stepped, inside, false, movesOf(Array.from({ length: 8 }, () => layer)));
  expect([...(always ?? [])]).toEqual([9, 16]);
});

test('what the layers between leave open above a drawn layer is shown with it', () => {
  // Each layer's inner wall lies 0.3 mm further in than that below: the next covers it, the second next does not.
  const slope = movesOf(Array.from({ length: 8 }, (_, k) => [{ role: INNER, y: 0.3 * k + 0.01 }]));
  const above = movesOf(Array.from({ length: 8 }, (_, k) => [{ role: INNER, y: 0.3 * (k + 8) + 0.01 }]));
  const shown = sharesOf(slope, inside, false, above).map((share) => share.length);
  // Some lie across the edge of a square and count as open to the next layer.
  expect(shown.reduce((sum, it) => sum + it, 0)).toBeGreaterThan(3);
  expect(sharesOf(movesOf([[], []]), inside, true).every((share) => share.length === 0)).toBe(true);
});

test('half a bead that lies open is not enough', () => {
  const moves = movesOf([[{ role: INNER, y: 0 }], [{ role: INNER, y: 0, to: 6 }]]);
  expect(positions(sharesOf(moves, inside, false))[3]).toEqual([1]);
  const less = movesOf([[{ role: INNER, y: 0 }], [{ role: INNER, y: 0, to: 4 }]]);
  expect(positions(sharesOf(less, inside, false))[3]).toEqual([0, 1]);
});
