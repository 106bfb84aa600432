// A serial port and bytes: the only file that touches the port.
import type { PortInfo } from './messages.ts';

/** The part of Web Serial's SerialPort that is used. */
export interface SerialPortLike {
  readonly readable: ReadableStream<Uint8Array> | null;
  readonly writable: WritableStream<Uint8Array> | null;
  open(options: { baudRate: number; bufferSize: number }): Promise<void>;
  close(): Promise<void>;
  getInfo(): PortInfo;
}

/** The part of Web Serial's `navigator.serial` that is used. */
export interface SerialLike {
  getPorts(): Promise<SerialPortLike[]>;
  requestPort(): Promise<SerialPortLike>;
}

/** Web Serial of this thread, if it has it. */
export function serial(): SerialLike | undefined {
  return (navigator as { readonly serial?: SerialLike }).serial;
}

/** The permitted port that looks like this; undefined when none does, or more than one. */
export async function portLike(info: PortInfo): Promise<SerialPortLike | undefined> {
  const ports = (await serial()?.getPorts()) ?? [];
  const alike = ports.filter((port) => isAlike(port.getInfo(), info));
  return alike.length === 1 ? alike[0] : undefined;
}

export function isAlike(one: PortInfo, other: PortInfo): boolean {
  return one.usbVendorId === other.usbVendorId && one.usbProductId === other.usbProductId;
}

/** Bytes the browser keeps for us between two reads. */
const BUFFER_SIZE = 16384;

/** An open port. `received` is called with what comes in, `gone` once when it ends without `close`. */
export class Wire {
  readonly #port: SerialPortLike;
  readonly #writer: WritableStreamDefaultWriter<Uint8Array>;
  #reader: ReadableStreamDefaultReader<Uint8Array> | undefined;
  #closing = false;

  private constructor(port: SerialPortLike, writable: WritableStream<Uint8Array>) {
    this.#port = port;
    this.#writer = writable.getWriter();
  }

  /** Rejects where the port is in use or gone. */
  static async open(
    port: SerialPortLike,
    baudRate: number,
    received: (bytes: Uint8Array) => void,
    gone: () => void,
  ): Promise<Wire> {
    await port.open({ baudRate, bufferSize: BUFFER_SIZE });
    if (port.writable === null) {
      await port.close();
      throw new Error('the port cannot be written to');
    }
    const wire = new Wire(port, port.writable);
    void wire.#read(received).finally(() => {
      if (!wire.#closing) gone();
    });
    return wire;
  }

  /** Writes in the order of the calls. What fails shows at the reading end: the port is gone. */
  write(bytes: Uint8Array): void {
    this.#writer.write(bytes).catch(() => undefined);
  }

  /** Gives the port free; what was written before goes out first, unless the port is stuck. */
  async close(): Promise<void> {
    if (this.#closing) return;
    this.#closing = true;
    await Promise.race([this.#writer.close().catch(() => undefined), pause(500)]);
    await this.#writer.abort().catch(() => undefined);
    this.#writer.releaseLock();
    await this.#reader?.cancel().catch(() => undefined);
    await this.#port.close().catch(() => undefined);
  }

  /** A garbled byte ends the stream, and the port offers a new one; a port that is gone offers none. */
  async #read(received: (bytes: Uint8Array) => void): Promise<void> {
    while (this.#port.readable !== null && !this.#closing) {
      this.#reader = this.#port.readable.getReader();
      try {
        for (;;) {
          const { value, done } = await this.#reader.read();
          if (done) return;
          received(value);
        }
      } catch {
        // The next turn finds out whether the port is still there.
      } finally {
        this.#reader.releaseLock();
      }
    }
  }
}

function pause(ms: number): Promise<void> {
  return new Promise((resolve) => setTimeout(resolve, ms));
}
