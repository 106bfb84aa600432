// The G-code of a finished job: the layers' texts as the lanes made them, and what joins them.
import type { GcodeIndex, Joined } from '../messages.ts';

/** The texts of all layers, in order, and the glue between them. */
export interface Gcode {
  readonly layers: readonly Uint8Array<ArrayBuffer>[];
  readonly joined: Joined;
  /** In a file that was opened: what is to be read before each layer when it is read alone. */
  readonly heads?: readonly string[];
}

/** An opened file, whose layers begin where `index` says. */
export function openedGcode(file: Uint8Array<ArrayBuffer>, fileName: string, index: GcodeIndex): Gcode {
  const { figures, offsets, heads, times } = index;
  const starts = [...offsets, file.length];
  const layers = heads.map((_, k) => file.subarray(starts[k], starts[k + 1]));
  const glue = file.subarray(0, starts[0]);
  const pieces = Uint32Array.from([0, 0, glue.length, ...layers.flatMap((text, k) => [k + 1, 0, text.length])]);
  return { layers, heads, joined: { report: figures, fileName, glue, pieces, times, marks: new Uint8Array() } };
}

/** The file's parts in order, as views: no text is copied. */
export function partsOf({ layers, joined }: Gcode): Uint8Array<ArrayBuffer>[] {
  const { pieces, glue } = joined;
  return Array.from({ length: pieces.length / 3 }, (_, k) => {
    const [source = 0, from = 0, to = 0] = pieces.subarray(3 * k, 3 * k + 3);
    const text = source === 0 ? glue : layers[source - 1];
    if (text === undefined) throw new Error(`the join names layer ${source - 1}, which was not sliced`);
    return text.subarray(from, to);
  });
}

const encoder = new TextEncoder();

/** Extrusion is relative: the file says so in its header, a layer read alone needs to hear it. */
const RELATIVE = encoder.encode('M83\n');

/** A layer to be read alone: from the joining text in front of it, which moves the head there, to its end. */
export function layerOf(gcode: Gcode, layer: number): Uint8Array {
  return layersOf(gcode, layer, layer + 1);
}

/** The layers from `first` to `last`, without `last`, to be read alone. */
export function layersOf(gcode: Gcode, first: number, last: number): Uint8Array<ArrayBuffer> {
  const { heads, layers } = gcode;
  if (heads !== undefined) {
    const alone = layers.slice(first, last).map((text, k) => [encoder.encode(heads[first + k]), text]);
    return joined(alone.flat());
  }
  const { pieces } = gcode.joined;
  const sources = pieces.filter((_, k) => k % 3 === 0);
  const start = sources.indexOf(first + 1);
  const before = start > 0 && sources[start - 1] === 0 ? start - 1 : start;
  const parts = partsOf(gcode).slice(before, sources.lastIndexOf(last) + 1);
  return joined([RELATIVE, encoder.encode(switchedBefore(gcode, first)), ...parts]);
}

/** The lines that last set the fan and chose the tool. */
interface Switched {
  readonly fan: string;
  readonly tool: string;
}

/** What is switched after each layer, as far as it has been asked for. */
const switched = new WeakMap<Gcode, Switched[]>();

/** The lines that bring a reader of layer `layer` alone to the fan's speed and the tool of the whole file. */
function switchedBefore(gcode: Gcode, layer: number): string {
  const known = switched.get(gcode) ?? [];
  switched.set(gcode, known);
  const parts = partsOf(gcode);
  const sources = gcode.joined.pieces.filter((_, k) => k % 3 === 0);
  for (let k = known.length; k < layer; k++) {
    const some = parts.slice(k === 0 ? 0 : sources.lastIndexOf(k) + 1, sources.lastIndexOf(k + 1) + 1);
    known.push(some.reduce(switchedIn, known[k - 1] ?? { fan: '', tool: '' }));
  }
  const { fan, tool } = known[layer - 1] ?? { fan: '', tool: '' };
  return fan + tool;
}

function switchedIn({ fan, tool }: Switched, text: Uint8Array): Switched {
  return { fan: lastLine(text, 'M', /^M10[67]\b/) ?? fan, tool: lastLine(text, 'T', /^T\d/) ?? tool };
}

const NEW_LINE = 0x0a;

/** The last line that begins with `letter` and is as `pattern` says. */
function lastLine(text: Uint8Array, letter: string, pattern: RegExp): string | undefined {
  const code = letter.charCodeAt(0);
  for (let at = text.lastIndexOf(code); at >= 0; at = at === 0 ? -1 : text.lastIndexOf(code, at - 1)) {
    if (at > 0 && text[at - 1] !== NEW_LINE) continue;
    const end = text.indexOf(NEW_LINE, at);
    const line = new TextDecoder().decode(text.subarray(at, end < 0 ? text.length : end));
    if (pattern.test(line)) return `${line}\n`;
  }
  return undefined;
}

function joined(parts: readonly Uint8Array[]): Uint8Array<ArrayBuffer> {
  const all = new Uint8Array(parts.reduce((total, part) => total + part.length, 0));
  let at = 0;
  for (const part of parts) {
    all.set(part, at);
    at += part.length;
  }
  return all;
}

/** The height stands within so many bytes of a layer's text, unless a long start code comes before it. */
const HEAD = 4096;

/** A layer's height above the bed, mm, as its text says it; empty when it does not. */
export function heightOf(layer: Uint8Array): string {
  const found = (text: Uint8Array): string | undefined => /^;Z:([\d.]+)\n/m.exec(new TextDecoder().decode(text))?.[1];
  const height = found(layer.subarray(0, HEAD)) ?? found(layer) ?? '';
  return height.replace(/\.0*$|(\.\d*?)0+$/, '$1');
}
