// The printer's bed as lines: a grid of 10 mm, stronger every 50 mm, the border, and the point that is zero.
import {
  BufferGeometry,
  CircleGeometry,
  Float32BufferAttribute,
  Group,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshBasicMaterial,
  PlaneGeometry,
} from 'three';
import type { Room } from '../parts.ts';

/** Lies just under the parts, mm, so that what stands on it hides it. */
const BELOW = -0.05;

/** Corners of a round bed's border. */
const CORNERS = 96;

export class Bed {
  readonly group = new Group();

  /** Draws the bed of a printer; `dark` chooses the colours. */
  draw(room: Room, dark: boolean): void {
    for (const child of [...this.group.children]) {
      this.group.remove(child);
      if (child instanceof Mesh || child instanceof LineSegments) child.geometry.dispose();
    }
    const [width, depth, height, x, y, round] = room;
    const plate = new Mesh(
      round ? new CircleGeometry(0.5, CORNERS) : new PlaneGeometry(1, 1),
      new MeshBasicMaterial({
        color: dark ? 0x1d2320 : 0xf1f3ee,
        polygonOffset: true,
        polygonOffsetFactor: 2,
        polygonOffsetUnits: 2,
      }),
    );
    plate.scale.set(width, depth, 1);
    plate.position.set(x + width / 2, y + depth / 2, 2 * BELOW);
    this.group.add(plate);
    this.group.add(lines(grid(room, 10, 50), dark ? 0x2c332f : 0xe0e4dc));
    this.group.add(lines(grid(room, 50, Number.POSITIVE_INFINITY), dark ? 0x3f4843 : 0xc4cabf));
    this.group.add(lines(border(room, 0), dark ? 0x7d8680 : 0x8b9186));
    const top = lines([...border(room, height), ...posts(room)], dark ? 0x343a37 : 0xdde1d9);
    this.group.add(top);
    this.group.add(lines([0, 0, 0, 15, 0, 0], 0xd9483b), lines([0, 0, 0, 0, 15, 0], 0x2f9e5b));
  }
}

function lines(points: readonly number[], color: number): LineSegments {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new Float32BufferAttribute(points, 3));
  return new LineSegments(geometry, new LineBasicMaterial({ color }));
}

/** Lines at every `step` mm from zero, without those at a multiple of `coarse`, as long as the bed is there. */
function grid([width, depth, , x0, y0, round]: Room, step: number, coarse: number): number[] {
  const places = (low: number, length: number): number[] => {
    const first = Math.floor(low / step) + 1;
    const count = Math.ceil((low + length) / step) - first;
    return Array.from({ length: count }, (_, k) => (first + k) * step).filter((at) => at % coarse !== 0 || at === 0);
  };
  // Half of a chord, as a share of the whole, at this share of the way across.
  const half = (share: number): number => (round ? Math.sqrt(Math.max(0, share * (1 - share))) : 0.5);
  const upright = places(x0, width).flatMap((x) => {
    const [middle, reach] = [y0 + depth / 2, depth * half((x - x0) / width)];
    return [x, middle - reach, BELOW, x, middle + reach, BELOW];
  });
  const level = places(y0, depth).flatMap((y) => {
    const [middle, reach] = [x0 + width / 2, width * half((y - y0) / depth)];
    return [middle - reach, y, BELOW, middle + reach, y, BELOW];
  });
  return [...upright, ...level];
}

/** The corners of the bed's border, the first one again at the end. */
function corners([width, depth, , x, y, round]: Room): (readonly [number, number])[] {
  if (!round) {
    const [right, back] = [x + width, y + depth];
    return [
      [x, y],
      [right, y],
      [right, back],
      [x, back],
      [x, y],
    ];
  }
  return Array.from({ length: CORNERS + 1 }, (_, k) => {
    const angle = (2 * Math.PI * k) / CORNERS;
    return [x + (width / 2) * (1 + Math.cos(angle)), y + (depth / 2) * (1 + Math.sin(angle))];
  });
}

function border(room: Room, z: number): number[] {
  const all = corners(room);
  return all.slice(1).flatMap(([x, y], k) => [...(all[k] ?? [x, y]), z, x, y, z]);
}

/** Upright lines from the bed to the top: four of them. */
function posts(room: Room): number[] {
  const all = corners(room).slice(0, -1);
  const four = all.filter((_, k) => k % (all.length / 4) === 0);
  return four.flatMap(([x, y]) => [x, y, 0, x, y, room[2]]);
}
