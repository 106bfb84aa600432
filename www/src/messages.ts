// The one list of what the page (or the command line) and the lanes that run the engine say to each other.
// A lane answers each request with a reply of the same kind, or with a failure.
import type { Question } from './studies.ts';

/** Layers `first` to `last`, without `last`. */
export interface Range {
  readonly first: number;
  readonly last: number;
}

/** The part of Blob that reading a model needs; the command line gives a file on disk this shape. */
export interface Bytes {
  readonly size: number;
  slice(from: number, to: number): { arrayBuffer(): Promise<ArrayBuffer> };
}

/** A model file that can be read again at any time: a new lead reloads it after a cancel or a crash. */
export interface ModelSource {
  readonly name: string;
  readonly file: Bytes;
}

export type PictureView = 'iso' | 'top' | 'front';
export type Theme = 'light' | 'dark';

/** What the engine's painter takes: CSS px per mm, centre x and y (mm), width and height (CSS px), pixel ratio. */
export type CameraNumbers = readonly [number, number, number, number, number, number];

/** Smallest x and y, largest x and y, mm. */
export type Bounds = readonly [number, number, number, number];

/** What one colour of a picture stands for. */
export interface LegendEntry {
  readonly role: string;
  readonly color: string;
  readonly length_mm: number;
}

/** The vector of a model that points up. */
export type Up = readonly [number, number, number];

/** One direction to be evaluated; ids count from 1. */
export interface Evaluation {
  readonly settings: string;
  readonly id: number;
  readonly up: Up;
}

/** Which models stand on the bed: positions in the list of open models, each as often as it is there. */
export interface Standing {
  readonly models: readonly number[];
  /** 16 numbers for each, the columns of its matrix from file to bed coordinates; empty: the engine arranges them. */
  readonly placements: readonly number[];
  /** The own settings of each, JSON; empty: none has any. */
  readonly own?: readonly string[];
}

/** A change to where a part stands; the engine's `Edit`. */
export type Edit =
  | { readonly kind: 'drop' }
  | { readonly kind: 'turn'; readonly axis: number; readonly angle_deg: number }
  | { readonly kind: 'scale'; readonly factors: readonly [number, number, number] }
  | { readonly kind: 'mirror'; readonly axis: number }
  | { readonly kind: 'lay_flat'; readonly triangle: number }
  | { readonly kind: 'turn_up'; readonly up: readonly number[] };

/** Requests to the lead lane, which holds the models and the job. */
export type LeadRequest =
  /** Reads models; the first `keep` are open already. */
  | { readonly kind: 'open'; readonly sources: readonly ModelSource[]; readonly keep: number }
  /** Takes a file of another format apart into one STL for each part. */
  | { readonly kind: 'unpack'; readonly source: ModelSource }
  /** All models as they stand, in one STL. */
  | { readonly kind: 'stl'; readonly settings: string; readonly standing?: Standing | undefined }
  /** Reads a G-code file; `settings` tell its filament where it does not itself. */
  | { readonly kind: 'gcode'; readonly source: ModelSource; readonly settings: string }
  | { readonly kind: 'shape'; readonly model: number }
  /** Without `edit` the placement stays as it is. */
  | { readonly kind: 'edit'; readonly model: number; readonly matrix: readonly number[]; readonly edit?: Edit }
  | {
      readonly kind: 'arrange';
      readonly placements: readonly number[];
      readonly boxes: readonly number[];
      readonly settings: string;
      /** As in a Standing. */
      readonly own: readonly string[];
    }
  | { readonly kind: 'settings'; readonly files: readonly string[]; readonly sets: readonly string[] }
  /** Own settings of a model, without those of the plate. */
  | { readonly kind: 'own'; readonly files: readonly string[]; readonly sets: readonly string[] }
  | { readonly kind: 'begin'; readonly settings: string; readonly standing?: Standing | undefined }
  | { readonly kind: 'prepare' }
  | { readonly kind: 'share'; readonly range: Range }
  | { readonly kind: 'slice'; readonly range: Range }
  | { readonly kind: 'add'; readonly meta: Uint8Array }
  | { readonly kind: 'finish' }
  | { readonly kind: 'end' }
  | { readonly kind: 'drawLayer'; readonly layer: number }
  | { readonly kind: 'drawPlane'; readonly spec: string }
  /** The directions of a model to compare; `all` as well those that may only be shown, not chosen. */
  | { readonly kind: 'directions'; readonly model: number; readonly settings: string; readonly all: boolean }
  | ({ readonly kind: 'evaluate'; readonly model: number } & Evaluation)
  | {
      readonly kind: 'choose';
      readonly model: number;
      readonly settings: string;
      readonly figures: readonly Uint8Array[];
    }
  | { readonly kind: 'mesh'; readonly model: number }
  | { readonly kind: 'compare' }
  | { readonly kind: 'picture'; readonly view: PictureView; readonly standing?: Standing | undefined }
  | {
      readonly kind: 'study';
      readonly settings: string;
      readonly question: Question;
      readonly standing?: Standing | undefined;
    }
  | {
      readonly kind: 'thumbnail';
      readonly model: number;
      readonly up: readonly number[];
      readonly width: number;
      readonly height: number;
    }
  | { readonly kind: 'paint'; readonly camera: CameraNumbers; readonly theme: Theme };

