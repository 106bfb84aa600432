// The part that the page shows first: a shelf bracket with a screw hole and an overhanging lip, as binary STL.
// It is an outline in the x-z plane, extruded along y, with a round hole through the upright.

const width = 24; // mm, along y
const hole = { x: 0, y: width / 2, z: 26, radius: 3.2, sides: 48, through: 5 };

/** The bracket's side view, counter-clockwise, mm; the upright is x 0..5, the lip hangs out at 45 degrees. */
const outline = [
  [0, 0],
  [44, 0],
  [44, 5],
  [19, 5],
  [5, 19],
  [5, 36],
  [13, 44],
  [13, 48],
  [0, 48],
];

/** The bracket as the bytes of a binary STL. */
export function sampleStl() {
  return binaryStl([...sides(), ...walls(), ...pierced(0, -1), ...pierced(hole.through, 1), ...bore()]);
}

/** The two flat ends, y = 0 and y = width; the outline is cut into convex pieces by hand. */
function sides() {
  const pieces = [
    [0, 1, 2, 3],
    [0, 3, 4],
    [0, 4, 5],
    [0, 5, 8],
    [8, 5, 6, 7],
  ];
  return pieces
    .flatMap((piece) => fan(piece.map((k) => outline[k])))
    .flatMap(([a, b, c]) => [
      [on(a, 0), on(b, 0), on(c, 0)],
      [on(a, width), on(c, width), on(b, width)],
    ]);
}

const on = ([x, z], y) => [x, y, z];

function fan(points) {
  return points.slice(2).map((point, k) => [points[0], points[k + 1], point]);
}

/** The faces along the outline, but the two of the upright that the hole goes through. */
function walls() {
  return outline.flatMap((a, k) => {
    const b = outline[(k + 1) % outline.length];
    const throughHole = a[0] === b[0] && Math.min(a[1], b[1]) < hole.z && hole.z < Math.max(a[1], b[1]);
    return throughHole ? [] : quad(on(a, 0), on(a, width), on(b, width), on(b, 0));
  });
}

const quad = (a, b, c, d) => [
  [a, b, c],
  [a, c, d],
];

/** A rectangle in the plane x with the round hole in it; `facing` is the x of its normal. */
function pierced(x, facing) {
  const [low, high] = x === 0 ? [0, 48] : [19, 36];
  const ring = circle(x);
  const corners = [
    [x, width, high],
    [x, 0, high],
    [x, 0, low],
    [x, width, low],
  ];
  const quarter = hole.sides / 4;
  const faces = corners.flatMap((corner, k) => {
    const arc = Array.from({ length: quarter + 1 }, (_, i) => ring[(k * quarter + i) % hole.sides]);
    const next = corners[(k + 1) % 4];
    const spokes = arc.slice(1).map((point, i) => [corner, point, arc[i]]);
    return [...spokes, [corner, next, arc[quarter]]];
  });
  return facing > 0 ? faces : faces.map(flip);
}

const flip = ([a, b, c]) => [a, c, b];

/** The hole's rim in the plane x; starts at +y and goes to +z. */
function circle(x) {
  return Array.from({ length: hole.sides }, (_, k) => {
    const angle = (2 * Math.PI * k) / hole.sides;
    return [x, hole.y + hole.radius * Math.cos(angle), hole.z + hole.radius * Math.sin(angle)];
  });
}

/** The inside of the hole. */
function bore() {
  const [near, far] = [circle(0), circle(hole.through)];
  return near.flatMap((a, k) => {
    const next = (k + 1) % hole.sides;
    return quad(a, far[k], far[next], near[next]);
  });
}

/** Triangles, three points each, as the bytes of a binary STL. */
export function binaryStl(triangles) {
  const bytes = new DataView(new ArrayBuffer(84 + 50 * triangles.length));
  bytes.setUint32(80, triangles.length, true);
  triangles.flat(2).forEach((value, k) => {
    const [triangle, coordinate] = [Math.floor(k / 9), k % 9];
    bytes.setFloat32(84 + 50 * triangle + 12 + 4 * coordinate, value, true);
  });
  return new Uint8Array(bytes.buffer);
}
