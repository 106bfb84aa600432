// The camera in space and the colours of beads.
import { expect, test } from 'vitest';
import type { Moves } from '../../www/src/messages.ts';
import { extent, indices, palette, scaleColour, TRAVEL, UNKNOWN } from '../../www/src/view/colours.ts';
import {
  eyeOf,
  FIELD_OF_VIEW,
  fitted,
  fittedBetween,
  frameOf,
  type Orbit,
  type Point,
  panned,
  sides,
  turned,
  zoomed,
} from '../../www/src/view/orbit.ts';

const box = [10, 20, 0, 50, 40, 30];
const dot = (a: Point, b: Point): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

test('from the front one looks along y, from the top straight down', () => {
  const front = fitted(box, sides.front, 1);
  const eye = eyeOf(front);
  expect(front.target).toEqual([30, 30, 15]);
  expect(eye[0]).toBeCloseTo(30, 9);
  expect(eye[1]).toBeLessThan(20);
  expect(eye[2]).toBeCloseTo(15, 9);
  const top = eyeOf(fitted(box, sides.top, 1));
  expect(top[0]).toBeCloseTo(30, 9);
  expect(Math.abs(top[1] - 30)).toBeLessThan(1);
  expect(top[2]).toBeGreaterThan(30);
});

test('the frame is right-angled, and right, up and back turn as a right hand', () => {
  for (const [azimuth, elevation] of [
    [0.3, 0.8],
    [-2, -1],
    [3, 1.5],
  ] as const) {
    const [right, up, back] = frameOf({ target: [0, 0, 0], azimuth, elevation, distance: 1 });
    for (const [a, b] of [
      [right, up],
      [up, back],
      [back, right],
    ] as const)
      expect(dot(a, b)).toBeCloseTo(0, 12);
    const cross = [
      right[1] * up[2] - right[2] * up[1],
      right[2] * up[0] - right[0] * up[2],
      right[0] * up[1] - right[1] * up[0],
    ];
    for (const k of [0, 1, 2] as const) expect(cross[k]).toBeCloseTo(back[k], 12);
  }
});

test.each(Object.entries(sides))('all corners of the box are in the picture, %s', (_, side) => {
  for (const aspect of [0.5, 1, 2]) {
    const orbit = fitted(box, side, aspect);
    const [right, up, back] = frameOf(orbit);
    const eye = eyeOf(orbit);
    for (const x of [10, 50]) {
      for (const y of [20, 40]) {
        for (const z of [0, 30]) {
          const from: Point = [x - eye[0], y - eye[1], z - eye[2]];
          const depth = -dot(from, back) * Math.tan(FIELD_OF_VIEW / 2);
          expect(Math.abs(dot(from, up))).toBeLessThan(depth);
          expect(Math.abs(dot(from, right))).toBeLessThan(depth * aspect);
        }
      }
    }
  }
});

test.each(Object.entries(sides))('the box is between what covers the edges, %s', (_, side) => {
  const [width, height, top, bottom] = [390, 455, 50, 62];
  const orbit = fittedBetween(box, side, { width, height }, [top, bottom]);
  const [right, up, back] = frameOf(orbit);
  const eye = eyeOf(orbit);
  const corners = [10, 50].flatMap((x) => [20, 40].flatMap((y) => [0, 30].map((z): Point => [x, y, z])));
  for (const [x, y, z] of corners) {
    const from: Point = [x - eye[0], y - eye[1], z - eye[2]];
    const pixels = height / 2 / (-dot(from, back) * Math.tan(FIELD_OF_VIEW / 2));
    const down = height / 2 - dot(from, up) * pixels;
    expect(down).toBeGreaterThan(top);
    expect(down).toBeLessThan(height - bottom);
    expect(Math.abs(dot(from, right) * pixels)).toBeLessThan(width / 2);
  }
});

test('dragging turns, zooming keeps the target, panning moves it with the pointer', () => {
  const orbit: Orbit = { target: [0, 0, 0], azimuth: 0, elevation: 0, distance: 100 };
  expect(turned(orbit, 10, 0).azimuth).toBeLessThan(0);
  expect(turned(orbit, 0, 1e6).elevation).toBeLessThan(Math.PI / 2);
  expect(zoomed(orbit, 2)).toEqual({ ...orbit, distance: 50 });
  expect(zoomed(orbit, 1e9).distance).toBeGreaterThan(0);
  // The whole height of the picture is 2 x 100 x tan(17.5 degrees) mm.
  const height = 2 * 100 * Math.tan(FIELD_OF_VIEW / 2);
  const [x, y, z] = panned(orbit, 500, 250, 500).target;
  expect([x, y]).toEqual([expect.closeTo(-height, 9), expect.closeTo(0, 9)]);
  expect(z).toBeCloseTo(height / 2, 9);
});

const moves: Moves = {
  ends: new Float32Array(24),
  sizes: Float32Array.of(0.4, 0.2, 0, 0.2, 0.6, 0.2, 0.5, 0.2),
  roles: Uint8Array.of(0, 255, 2, 255),
  speeds: Float32Array.of(20, 150, 60, 40),
  flows: Float32Array.of(1, 0, 3, 2),
  fans: Uint8Array.of(0, 0, 255, 51),
  tools: Uint8Array.of(0, 0, 1, 0),
  layers: Uint32Array.of(4),
};

test('colours by role, quantity and tool; travels have their own', () => {
  expect([...indices('role', moves, undefined)]).toEqual([0, TRAVEL, 2, UNKNOWN]);
  expect([...indices('tool', moves, undefined)]).toEqual([0, TRAVEL, 1, 0]);
  expect(extent('speed', [moves])).toEqual([20, 60]);
  expect([...indices('speed', moves, [20, 60])]).toEqual([0, TRAVEL, 240, 120]);
  expect(extent('fan', [moves])).toEqual([0, 100]);
  expect([...indices('fan', moves, [0, 100])]).toEqual([0, TRAVEL, 240, 48]);
  expect(extent('flow', [])).toEqual([0, 0]);
});

test('a hidden role is not painted', () => {
  const roles = [
    { role: 'outer_wall', color: '#010203' },
    { role: 'infill', color: '#040506' },
  ];
  const colours = palette('role', roles, new Set(['infill', 'travel']));
  expect([...colours.subarray(0, 8)]).toEqual([1, 2, 3, 255, 4, 5, 6, 0]);
  expect(colours[4 * TRAVEL + 3]).toBe(0);
  expect(palette('role', roles, new Set())[4 * TRAVEL + 3]).toBe(255);
});

test('the scale goes from its first colour to its last', () => {
  expect([scaleColour(-1), scaleColour(0), scaleColour(1), scaleColour(2)]).toEqual([
    '#2c3e8f',
    '#2c3e8f',
    '#b5202e',
    '#b5202e',
  ]);
});
