// A stand-in for `navigator.serial` with the simulated printer behind it, in a page and in its workers.
// Built into one script with the simulator (scripts/simulator.mjs); `wasm_bindgen` and `WASM` come from there.
/* global wasm_bindgen, WASM */

wasm_bindgen.initSync({ module: Uint8Array.from(atob(WASM), (c) => c.charCodeAt(0)) });

const inPage = typeof document !== 'undefined';
const channel = new BroadcastChannel('simulator');

/** What the test wants; the page has it, a worker asks for it whenever a port opens. */
let wish = {};
/** Time runs so many times as fast; its origin, real and told. */
let [factor, real0, told0] = [1, 0, 0];
const now = performance.now.bind(performance);
const later = setTimeout;

function hurry(times) {
  [real0, told0] = [now(), performance.now()];
  factor = times;
}

function scaleTime() {
  performance.now = () => told0 + (now() - real0) * factor;
  globalThis.setTimeout = (act, ms = 0, ...rest) => later(act, ms / factor, ...rest);
}

/** Timers have a least delay; messages have none. */
const { port1, port2 } = new MessageChannel();
let due = 0;
let timer;
function at(time, act) {
  const turn = ++due;
  const run = () => turn === due && act();
  clearTimeout(timer);
  const wait = (time - performance.now()) / factor;
  if (wait > 1) timer = later(run, wait);
  else {
    port2.onmessage = run;
    port1.postMessage(0);
  }
}

class Port {
  readable = null;
  writable = null;
  opens = 0;
  isOpen = false;
  #info;
  #sim;
  #made;
  #controller;

  constructor(info) {
    this.#info = info;
  }

  getInfo() {
    return this.#info;
  }

  async open({ baudRate }) {
    if (this.isOpen) throw new DOMException('The port is already open.', 'InvalidStateError');
    if (!inPage) wish = await asked('wish');
    if (wish.busy) throw new DOMException('Failed to open serial port.', 'NetworkError');
    if (wish.factor !== undefined) {
      scaleTime();
      hurry(wish.factor);
    }
    const right = baudRate === (wish.baud ?? 115200);
    this.opens += 1;
    this.isOpen = true;
    current = this;
    if (this.#sim === undefined || this.#made !== JSON.stringify(wish.printer)) this.#make();
    if (right && wish.resetOnOpen) this.#sim.power_on();
    this.readable = new ReadableStream({
      start: (controller) => {
        this.#controller = controller;
      },
    });
    this.writable = new WritableStream({ write: (bytes) => this.#write(right ? bytes : undefined) });
    this.#live();
  }

  async close() {
    this.isOpen = false;
    this.readable = null;
    this.writable = null;
  }

  unplug() {
    if (!this.isOpen) return;
    this.#controller.error(new DOMException('The device has been lost.', 'NetworkError'));
    this.readable = null;
  }

  say(line) {
    this.#sim.say(line);
    this.#live();
  }

  state() {
    const sim = this.#sim;
    // What was written before the port closed still arrives.
    if (!this.isOpen) sim.read(performance.now());
    const seen = { accepted: sim.accepted(), halted: sim.halted(), moves: sim.moves() };
    return { ...seen, overruns: sim.overruns(), fullest: sim.fullest(), opens: this.opens, open: this.isOpen, inPage };
  }

  #make() {
    const { seed, moves, moveMs = 5, heatRate = 1000, advanced = false } = wish.printer ?? {};
    this.#made = JSON.stringify(wish.printer);
    this.#sim =
      seed === undefined ? wasm_bindgen.Sim.good(moveMs, heatRate, advanced) : wasm_bindgen.Sim.faulty(seed, moves);
  }

  /** At a wrong speed, what arrives and what comes back is noise. */
  #write(bytes) {
    if (bytes === undefined) this.#controller.enqueue(Uint8Array.of(0xfe, 0x80, 0x00, 0xff));
    else this.#sim.write(performance.now(), bytes);
    this.#live();
  }

  #live() {
    if (!this.isOpen || this.readable === null) return;
    const bytes = this.#sim.read(performance.now());
    if (bytes.length > 0) this.#controller.enqueue(bytes);
    if (wish.unplugAfter !== undefined && this.#sim.moves() > wish.unplugAfter) {
      wish.unplugAfter = undefined;
      return this.unplug();
    }
    const next = this.#sim.next_event();
    if (next !== undefined) at(next, () => this.#live());
  }
}

const INFO = { usbVendorId: 0x1a86, usbProductId: 0x7523 };
const ports = [new Port(INFO), new Port(INFO)];
/** The port opened last in this thread. */
let current;

const serial = {
  getPorts: async () => {
    if (!inPage) wish = await asked('wish');
    return ports.slice(0, wish.ports ?? 1);
  },
  requestPort: async () => {
    if (wish.noPort) throw new DOMException('No port selected by the user.', 'NotFoundError');
    return ports[0];
  },
};
Object.defineProperty(navigator, 'serial', { value: serial, configurable: true });

/** Asks the other threads; the one that knows answers. */
function asked(what, detail) {
  return new Promise((resolve) => {
    const id = Math.random();
    const answers = new BroadcastChannel('simulator');
    answers.onmessage = ({ data }) => {
      if (data.answer !== id) return;
      answers.close();
      resolve(data.value);
    };
    answers.postMessage({ id, what, detail });
  });
}

channel.onmessage = ({ data: { id, what, detail } }) => {
  const answer = (value) => channel.postMessage({ answer: id, value });
  if (what === 'wish' && inPage) answer(wish);
  if (current === undefined) return;
  if (what === 'state') answer(current.state());
  if (what === 'unplug') answer(current.unplug());
  if (what === 'say') answer(current.say(detail));
};

if (inPage) {
  globalThis.simulator = {
    wish: (it) => {
      wish = it;
    },
    state: () => asked('state'),
    unplug: () => asked('unplug'),
    say: (line) => asked('say', line),
    fate: wasm_bindgen.fate_of,
  };
}
