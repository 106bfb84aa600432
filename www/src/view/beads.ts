// Beads and travels in space: each move is one instance of a flat ribbon that faces the eye and is shaded like
// a round bead, so that a million moves are two million triangles.
import {
  BufferAttribute,
  DataTexture,
  GLSL3,
  Group,
  InstancedBufferAttribute,
  InstancedBufferGeometry,
  InstancedInterleavedBuffer,
  InterleavedBufferAttribute,
  Mesh,
  NearestFilter,
  RawShaderMaterial,
  Sphere,
  Vector3,
} from 'three';
import type { Moves } from '../messages.ts';

const vertex = `
precision highp float;
uniform mat4 modelViewMatrix;
uniform mat4 projectionMatrix;
uniform highp sampler2D palette;
uniform float travelWidth;
in vec2 position;
in vec3 start;
in vec3 end;
in vec2 size;
in float colour;
out vec3 tint;
out float across;
void main() {
  vec4 entry = texelFetch(palette, ivec2(int(colour + 0.5), 0), 0);
  bool isTravel = size.x <= 0.0;
  float drop = size.y / 2.0;
  vec3 a = (modelViewMatrix * vec4(start.xy, start.z - (isTravel ? 0.0 : drop), 1.0)).xyz;
  vec3 b = (modelViewMatrix * vec4(end.xy, end.z - (isTravel ? 0.0 : drop), 1.0)).xyz;
  vec3 axis = b - a;
  float len = max(length(axis), 1e-6);
  axis /= len;
  vec3 here = position.x < 0.0 ? a : b;
  vec3 side = cross(axis, normalize(-here));
  float bent = length(side);
  side = bent > 1e-4 ? side / bent : vec3(1.0, 0.0, 0.0);
  // The bead is as wide as it is across the bed and as high as its layer.
  vec3 up = normalize((modelViewMatrix * vec4(0.0, 0.0, 1.0, 0.0)).xyz);
  float rise = abs(dot(side, up));
  float radius = isTravel ? travelWidth * -here.z : 0.5 * mix(size.x, size.y, rise);
  float cap = isTravel ? 0.0 : 0.35 * size.x;
  vec3 at = here + side * radius * position.y + axis * cap * position.x;
  gl_Position = entry.a < 0.5 ? vec4(2.0, 2.0, 2.0, 1.0) : projectionMatrix * vec4(at, 1.0);
  vec3 facing = normalize(cross(side, axis));
  float light = isTravel ? 1.0 : 0.62 + 0.38 * abs(dot(facing, up));
  tint = entry.rgb * light;
  across = isTravel ? 0.0 : position.y;
}`;

const fragment = `
precision mediump float;
in vec3 tint;
in float across;
out vec4 colour;
void main() {
  colour = vec4(tint * (0.66 + 0.34 * sqrt(1.0 - min(across * across, 1.0))), 1.0);
}`;

/** Some layers as instances; `ends[k]` moves come before the end of layer k of them. */
interface Instances {
  readonly mesh: Mesh<InstancedBufferGeometry>;
  readonly colours: InstancedBufferAttribute;
  readonly ends: Uint32Array;
}

interface Batch {
  readonly moves: Moves;
  readonly all: Instances;
  /** What is seen from outside, for devices that are too slow to draw all while the picture moves. */
  outside?: Instances & {
    /** Positions of these moves among all. */
    readonly kept: Uint32Array;
  };
}

export class Beads {
  readonly group = new Group();
  readonly #material: RawShaderMaterial;
  readonly #palette = new DataTexture(new Uint8Array(4 * 256), 256, 1);
  readonly #corners = new BufferAttribute(new Float32Array([-1, -1, 1, -1, -1, 1, 1, 1]), 2);
  readonly #triangles = new BufferAttribute(new Uint16Array([0, 1, 2, 2, 1, 3]), 1);
  #batches: Batch[] = [];
  #shown: readonly [layer: number, moves: number] = [0, 0];
  #coarse = false;
  #inside: ReadonlySet<number> = new Set();

  constructor() {
    this.#palette.minFilter = NearestFilter;
    this.#palette.magFilter = NearestFilter;
    this.#material = new RawShaderMaterial({
      glslVersion: GLSL3,
      vertexShader: vertex,
      fragmentShader: fragment,
      uniforms: { palette: { value: this.#palette }, travelWidth: { value: 0.0007 } },
      side: 2,
    });
  }

  /** Adds the moves of further layers, with an index into the palette each. */
  add(moves: Moves, colours: Uint8Array<ArrayBuffer>): void {
    this.#batches.push({ moves, all: this.#instances(moves, colours) });
  }

