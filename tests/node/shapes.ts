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

/** The same so much higher. */
export function raised(triangles: readonly Triangle[], by: number): Triangle[] {
  const up = ([x, y, z]: Point): Point => [x, y, z + by];
  return triangles.map(([a, b, c]) => [up(a), up(b), up(c)]);
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

/** A ball made of so many rings and twice so many meridians. */
export function ball(radius: number, rings: number): Triangle[] {
  const point = (ring: number, turn: number): Point => {
    const [polar, around] = [(Math.PI * ring) / rings, (Math.PI * (turn % (2 * rings))) / rings];
    const out = ring === 0 || ring === rings ? 0 : Math.sin(polar) * radius;
    return [out * Math.cos(around), out * Math.sin(around), -radius * Math.cos(polar)];
  };
  const cells = Array.from(
    { length: rings * 2 * rings },
    (_, k) => [Math.floor(k / (2 * rings)), k % (2 * rings)] as const,
  );
  return cells.flatMap(([ring, turn]): Triangle[] => {
    const [a, b] = [point(ring, turn), point(ring, turn + 1)];
    const [c, d] = [point(ring + 1, turn + 1), point(ring + 1, turn)];
    const upper: Triangle[] = ring < rings - 1 ? [[a, c, d]] : [];
    return ring > 0 ? [[a, b, c], ...upper] : upper;
  });
}

/** The scanned bunny of the npm package, 60 mm high. */
export function bunny(): Triangle[] {
  return standing('bunny', 60);
}

/** The teapot of the npm package, 40 mm high; its surface is open in places. */
export function teapot(): Triangle[] {
  return standing('teapot', 40);
}

/** A mesh of an npm package, turned to stand on its feet: y is up there. */
function standing(name: string, height: number): Triangle[] {
  const { positions, cells } = createRequire(import.meta.url)(name) as { positions: number[][]; cells: number[][] };
  const ys = positions.map(([, y = 0]) => y);
  const scale = height / (Math.max(...ys) - Math.min(...ys));
  // x, y, z -> x, -z, y keeps the handedness.
  const points = positions.map(([x = 0, y = 0, z = 0]): Point => [scale * x, -scale * z, scale * y]);
  return cells.map((cell) => cell.map((k) => points[k] ?? [0, 0, 0]) as unknown as Triangle);
}

/** The triangles of a binary STL. */
export function readStl(bytes: Buffer): Triangle[] {
  const value = (triangle: number, k: number): number => bytes.readFloatLE(84 + 50 * triangle + 12 + 4 * k);
  return Array.from(
    { length: bytes.readUInt32LE(80) },
    (_, t) => [0, 3, 6].map((k): Point => [value(t, k), value(t, k + 1), value(t, k + 2)]) as unknown as Triangle,
  );
}
