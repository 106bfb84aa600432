// The G-code of a finished job: the layers' texts as the lanes made them, and what joins them.
import type { Joined } from '../messages.ts';

/** The texts of all layers, in order, and the glue between them. */
export interface Gcode {
  readonly layers: readonly Uint8Array<ArrayBuffer>[];
  readonly joined: Joined;
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

/** Extrusion is relative: the file says so in its header, a layer read alone needs to hear it. */
const RELATIVE = new TextEncoder().encode('M83\n');

/** A layer to be read alone: from the joining text in front of it, which moves the head there, to its end. */
export function layerOf(gcode: Gcode, layer: number): Uint8Array {
  return layersOf(gcode, layer, layer + 1);
}

/** The layers from `first` to `last`, without `last`, to be read alone. */
export function layersOf(gcode: Gcode, first: number, last: number): Uint8Array<ArrayBuffer> {
  const { pieces } = gcode.joined;
  const sources = pieces.filter((_, k) => k % 3 === 0);
  const start = sources.indexOf(first + 1);
  const before = start > 0 && sources[start - 1] === 0 ? start - 1 : start;
  const parts = partsOf(gcode).slice(before, sources.lastIndexOf(last) + 1);
  return joined([RELATIVE, ...parts]);
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
  return found(layer.subarray(0, HEAD)) ?? found(layer) ?? '';
}