  #instances(moves: Moves, colours: Uint8Array<ArrayBuffer>): Instances {
    const geometry = new InstancedBufferGeometry();
    geometry.setAttribute('position', this.#corners);
    geometry.setIndex(this.#triangles);
    const places = new InstancedInterleavedBuffer(moves.ends, 6);
    geometry.setAttribute('start', new InterleavedBufferAttribute(places, 3, 0));
    geometry.setAttribute('end', new InterleavedBufferAttribute(places, 3, 3));
    geometry.setAttribute('size', new InstancedBufferAttribute(moves.sizes, 2));
    const colour = new InstancedBufferAttribute(colours, 1);
    geometry.setAttribute('colour', colour);
    geometry.instanceCount = moves.speeds.length;
    // The corners say nothing about where the instances are.
    geometry.boundingSphere = new Sphere(new Vector3(), Number.POSITIVE_INFINITY);
    const mesh = new Mesh(geometry, this.#material);
    mesh.frustumCulled = false;
    this.group.add(mesh);
    return { mesh, colours: colour, ends: moves.layers };
  }

  /** Colours batch `k` anew. */
  colour(k: number, indices: Uint8Array<ArrayBuffer>): void {
    const { all, outside } = this.#batches[k] ?? {};
    if (all === undefined) return;
    all.colours.array.set(indices);
    all.colours.needsUpdate = true;
    if (outside === undefined) return;
    outside.colours.array.set(picked(indices, 1, outside.kept));
    outside.colours.needsUpdate = true;
  }

  /** Draws only what is seen from outside, as far as `thin` has found it, or all again. */
  coarse(on: boolean): void {
    if (on === this.#coarse) return;
    this.#coarse = on;
    this.#show();
  }

  /** Finds what is seen from outside for one more batch, so that no frame waits for all; whether there was one. */
  thin(): boolean {
    const batch = this.#coarse ? this.#batches.find(({ outside }) => outside === undefined) : undefined;
    if (batch === undefined) return false;
    batch.outside = this.#outside(batch);
    this.#show();
    return true;
  }

  /** `inside`: the indices of beads that are not seen from outside. */
  paint(palette: Uint8Array<ArrayBuffer>, inside: ReadonlySet<number>): void {
    this.#inside = inside;
    this.#palette.image.data?.set(palette);
    this.#palette.needsUpdate = true;
  }

  /** Shows the layers below `layer` and the first `moves` of it. */
  show(layer: number, moves: number): void {
    this.#shown = [layer, moves];
    this.#show();
  }

  #show(): void {
    const [layer, moves] = this.#shown;
    let first = 0;
    for (const batch of this.#batches) {
      const inside = layer - first;
      first += batch.moves.layers.length;
      const { all, outside } = batch;
      const isCoarse = this.#coarse && outside !== undefined;
      all.mesh.visible = !isCoarse && showUpTo(all, inside, moves);
      // Moves are counted among all; a coarse layer is shown whole.
      if (outside !== undefined) {
        outside.mesh.visible = isCoarse && showUpTo(outside, inside, Number.POSITIVE_INFINITY);
      }
    }
  }

  #outside({ moves, all }: Batch): NonNullable<Batch['outside']> {
    const colours = all.colours.array as Uint8Array<ArrayBuffer>;
    const kept = outsideOf(moves, this.#inside);
    let at = 0;
    const layers = moves.layers.map((end) => {
      while (at < kept.length && (kept[at] ?? 0) < end) at++;
      return at;
    });
    const some = { ...moves, layers, ends: picked(moves.ends, 6, kept), sizes: picked(moves.sizes, 2, kept) };
    const speeds = new Float32Array(kept.length);
    return { ...this.#instances({ ...some, speeds }, picked(colours, 1, kept)), kept };
  }

  clear(): void {
    for (const { all, outside } of this.#batches) {
      this.#drop(all);
      if (outside !== undefined) this.#drop(outside);
    }
    this.#batches = [];
  }

  #drop({ mesh }: Instances): void {
    this.group.remove(mesh);
    mesh.geometry.dispose();
  }
}

/** Cuts the instances after layer `inside` and its first `moves`; whether there is any left. */
function showUpTo({ mesh, ends }: Instances, inside: number, moves: number): boolean {
  const total = ends.at(-1) ?? 0;
  const before = ends[inside - 1] ?? 0;
  const shown = inside < 0 ? 0 : inside >= ends.length ? total : Math.min(before + moves, ends[inside] ?? total);
  mesh.geometry.instanceCount = shown;
  return shown > 0;
}

/** Positions of the moves that can be seen from outside. */
function outsideOf({ roles, sizes }: Moves, inside: ReadonlySet<number>): Uint32Array {
  const isInside = Uint8Array.from({ length: 256 }, (_, role) => (inside.has(role) ? 1 : 0));
  const kept = new Uint32Array(roles.length);
  let count = 0;
  for (let k = 0; k < roles.length; k++) {
    if ((sizes[2 * k] ?? 0) > 0 && isInside[roles[k] ?? 0] === 0) kept[count++] = k;
  }
  return kept.slice(0, count);
}

/** The entries of `kept`, `width` numbers each. */
function picked<A extends Float32Array | Uint8Array>(from: A, width: number, kept: Uint32Array): A {
  const to = from.slice(0, kept.length * width) as A;
  for (let k = 0, at = 0; k < kept.length; k++) {
    const start = (kept[k] ?? 0) * width;
    for (let i = 0; i < width; i++) to[at++] = from[start + i] ?? 0;
  }
  return to;
}
