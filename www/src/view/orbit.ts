// The camera of the picture in space: it looks at a point of the bed from a direction and a distance.
import type { Size } from './camera.ts';

export type Point = readonly [number, number, number];

export interface Orbit {
  /** The point looked at, mm. */
  readonly target: Point;
  /** Radians from the front (looking along +y) towards the right side. */
  readonly azimuth: number;
  /** Radians above the bed. */
  readonly elevation: number;
  /** From the eye to the target, mm. */
  readonly distance: number;
}

/** Angle of the picture from bottom to top, radians. */
export const FIELD_OF_VIEW = (35 * Math.PI) / 180;

/** Radians a pixel of dragging turns. */
const TURN = 0.008;
/** The eye stays this far off straight up and down, where left and right would flip. */
const POLE = Math.PI / 2 - 0.001;
const DISTANCES: readonly [number, number] = [2, 5000];
/** Room around what is shown. */
const ROOM = 1.12;

/** Directions that can be chosen by name: azimuth and elevation. */
export const sides = {
  iso: [-0.6, 0.5],
  top: [0, POLE],
  front: [0, 0],
} as const satisfies Readonly<Record<string, readonly [number, number]>>;

/** Turned by dragging so many pixels to the right and down. */
export function turned(orbit: Orbit, right: number, down: number): Orbit {
  const elevation = Math.min(Math.max(orbit.elevation + down * TURN, -POLE), POLE);
  return { ...orbit, azimuth: orbit.azimuth - right * TURN, elevation };
}

/** Closer by a factor. */
export function zoomed(orbit: Orbit, factor: number): Orbit {
  const distance = Math.min(Math.max(orbit.distance / factor, DISTANCES[0]), DISTANCES[1]);
  return { ...orbit, distance };
}

/** Moved so that what is looked at follows a drag of so many pixels, on a picture `height` pixels high. */
export function panned(orbit: Orbit, right: number, down: number, height: number): Orbit {
  const mm = (2 * orbit.distance * Math.tan(FIELD_OF_VIEW / 2)) / Math.max(height, 1);
  const [across, up] = frameOf(orbit);
  const along = (k: 0 | 1 | 2): number => orbit.target[k] - across[k] * right * mm + up[k] * down * mm;
  return { ...orbit, target: [along(0), along(1), along(2)] };
}

/** Looking from a direction at a box (lowest x y z, highest x y z), so that all of it is in the picture. */
export function fitted(box: readonly number[], [azimuth, elevation]: readonly [number, number], aspect: number): Orbit {
  const [x0 = 0, y0 = 0, z0 = 0, x1 = 0, y1 = 0, z1 = 0] = box;
  const target: Point = [(x0 + x1) / 2, (y0 + y1) / 2, (z0 + z1) / 2];
  const orbit = { target, azimuth, elevation, distance: 1 };
  const [across, up, back] = frameOf(orbit);
  const half = Math.tan(FIELD_OF_VIEW / 2);
  const corners = [x0, x1].flatMap((x) => [y0, y1].flatMap((y) => [z0, z1].map((z): Point => [x, y, z])));
  const distances = corners.map((corner) => {
    const from = corner.map((value, k) => value - (target[k] ?? 0)) as unknown as Point;
    const wide = Math.abs(dot(from, across)) / (half * aspect);
    return dot(from, back) + Math.max(wide, Math.abs(dot(from, up)) / half);
  });
  return { ...orbit, distance: Math.max(DISTANCES[0], ROOM * Math.max(...distances)) };
}

/** Looking at a box so that all of it is between what covers the picture's upper and lower edge, px. */
export function fittedBetween(
  box: readonly number[],
  direction: readonly [number, number],
  { width, height }: Size,
  [top, bottom]: readonly [number, number],
): Orbit {
  // A picture too low for both keeps half of itself.
  const share = Math.max(0.5, 1 - (top + bottom) / Math.max(height, 1));
  const free = share * Math.max(height, 1);
  const orbit = fitted(box, direction, width / free);
  return panned({ ...orbit, distance: orbit.distance / share }, 0, (top - bottom) / 2, height);
}

/** Where the eye is, mm. */
export function eyeOf(orbit: Orbit): Point {
  const [, , back] = frameOf(orbit);
  const at = (k: 0 | 1 | 2): number => orbit.target[k] + back[k] * orbit.distance;
  return [at(0), at(1), at(2)];
}

/** Unit vectors to the right of the picture, up, and from the target to the eye. */
export function frameOf({ azimuth, elevation }: Orbit): readonly [Point, Point, Point] {
  const [sinA, cosA, sinE, cosE] = [Math.sin(azimuth), Math.cos(azimuth), Math.sin(elevation), Math.cos(elevation)];
  return [
    [cosA, sinA, 0],
    [-sinA * sinE, cosA * sinE, cosE],
    [sinA * cosE, -cosA * cosE, sinE],
  ];
}

const dot = (a: Point, b: Point): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
