// Plates of supports as thin translucent sheets.
import {
  DoubleSide,
  Group,
  Matrix4,
  Mesh,
  MeshBasicMaterial,
  Path,
  Shape,
  ShapeGeometry,
  Vector2,
  Vector3,
} from 'three';
import type { Sheet } from '../studies.ts';

const material = new MeshBasicMaterial({
  color: 0x2f9e44,
  transparent: true,
  opacity: 0.35,
  side: DoubleSide,
  // Sheets cross each other: none may hide what is behind it.
  depthWrite: false,
});

export class Sheets {
  readonly group = new Group();
  #shown: readonly Sheet[] = [];

  show(sheets: readonly Sheet[]): void {
    if (sheets === this.#shown) return;
    this.#shown = sheets;
    for (const it of this.group.children) if (it instanceof Mesh) it.geometry.dispose();
    this.group.clear();
    for (const sheet of sheets) {
      const mesh = new Mesh(new ShapeGeometry(sheet.islands.map(shapeOf)), material);
      mesh.matrixAutoUpdate = false;
      mesh.matrix.copy(standing(sheet));
      this.group.add(mesh);
    }
  }
}

function shapeOf([outer = [], ...holes]: readonly (readonly number[])[]): Shape {
  const shape = new Shape(points(outer));
  shape.holes = holes.map((hole) => new Path(points(hole)));
  return shape;
}

function points(flat: readonly number[]): Vector2[] {
  return Array.from({ length: flat.length / 2 }, (_, k) => new Vector2(flat[2 * k], flat[2 * k + 1]));
}

/** From (u, z) to the bed: u is y in planes x = const, x in planes y = const. */
function standing({ axis, at_mm }: Sheet): Matrix4 {
  const [x, y, z] = [new Vector3(1, 0, 0), new Vector3(0, 1, 0), new Vector3(0, 0, 1)];
  const basis = axis === 'x' ? new Matrix4().makeBasis(y, z, x) : new Matrix4().makeBasis(x, z, y.negate());
  return basis.setPosition(axis === 'x' ? at_mm : 0, axis === 'x' ? 0 : at_mm, 0);
}