export type LeadReply =
  | { readonly kind: 'open'; readonly inspections: readonly string[]; readonly parse_ms: number }
  | { readonly kind: 'unpack'; readonly sources: readonly ModelSource[] }
  | { readonly kind: 'stl'; readonly stl: Uint8Array<ArrayBuffer> }
  | ({ readonly kind: 'gcode' } & GcodeIndex)
  | ({ readonly kind: 'shape' } & Shape)
  /** The matrix, 16 numbers, and the box around the part: lowest x y z, highest x y z, mm. */
  | { readonly kind: 'edit'; readonly stand: Float64Array }
  | { readonly kind: 'arrange'; readonly placements: Float64Array }
  | { readonly kind: 'settings'; readonly settings: string }
  | { readonly kind: 'own'; readonly settings: string }
  /** Layers of the part alone; what is laid below it adds to them when the job is prepared. */
  | { readonly kind: 'begin'; readonly partLayers: number }
  | { readonly kind: 'prepare'; readonly layers: number }
  | { readonly kind: 'share'; readonly share: Uint8Array }
  | ({ readonly kind: 'slice' } & SlicedRange)
  | { readonly kind: 'add' }
  | ({ readonly kind: 'finish' } & Joined)
  | { readonly kind: 'end' }
  | { readonly kind: 'drawLayer'; readonly svg: string }
  | { readonly kind: 'drawPlane'; readonly svg: string }
  | { readonly kind: 'directions'; readonly ups: readonly Up[] }
  | { readonly kind: 'evaluate'; readonly figures: Uint8Array }
  | { readonly kind: 'choose'; readonly report: string }
  | { readonly kind: 'mesh'; readonly mesh: Uint8Array }
  | { readonly kind: 'compare'; readonly report: string }
  | { readonly kind: 'study'; readonly answer: string }
  /** RGBA, row by row from the top. */
  | { readonly kind: 'thumbnail'; readonly pixels: Uint8Array }
  | { readonly kind: 'picture'; readonly bounds: Bounds }
  | { readonly kind: 'paint'; readonly bitmap: ImageBitmap };

/** A G-code file of any slicer. */
export interface GcodeIndex {
  /** The engine's `GcodeFigures`, JSON. */
  readonly figures: string;
  /** The byte at which each layer begins. */
  readonly offsets: Float64Array;
  /** What is to be read before each layer when it is read alone. */
  readonly heads: readonly string[];
  /** Seconds that each layer takes. */
  readonly times: Float64Array;
}

