// The picture in space: bed, parts and beads, drawn with three.js when something has changed. Loaded when it is
// first shown.
import {
  AmbientLight,
  Box3,
  Box3Helper,
  BoxGeometry,
  BufferAttribute,
  BufferGeometry,
  Color,
  DirectionalLight,
  Group,
  Line,
  LineBasicMaterial,
  Matrix4,
  Mesh,
  MeshLambertMaterial,
  PerspectiveCamera,
  Plane,
  Raycaster,
  Scene,
  Sphere,
  Vector2,
  Vector3,
  WebGLRenderer,
} from 'three';
import type { Moves, Shape } from '../messages.ts';
import { isOutside, type Part, type Room } from '../parts.ts';
import type { Sheet } from '../studies.ts';
import { Beads } from './beads.ts';
import { Bed } from './bed.ts';
import type { Size, Spot } from './camera.ts';
import { FrameQueue } from './frame-queue.ts';
import { eyeOf, FIELD_OF_VIEW, type Orbit, type Point } from './orbit.ts';
import type { Inside } from './outside.ts';
import { type Pace, paced, rested, unhurried, whole } from './pace.ts';
import { Sheets } from './sheets.ts';
import { hasGraphicsCard } from './webgl.ts';

/** What a ray from the eye meets. */
export interface Hit {
  readonly part: number;
  /** Index of the triangle in its model. */
  readonly triangle: number;
  readonly at: Point;
}

/** Above so many triangles a click asks for the part's box only: a ray through all of them would take too long. */
const MOST_PICKED = 2_000_000;

/** Moves of the camera further apart than this, ms, are not one movement. */
const STILL = 250;
/** Time in a frame to find what a coarser picture shows, ms at least; else half as long as the last frame took. */
const THIN = 12;

const colours = {
  light: { ground: 0xfafbf9, part: 0x7aa0c4, selected: 0x2f8f86, outside: 0xd9604f },
  dark: { ground: 0x121513, part: 0x6d93b8, selected: 0x35b3a5, outside: 0xe0695a },
} as const;

export class Stage {
  readonly #renderer: WebGLRenderer;
  readonly #scene = new Scene();
  readonly #camera = new PerspectiveCamera((FIELD_OF_VIEW * 180) / Math.PI, 1, 1, 10_000);
  readonly #sun = new DirectionalLight(0xffffff, 2.1);
  readonly #bed = new Bed();
  readonly #parts = new Group();
  readonly #shapes = new Map<number, BufferGeometry>();
  readonly #beads = new Beads();
  readonly #sheets = new Sheets();
  readonly #frame = new Box3Helper(new Box3(), 0x2f8f86);
  readonly #ruler = new Line(new BufferGeometry(), new LineBasicMaterial({ color: 0xe8743b, depthTest: false }));
  readonly #ray = new Raycaster();
  #dark = false;
  #size: Size = { width: 1, height: 1 };
  #orbit: Orbit | undefined;
  /** Whether a look at the picture and the queue is due, and whether the picture is older than what it shows. */
  #waiting = false;
  #stale = false;
  /** The next frame hands beads over: its time says nothing about those that follow. */
  #handsOver = false;
  /** How long the last usual frame took, ms. */
  #took = 0;
  readonly #queue: FrameQueue;
  /** What the movement of the picture has shown, and the timer that ends it; 0 while it rests. */
  #pace: Pace = unhurried;
  #moving = 0;
  #shown: readonly [layer: number, moves: number] = [0, 0];

  constructor(canvas: HTMLCanvasElement, lost: () => void) {
    this.#renderer = new WebGLRenderer({ canvas, antialias: hasGraphicsCard(), powerPreference: 'high-performance' });
    this.#queue = new FrameQueue(this.#renderer.getContext() as WebGL2RenderingContext);
    canvas.addEventListener('webglcontextlost', (event) => {
      event.preventDefault();
      lost();
    });
    this.#camera.up.set(0, 0, 1);
    this.#scene.add(new AmbientLight(0xffffff, 1.25), this.#sun, this.#bed.group, this.#parts, this.#beads.group);
    this.#scene.add(this.#frame, this.#ruler, this.#sheets.group);
    this.#ruler.visible = false;
    this.#ruler.renderOrder = 1;
  }

  resize(size: Size, ratio: number): void {
    this.#size = size;
    this.#renderer.setPixelRatio(Math.min(ratio, 2));
    this.#renderer.setSize(size.width, size.height, false);
    this.#camera.aspect = size.width / Math.max(size.height, 1);
    this.#camera.updateProjectionMatrix();
    this.redraw();
  }

