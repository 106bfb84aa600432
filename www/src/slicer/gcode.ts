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

/** The size of the file in bytes. */
export function sizeOf(gcode: Gcode): number {
  return partsOf(gcode).reduce((total, part) => total + part.length, 0);
}

/** A layer's height above the bed, mm, as its text says it near its beginning; empty when it does not. */
export function heightOf(layer: Uint8Array): string {
  const start = new TextDecoder().decode(layer.subarray(0, 256));
  return /^;Z:([\d.]+)/m.exec(start)?.[1] ?? '';
}
