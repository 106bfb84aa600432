// Lanes without an engine: layer k has the text "layer k\n", whoever slices it.
import type { Evaluation, HelperReply, HelperRequest, LeadReply, LeadRequest, Range } from '../../www/src/messages.ts';
import { EngineError, toFailure } from '../../www/src/slicer/errors.ts';
import { type HelperLane, type LeadLane, LocalLane } from '../../www/src/slicer/lane.ts';
import type { LaneMaker } from '../../www/src/slicer/pool.ts';

const encoder = new TextEncoder();

export interface FakeOptions {
  readonly layers: number;
  /** Called before a range is sliced; may throw. */
  readonly before?: (who: string, range: Range) => void;
  readonly failToOpen?: boolean;
  /** Directions to compare when all are asked for; none: the part can't be turned. */
  readonly directions?: number;
}

/** A maker of fake lanes and a log of what they did. */
export function fakeLanes({
  layers,
  before,
  failToOpen,
  directions,
}: FakeOptions): LaneMaker & { log: string[]; open: () => number } {
  const log: string[] = [];
  let open = 0;
  let added = new Set<number>();

  const mark = ({ first, last }: Range): void => {
    for (let k = first; k < last; k++) {
      if (added.has(k)) throw new Error(`layer ${k} was added twice`);
      added.add(k);
    }
  };

  const lead = (request: LeadRequest): LeadReply => {
    log.push(`lead ${request.kind}`);
    switch (request.kind) {
      case 'open':
        if (failToOpen === true) throw expected('ModelError', 'truncated');
        return { kind: 'open', inspections: request.sources.map(({ name }) => name), parse_ms: 1 };
      case 'begin':
        added = new Set();
        return { kind: 'begin', partLayers: layers };
      case 'share':
        return { kind: 'share', share: encoder.encode(JSON.stringify(request.range)) };
      case 'slice':
        before?.('lead', request.range);
        mark(request.range);
        return { kind: 'slice', ...slicedText(request.range) };
      case 'add':
        mark(JSON.parse(new TextDecoder().decode(request.meta)) as Range);
        return { kind: 'add' };
      case 'finish':
        if (added.size !== layers) throw new Error(`${added.size} of ${layers} layers were added`);
        return { kind: 'finish', ...joined(layers) };
      case 'prepare':
        return { kind: 'prepare', layers };
      case 'end':
        return { kind: 'end' };
      case 'own':
        return { kind: 'own', settings: '{}' };
      case 'settings':
        return { kind: 'settings', settings: '{}' };
      case 'directions':
        if (directions === undefined) throw expected('ModelError', 'flat');
        return { kind: 'directions', ups: Array.from({ length: request.all ? directions : 6 }, (_, k) => [k, 0, 1]) };
      case 'mesh':
        return { kind: 'mesh', mesh: new Uint8Array([7]) };
      case 'evaluate':
        before?.('lead', { first: request.id, last: request.id });
        return { kind: 'evaluate', figures: evaluated(request) };
      case 'choose':
        return { kind: 'choose', report: request.figures.map((it) => it.join(' ')).join(', ') };
      default:
        throw new Error(`not faked: ${request.kind}`);
    }
  };

  const help = (request: HelperRequest): HelperReply => {
    if (request.kind === 'mesh') {
      log.push(`helper mesh ${request.mesh[0]}`);
      return { kind: 'mesh' };
    }
    if (request.kind === 'evaluate') {
      log.push('helper evaluate');
      return { kind: 'evaluate', figures: evaluated(request) };
    }
    const range = JSON.parse(new TextDecoder().decode(request.share)) as Range;
    before?.('helper', range);
    log.push('helper slice');
    return { kind: 'slice', meta: request.share, ...slicedText(range) };
  };

  const counted = <L extends LeadLane | HelperLane>(lane: L): L => {
    open++;
    const close = lane.close.bind(lane);
    let closed = false;
    lane.close = () => {
      if (!closed) open--;
      closed = true;
      close();
    };
    return lane;
  };

  return {
    log,
    open: () => open,
    lead: () => counted(new LocalLane<LeadRequest, LeadReply>(lead, pause)),
    helper: () => counted(new LocalLane<HelperRequest, HelperReply>(help, pause)),
  };
}

/** The id and the x that it came with. */
const evaluated = ({ id, up }: Evaluation): Uint8Array => new Uint8Array([id, up[0]]);

const pause = (): Promise<void> => new Promise((resolve) => setImmediate(resolve));

export function expected(name: string, message: string): EngineError {
  return new EngineError(toFailure(Object.assign(new Error(message), { name })));
}

export function layerText(k: number): string {
  return `layer ${k}\n`;
}

function slicedText({ first, last }: Range): { text: Uint8Array<ArrayBuffer>; offsets: Uint32Array } {
  const texts = Array.from({ length: last - first }, (_, k) => encoder.encode(layerText(first + k)));
  const offsets = new Uint32Array(texts.length + 1);
  texts.forEach((text, k) => {
    offsets[k + 1] = (offsets[k] ?? 0) + text.length;
  });
  const text = new Uint8Array(offsets.at(-1) ?? 0);
  texts.forEach((it, k) => {
    text.set(it, offsets[k]);
  });
  return { text, offsets };
}

/** Glue is "<|>": "<" in front, "|" between layers, ">" at the end. */
function joined(layers: number): Omit<Extract<LeadReply, { kind: 'finish' }>, 'kind'> {
  const pieces = [0, 0, 1];
  for (let k = 0; k < layers; k++) {
    if (k > 0) pieces.push(0, 1, 2);
    pieces.push(k + 1, 0, layerText(k).length);
  }
  pieces.push(0, 2, 3);
  return {
    report: '{}',
    fileName: 'fake.gcode',
    glue: encoder.encode('<|>'),
    pieces: Uint32Array.from(pieces),
    times: new Float64Array(layers),
    marks: new Uint8Array(),
  };
}