  look(orbit: Orbit): void {
    if (orbit === this.#orbit) return;
    this.#orbit = orbit;
    this.#camera.position.set(...eyeOf(orbit));
    this.#camera.near = Math.max(orbit.distance / 200, 0.1);
    this.#camera.far = orbit.distance * 20 + 2000;
    this.#camera.lookAt(...orbit.target);
    this.#camera.updateProjectionMatrix();
    this.#move();
    // The light comes over the left shoulder, wherever one looks from.
    this.#sun.position.set(-0.45, 0.55, 0.7).applyQuaternion(this.#camera.quaternion);
    this.redraw();
  }

  dress(room: Room, dark: boolean): void {
    this.#dark = dark;
    this.#scene.background = new Color(this.#colours().ground);
    this.#bed.draw(room, dark);
    this.redraw();
  }

  hasShape(model: number): boolean {
    return this.#shapes.has(model);
  }

  addShape(model: number, { positions, indices }: Shape): void {
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(positions, 3));
    geometry.setIndex(new BufferAttribute(indices, 1));
    geometry.computeBoundingBox();
    // The sphere around the box is large enough to tell what is out of sight, and needs no look at the vertices.
    geometry.boundingSphere = (geometry.boundingBox ?? new Box3()).getBoundingSphere(new Sphere());
    this.#shapes.set(model, geometry);
  }