/** A model's triangles in its file's coordinates. */
export interface Shape {
  /** xyz triples, mm. */
  readonly positions: Float32Array<ArrayBuffer>;
  /** Three vertices a triangle. */
  readonly indices: Uint32Array<ArrayBuffer>;
}

/** The G-code of some layers; layer i of them is `text[offsets[i]..offsets[i + 1]]`. */
export interface SlicedRange {
  readonly text: Uint8Array<ArrayBuffer>;
  readonly offsets: Uint32Array;
}

/**
 * What joins the layers: `pieces` are triples (source, from, to) in the order of the file; source 0 is `glue`,
 * source k + 1 the text of layer k.
 */
export interface Joined {
  readonly report: string;
  readonly fileName: string;
  readonly glue: Uint8Array<ArrayBuffer>;
  readonly pieces: Uint32Array;
  /** Seconds that each layer takes. */
  readonly times: Float64Array;
  /** What the picture of the first layer shows besides its paths. */
  readonly marks: Uint8Array;
}

/** Requests to a helper lane, which keeps nothing between them but the mesh whose directions it evaluates. */
export type HelperRequest =
  | { readonly kind: 'slice'; readonly share: Uint8Array }
  | { readonly kind: 'mesh'; readonly mesh: Uint8Array }
  | ({ readonly kind: 'evaluate' } & Evaluation);
export type HelperReply =
  | ({ readonly kind: 'slice'; readonly meta: Uint8Array } & SlicedRange)
  | { readonly kind: 'mesh' }
  | { readonly kind: 'evaluate'; readonly figures: Uint8Array };

/** The moves of some layers in the order of the text; the arrays are described at the engine's `Moves`. */
export interface Moves {
  readonly ends: Float32Array;
  readonly sizes: Float32Array;
  readonly roles: Uint8Array;
  readonly speeds: Float32Array;
  readonly flows: Float32Array;
  readonly fans: Uint8Array;
  readonly tools: Uint8Array;
  readonly layers: Uint32Array;
}

/** Requests to the view lane, which owns the canvas of the layer view. */
export type ViewRequest =
  | { readonly kind: 'canvas'; readonly canvas: OffscreenCanvas }
  | { readonly kind: 'roles' }
  | { readonly kind: 'layer'; readonly text: Uint8Array; readonly settings: string; readonly marks: Uint8Array }
  | { readonly kind: 'moves'; readonly text: Uint8Array; readonly settings: string }
  | { readonly kind: 'paint'; readonly camera: CameraNumbers; readonly theme: Theme };

export type ViewReply =
  | { readonly kind: 'canvas' }
  /** All roles as the moves count them, JSON: a list of {role, color}. */
  | { readonly kind: 'roles'; readonly roles: string }
  | { readonly kind: 'layer'; readonly bounds: Bounds; readonly legend: readonly LegendEntry[] }
  | ({ readonly kind: 'moves' } & Moves)
  | { readonly kind: 'paint' };

export interface Tagged {
  readonly kind: string;
}

/** The reply to a request of kind `K`. */
export type ReplyTo<A extends Tagged, K extends string> = Extract<A, { readonly kind: K }>;

/** A failed request. A lane with a `fatal` failure is not trusted any more. */
export interface Failure {
  readonly name: string;
  readonly message: string;
  readonly source?: string;
  /** A change to every part, the engine's `Edit` as JSON, that would mend it. */
  readonly fix?: string;
  readonly fatal: boolean;
}

/** What goes over the wire to a lane in another thread, and what comes back. */
export type ToLane<Q extends Tagged> =
  /** The engine's code, and the address of the module for files of other programs where the lane may need it. */
  | { readonly start: WebAssembly.Module; readonly files?: string | undefined }
  | { readonly id: number; readonly request: Q };
export type FromLane<A extends Tagged> =
  | { readonly id: number; readonly reply: A }
  | { readonly id: number; readonly failure: Failure };
