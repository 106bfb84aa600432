// The text of a job in pieces, as the engine pulls it.

/** Gives the next piece, undefined at the end. */
export type Pull = () => Uint8Array | undefined;

/** Makes a new reading from the start each time. */
export type Source = () => Pull;

/** Bytes read at a time. */
const PIECE = 1 << 16;

/** In a worker: read when it is wanted, so that no more than a piece is held. */
export function sourceOfBlob(text: Blob, read: (part: Blob) => ArrayBuffer): Source {
  return () => {
    let at = 0;
    return () => {
      if (at >= text.size) return undefined;
      const piece = new Uint8Array(read(text.slice(at, at + PIECE)));
      at += PIECE;
      return piece;
    };
  };
}

/** In the page, where nothing can be read at once: the bytes are there already. */
export function sourceOfBytes(bytes: Uint8Array): Source {
  return () => {
    let at = 0;
    return () => {
      if (at >= bytes.length) return undefined;
      at += PIECE;
      return bytes.subarray(at - PIECE, at);
    };
  };
}