  /** Forgets all models: others are open. */
  forget(): void {
    this.#parts.clear();
    for (const geometry of this.#shapes.values()) geometry.dispose();
    this.#shapes.clear();
  }

  /** The parts; one whose shape is not there is a box. */
  showParts(parts: readonly Part[], selected: number | undefined, room: Room): void {
    this.#parts.clear();
    for (const part of parts) {
      const geometry = this.#shapes.get(part.model);
      const { outside, selected: chosen, part: usual } = this.#colours();
      const color = isOutside(part, room) ? outside : part.id === selected ? chosen : usual;
      const mesh = geometry === undefined ? boxOf(part) : new Mesh(geometry);
      mesh.material = new MeshLambertMaterial({ color, flatShading: true });
      mesh.matrixAutoUpdate = false;
      if (geometry !== undefined) mesh.matrix.fromArray([...part.matrix]);
      mesh.userData = { part: part.id };
      this.#parts.add(mesh);
    }
    const box = parts.find(({ id }) => id === selected)?.box;
    this.#frame.visible = box !== undefined;
    if (box !== undefined) this.#frame.box.set(new Vector3(...box.slice(0, 3)), new Vector3(...box.slice(3, 6)));
    this.redraw();
  }

  /** The plates that will hold the parts. */
  showSheets(sheets: readonly Sheet[]): void {
    this.#sheets.show(sheets);
    this.redraw();
  }

  /** Draws a part somewhere else for the moment, mm along the bed. */
  shift(id: number, x: number, y: number): void {
    const mesh = this.#parts.children.find((it) => it.userData['part'] === id);
    if (mesh !== undefined) {
      mesh.userData['rest'] ??= mesh.matrix.clone();
      mesh.matrix.copy(new Matrix4().makeTranslation(x, y, 0).multiply(mesh.userData['rest'] as Matrix4));
    }
    this.#frame.visible = false;
    this.redraw();
  }

  /** Either the parts or the beads are in sight. */
  turnTo(what: 'parts' | 'beads'): void {
    this.#parts.visible = what === 'parts';
    this.#sheets.group.visible = what === 'parts';
    this.#frame.visible &&= what === 'parts';
    this.#beads.group.visible = what === 'beads';
    this.redraw();
  }

  clearBeads(): void {
    this.#beads.clear();
    this.#pace = unhurried;
    this.redraw();
  }

  addBeads(moves: Moves, colours: Uint8Array<ArrayBuffer>): void {
    this.#beads.add(moves, colours);
    // Frames are slow while moves are read: that says nothing about the device.
    this.#pace = unhurried;
    this.#handsOver = true;
    this.redraw();
  }

  /** Colours the moves of the k-th `addBeads` anew. */
  colourBeads(k: number, indices: Uint8Array<ArrayBuffer>): void {
    this.#beads.colour(k, indices);
    this.#handsOver = true;
    this.redraw();
  }

  paintBeads(palette: Uint8Array<ArrayBuffer>, inside: Inside): void {
    this.#beads.paint(palette, inside);
    this.redraw();
  }

  showBeads(layer: number, moves: number): void {
    const [before, some] = this.#shown;
    if (layer !== before || moves !== some) this.#move();
    this.#shown = [layer, moves];
    this.#beads.show(layer, moves);
    this.redraw();
  }

  /** The nearest part at a spot of the picture. */
  pick(spot: Spot): Hit | undefined {
    this.#aim(spot);
    const meshes = this.#parts.children.filter((it): it is Mesh => it instanceof Mesh);
    const hits = meshes.flatMap((mesh) => {
      const part = Number(mesh.userData['part']);
      mesh.updateWorldMatrix(false, false);
      const large = (mesh.geometry.index?.count ?? 0) / 3 > MOST_PICKED;
      const [hit] = large ? [] : this.#ray.intersectObject(mesh, false);
      if (hit !== undefined) return [{ part, triangle: hit.faceIndex ?? 0, point: hit.point, distance: hit.distance }];
      const point = large ? this.#ray.ray.intersectBox(new Box3().setFromObject(mesh), new Vector3()) : null;
      return point === null ? [] : [{ part, triangle: -1, point, distance: point.distanceTo(this.#ray.ray.origin) }];
    });
    const nearest = hits.sort((a, b) => a.distance - b.distance)[0];
    return nearest && { part: nearest.part, triangle: nearest.triangle, at: nearest.point.toArray() };
  }

  /** Where the ray through a spot meets the plane at a height, mm; undefined above the horizon. */
  onPlane(spot: Spot, z: number): Point | undefined {
    this.#aim(spot);
    return this.#ray.ray.intersectPlane(new Plane(new Vector3(0, 0, 1), -z), new Vector3())?.toArray();
  }

  /** The spot that shows a point; undefined behind the eye. */
  spotOf([x, y, z]: Point): Spot | undefined {
    this.#camera.updateMatrixWorld();
    const at = new Vector3(x, y, z).project(this.#camera);
    if (at.z > 1) return undefined;
    return { x: ((at.x + 1) / 2) * this.#size.width, y: ((1 - at.y) / 2) * this.#size.height };
  }

  /** Draws a line between two points, or none. */
  measure(from: Point | undefined, to: Point | undefined): void {
    this.#ruler.visible = from !== undefined && to !== undefined;
    if (from !== undefined && to !== undefined) {
      this.#ruler.geometry.setFromPoints([new Vector3(...from), new Vector3(...to)]);
    }
    this.redraw();
  }

  /** The picture moves: a slow device draws less of it until it rests. */
  #move(): void {
    clearTimeout(this.#moving);
    this.#moving = window.setTimeout(this.#settle, STILL);
    this.#beads.coarse(this.#pace.detail);
  }

  /** The picture rests: all of it is drawn, unless frames still keep the next move waiting. */
  #settle = (): void => {
    if (!this.#queue.isEmpty()) {
      this.#moving = window.setTimeout(this.#settle, STILL);
      return;
    }
    this.#moving = 0;
    this.#pace = rested(this.#pace);
    this.#beads.coarse(0);
    this.redraw();
  };

  /** Draws in the next frame, or as soon as the graphics card has caught up. */
  redraw(): void {
    this.#stale = true;
    if (this.#waiting) return;
    this.#waiting = true;
    requestAnimationFrame(this.#step);
  }

  #step = (now: number): void => {
    this.#waiting = false;
    if (this.#orbit === undefined) return;
    this.#queue.settle(now, (ms) => this.#timed(ms));
    if (this.#stale && !this.#queue.isFull()) {
      this.#stale = false;
      this.#renderer.render(this.#scene, this.#camera);
      this.#queue.add(now, !this.#handsOver);
      this.#handsOver = this.#beads.thin(Math.max(THIN, this.#took / 2));
      this.#stale = this.#handsOver;
    }
    if (!this.#stale && this.#queue.isEmpty()) return;
    this.#waiting = true;
    requestAnimationFrame(this.#step);
  };

  /** A frame has been drawn, which took `ms`. */
  #timed(ms: number): void {
    this.#took = ms;
    if (!this.#beads.group.visible) return;
    this.#pace = this.#moving === 0 ? whole(this.#pace, ms) : paced(this.#pace, ms);
    if (this.#moving !== 0) this.#beads.coarse(this.#pace.detail);
  }

  /** Gives everything back; nothing is drawn any more. */
  dispose(): void {
    this.#orbit = undefined;
    clearTimeout(this.#moving);
    this.forget();
    this.#beads.clear();
    this.#renderer.dispose();
    this.#renderer.forceContextLoss();
  }

  #aim({ x, y }: Spot): void {
    const { width, height } = this.#size;
    this.#camera.updateMatrixWorld();
    this.#ray.setFromCamera(new Vector2((2 * x) / width - 1, 1 - (2 * y) / height), this.#camera);
  }

  #colours(): { ground: number; part: number; selected: number; outside: number } {
    return this.#dark ? colours.dark : colours.light;
  }
}

/** A part as the box around it. */
function boxOf({ box }: Part): Mesh {
  const [low, high] = [new Vector3(...box.slice(0, 3)), new Vector3(...box.slice(3, 6))];
  const size = high.clone().sub(low);
  const mesh = new Mesh(new BoxGeometry(size.x, size.y, size.z));
  mesh.matrix.makeTranslation(low.add(high).divideScalar(2));
  return mesh;
}
