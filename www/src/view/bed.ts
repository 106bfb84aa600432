// The printer's bed as lines: a grid of 10 mm, stronger every 50 mm, the border, and the corner that is zero.
import {
  BufferGeometry,
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

export class Bed {
  readonly group = new Group();

  /** Draws the bed of a printer; `dark` chooses the colours. */
  draw([width, depth, height]: Room, dark: boolean): void {
    for (const child of [...this.group.children]) {
      this.group.remove(child);
      if (child instanceof Mesh || child instanceof LineSegments) child.geometry.dispose();
    }
    const plate = new Mesh(
      new PlaneGeometry(width, depth),
      new MeshBasicMaterial({
        color: dark ? 0x1d2320 : 0xf1f3ee,
        polygonOffset: true,
        polygonOffsetFactor: 2,
        polygonOffsetUnits: 2,
      }),
    );
    plate.position.set(width / 2, depth / 2, 2 * BELOW);
    this.group.add(plate);
    this.group.add(lines(grid(width, depth, 10, 50), dark ? 0x2c332f : 0xe0e4dc));
    this.group.add(lines(grid(width, depth, 50, Number.POSITIVE_INFINITY), dark ? 0x3f4843 : 0xc4cabf));
    this.group.add(lines(border(width, depth, 0), dark ? 0x7d8680 : 0x8b9186));
    const top = lines([...border(width, depth, height), ...posts(width, depth, height)], dark ? 0x343a37 : 0xdde1d9);
    this.group.add(top);
    this.group.add(lines([0, 0, 0, 15, 0, 0], 0xd9483b), lines([0, 0, 0, 0, 15, 0], 0x2f9e5b));
  }
}

function lines(points: readonly number[], color: number): LineSegments {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new Float32BufferAttribute(points, 3));
  return new LineSegments(geometry, new LineBasicMaterial({ color }));
}

/** Lines every `step` mm, without those that are a multiple of `coarse`. */
function grid(width: number, depth: number, step: number, coarse: number): number[] {
  const places = (length: number): number[] =>
    Array.from({ length: Math.ceil(length / step) }, (_, k) => k * step).filter((at) => at > 0 && at % coarse !== 0);
  return [
    ...places(width).flatMap((x) => [x, 0, BELOW, x, depth, BELOW]),
    ...places(depth).flatMap((y) => [0, y, BELOW, width, y, BELOW]),
  ];
}

function border(width: number, depth: number, z: number): number[] {
  return [0, 0, z, width, 0, z, width, 0, z, width, depth, z, width, depth, z, 0, depth, z, 0, depth, z, 0, 0, z];
}

function posts(width: number, depth: number, height: number): number[] {
  return [0, width].flatMap((x) => [0, depth].flatMap((y) => [x, y, 0, x, y, height]));
}
