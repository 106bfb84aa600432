// Models that tests need, as bytes.
import { createRequire } from 'node:module';

type Point = readonly [number, number, number];
export type Triangle = readonly [Point, Point, Point];

/** A binary STL; `count` is what its header says. */
export function binaryStl(triangles: readonly Triangle[], count = triangles.length): Buffer {
  const bytes = Buffer.alloc(84 + 50 * triangles.length);
  bytes.writeUInt32LE(count, 80);
  triangles.forEach((triangle, k) => {
    triangle.flat().forEach((value, i) => {
      bytes.writeFloatLE(value, 84 + 50 * k + 12 + 4 * i);
    });
  });
  return bytes;
}

/** A box with a corner at the origin. */
export function box(width: number, depth: number, height: number): Triangle[] {
  const corner = (k: number): Point => [k & 1 ? width : 0, k & 2 ? depth : 0, k & 4 ? height : 0];
  const faces = [
    [0, 2, 3, 1],
    [4, 5, 7, 6],
    [0, 1, 5, 4],
    [2, 6, 7, 3],
    [0, 4, 6, 2],
    [1, 3, 7, 5],
  ];
  return faces.flatMap(([a = 0, b = 0, c = 0, d = 0]): Triangle[] => [
    [corner(a), corner(b), corner(c)],
    [corner(a), corner(c), corner(d)],
  ]);
}

/** The scanned bunny of the npm package, 60 mm high, turned to stand on its feet. */
export function bunny(): Triangle[] {
  const { positions, cells } = createRequire(import.meta.url)('bunny') as { positions: number[][]; cells: number[][] };
  const ys = positions.map(([, y = 0]) => y);
  const scale = 60 / (Math.max(...ys) - Math.min(...ys));
  // The scan has y up: x, y, z -> x, -z, y keeps its handedness.
  const points = positions.map(([x = 0, y = 0, z = 0]): Point => [scale * x, -scale * z, scale * y]);
  return cells.map((cell) => cell.map((k) => points[k] ?? [0, 0, 0]) as unknown as Triangle);
}
