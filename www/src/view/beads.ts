// Beads and travels in space: each move is a flat ribbon that faces the eye and is shaded like a round bead, so that a
// million moves are two million triangles. The vertex shader reads the moves from textures: an instance for each would
// be ten times as slow in software, and small instances suit no graphics card.
import {
  BufferAttribute,
  BufferGeometry,
  DataTexture,
  FloatType,
  GLSL3,
  Group,
  Mesh,
  NearestFilter,
  RawShaderMaterial,
  RedFormat,
  RGBAFormat,
  Sphere,
  Vector3,
} from 'three';
import type { Moves } from '../messages.ts';
import { type Inside, sharesOf } from './outside.ts';
import { COARSEST, type Detail, layersDrawnAs } from './pace.ts';

/** Moves in a row of the textures, as bits. */
const ROW_BITS = 10;
const ROW = 1 << ROW_BITS;

const vertex = `
#define ROW_BITS ${ROW_BITS}
#define ROW_MASK ${ROW - 1}
precision highp float;
uniform mat4 modelViewMatrix;
uniform mat4 projectionMatrix;
uniform highp sampler2D palette;
uniform float travelWidth;
uniform float layers;
uniform highp sampler2D places;
uniform highp sampler2D colours;
out vec3 tint;
out float across;
void main() {
  int move = gl_VertexID >> 2;
  vec2 position = vec2(gl_VertexID & 1, (gl_VertexID >> 1) & 1) * 2.0 - 1.0;
  ivec2 texel = ivec2(move & ROW_MASK, move >> ROW_BITS);
  vec4 first = texelFetch(places, ivec2(2 * texel.x, texel.y), 0);
  vec4 second = texelFetch(places, ivec2(2 * texel.x + 1, texel.y), 0);
  vec3 start = first.xyz;
  vec3 end = second.xyz;
  vec2 size = vec2(first.w, second.w);
  float colour = 255.0 * texelFetch(colours, texel, 0).r;
  vec4 entry = texelFetch(palette, ivec2(int(colour + 0.5), 0), 0);
  bool isTravel = size.x <= 0.0;
  // A bead may stand for those of the layers below it.
  float height = size.y * layers;
  float drop = height / 2.0;
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
  float radius = isTravel ? travelWidth * -here.z : 0.5 * mix(size.x, height, rise);
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

/** The ribbons of some layers; `ends[k]` moves come before the end of layer k of them. */
interface Ribbons {
  readonly mesh: Mesh<BufferGeometry>;
  readonly places: DataTexture;
  /** Index into the palette of each move; what follows is not drawn. */
  readonly indices: Uint8Array<ArrayBuffer>;
  readonly colours: DataTexture;
  readonly ends: Uint32Array;
}

/** Some of a batch's moves. */
interface Share extends Ribbons {
  /** Positions of these moves among all. */
  readonly kept: Uint32Array;
}

interface Batch {
  readonly moves: Moves;
  readonly all: Ribbons;
  /**
   * What is seen from outside, for devices that are too slow to draw all while the picture moves: every layer that
   * only detail 1 shows, then those that detail 2 adds to 3, 3 to 4, what 4 shows, and the layer on the bed.
   */
  outside?: readonly Share[];
}

export class Beads {
  readonly group = new Group();
  readonly #material: RawShaderMaterial;
  /** Draws beads as high as the layers that they stand for. */
  readonly #coarseMaterial: RawShaderMaterial;
  readonly #palette = new DataTexture(new Uint8Array(4 * 256), 256, 1);
  /** Two triangles for each ribbon; shared by all that have no more. */
  #triangles = trianglesOf(ROW);
  #batches: Batch[] = [];
  #shown: readonly [layer: number, moves: number] = [0, 0];
  #detail: Detail = 0;
  #inside: Inside = { covered: new Set(), hidden: new Set() };

  constructor() {
    this.#palette.minFilter = NearestFilter;
    this.#palette.magFilter = NearestFilter;
    this.#material = this.#beadsOf(1);
    this.#coarseMaterial = this.#beadsOf(1);
  }

  /** A material whose beads stand for so many layers. */
  #beadsOf(layers: number): RawShaderMaterial {
    return new RawShaderMaterial({
      glslVersion: GLSL3,
      vertexShader: vertex,
      fragmentShader: fragment,
      uniforms: {
        palette: { value: this.#palette },
        travelWidth: { value: 0.0007 },
        layers: { value: layers },
        places: { value: null },
        colours: { value: null },
      },
      side: 2,
    });
  }

  /** Adds the moves of further layers, with an index into the palette each. */
  add(moves: Moves, colours: Uint8Array<ArrayBuffer>): void {
    this.#batches.push({ moves, all: this.#ribbons(moves, colours, this.#material) });
  }

  #ribbons(
    { ends, sizes, layers }: Pick<Moves, 'ends' | 'sizes' | 'layers'>,
    colours: Uint8Array<ArrayBuffer>,
    material: RawShaderMaterial,
  ): Ribbons {
    const count = colours.length;
    const rows = Math.max(Math.ceil(count / ROW), 1);
    if (this.#triangles.count < 6 * count) this.#triangles = trianglesOf(rows * ROW);
    const places = new DataTexture(placesOf(ends, sizes, rows), 2 * ROW, rows, RGBAFormat, FloatType);
    const indices = new Uint8Array(rows * ROW);
    indices.set(colours);
    const tints = new DataTexture(indices, ROW, rows, RedFormat);
    places.needsUpdate = true;
    tints.needsUpdate = true;
    const geometry = new BufferGeometry();
    geometry.setIndex(this.#triangles);
    geometry.setDrawRange(0, 6 * count);
    // There are no vertices that say where the ribbons are.
    geometry.boundingSphere = new Sphere(new Vector3(), Number.POSITIVE_INFINITY);
    const mesh = new Mesh(geometry, material);
    mesh.frustumCulled = false;
    mesh.onBeforeRender = () => {
      const { uniforms } = material;
      if (uniforms['places']) uniforms['places'].value = places;
      if (uniforms['colours']) uniforms['colours'].value = tints;
      material.uniformsNeedUpdate = true;
    };
    this.group.add(mesh);
    return { mesh, places, indices, colours: tints, ends: layers };
  }

  /** Colours batch `k` anew. */
  colour(k: number, indices: Uint8Array<ArrayBuffer>): void {
    const { all, outside } = this.#batches[k] ?? {};
    if (all === undefined) return;
    all.indices.set(indices);
    all.colours.needsUpdate = true;
    for (const share of outside ?? []) {
      share.indices.set(picked(indices, 1, share.kept));
      share.colours.needsUpdate = true;
    }
  }

  /** Draws so much of the beads; what is seen from outside as far as `thin` has found it. */
  coarse(detail: Detail): void {
    if (detail === this.#detail) return;
    this.#detail = detail;
    this.#coarseMaterial.uniforms['layers'] = { value: layersDrawnAs(detail) };
    this.#show();
  }

  /**
   * Finds what is seen from outside for some more batches, `time` ms long, so that no frame waits for all; whether
   * there were any.
   */
  thin(time: number): boolean {
    if (this.#detail === 0) return false;
    const waiting = this.#batches.filter(({ outside }) => outside === undefined);
    const end = performance.now() + time;
    for (const batch of waiting) {
      batch.outside = this.#outside(batch);
      if (performance.now() > end) break;
    }
    if (waiting.length > 0) this.#show();
    return waiting.length > 0;
  }

  paint(palette: Uint8Array<ArrayBuffer>, inside: Inside): void {
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
    for (const {
      all,
      outside,
      moves: { layers },
    } of this.#batches) {
      const inside = layer - first;
      first += layers.length;
      // The batch that ends the picture is whole: its moves are counted among all, and one looks at its top.
      const isCoarse = this.#detail > 0 && outside !== undefined && inside >= layers.length;
      all.mesh.visible = !isCoarse && showUpTo(all, inside, moves);
      for (const [k, share] of (outside ?? []).entries()) {
        share.mesh.visible = isCoarse && k + 1 >= this.#detail && share.kept.length > 0;
      }
    }
  }

  #outside(batch: Batch): Share[] {
    const { moves, all } = batch;
    const k = this.#batches.indexOf(batch);
    return sharesOf(moves, this.#inside, k === 0, this.#batches[k + 1]?.moves).map((kept, share) => {
      const some = { layers: moves.layers, ends: picked(moves.ends, 6, kept), sizes: picked(moves.sizes, 2, kept) };
      // What lies on the bed stands for no layers below it.
      const material = share < COARSEST ? this.#coarseMaterial : this.#material;
      return { ...this.#ribbons(some, picked(all.indices, 1, kept), material), kept };
    });
  }

  clear(): void {
    for (const { all, outside } of this.#batches) {
      this.#drop(all);
      for (const share of outside ?? []) this.#drop(share);
    }
    this.#batches = [];
  }

  #drop({ mesh, places, colours }: Ribbons): void {
    this.group.remove(mesh);
    mesh.geometry.dispose();
    places.dispose();
    colours.dispose();
  }
}

/** The corners of so many ribbons' triangles: four each. */
function trianglesOf(count: number): BufferAttribute {
  const corners = new Uint32Array(6 * count);
  for (let k = 0; k < count; k++) corners.set([4 * k, 4 * k + 1, 4 * k + 2, 4 * k + 2, 4 * k + 1, 4 * k + 3], 6 * k);
  return new BufferAttribute(corners, 1);
}

/** Two texels for each move: start and width, end and height. */
function placesOf(ends: Float32Array, sizes: Float32Array, rows: number): Float32Array<ArrayBuffer> {
  const places = new Float32Array(8 * ROW * rows);
  for (let k = 0; k < sizes.length; k++) {
    const [from, to] = [3 * k, 4 * k];
    for (let i = 0; i < 3; i++) places[to + i] = ends[from + i] ?? 0;
    places[to + 3] = sizes[k] ?? 0;
  }
  return places;
}

/** Cuts the ribbons after layer `inside` and its first `moves`; whether there is any left. */
function showUpTo({ mesh, ends }: Ribbons, inside: number, moves: number): boolean {
  const total = ends.at(-1) ?? 0;
  const before = ends[inside - 1] ?? 0;
  const shown = inside < 0 ? 0 : inside >= ends.length ? total : Math.min(before + moves, ends[inside] ?? total);
  mesh.geometry.setDrawRange(0, 6 * shown);
  return shown > 0;
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
