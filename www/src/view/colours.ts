// What the colours of the picture in space mean: a role each, or a scale for a quantity.
import type { Moves } from '../messages.ts';
import type { Inside } from './outside.ts';

export type ColourBy = 'role' | 'speed' | 'width' | 'flow' | 'fan' | 'tool';

export const colourings: readonly ColourBy[] = ['role', 'speed', 'width', 'flow', 'fan', 'tool'];

export interface RoleColour {
  readonly role: string;
  readonly color: string;
}

/** Travels have this index; beads without a role the one before it. */
export const TRAVEL = 255;
export const UNKNOWN = 254;

/** Largest index of a scale; those above are for what has no value. */
const STEPS = 240;

/** Colours of scales from low to high: they differ in lightness too, for those who tell few colours apart. */
const SCALE = ['#2c3e8f', '#2a78b5', '#27a39a', '#7dbb5b', '#e6c229', '#e8743b', '#b5202e'];

type Quantity = Exclude<ColourBy, 'role' | 'tool' | 'fan'>;

/** Ends of what was looked at once: moves do not change. */
const ends = new WeakMap<Moves, Partial<Record<Quantity, readonly [number, number]>>>();

/** Low and high end of a quantity over all beads, mm/s, mm, mm3/s or per cent; undefined for what is no quantity. */
export function extent(by: ColourBy, batches: readonly Moves[]): readonly [number, number] | undefined {
  if (by === 'role' || by === 'tool') return undefined;
  if (by === 'fan') return [0, 100];
  const all = batches.map((moves) => endsOf(by, moves));
  const [low, high] = [Math.min(...all.map(([it]) => it)), Math.max(...all.map(([, it]) => it))];
  return low > high ? [0, 0] : [low, high];
}

function endsOf(by: Quantity, moves: Moves): readonly [number, number] {
  const known = ends.get(moves) ?? {};
  ends.set(moves, known);
  known[by] ??= measured(by, moves);
  return known[by];
}

function measured(by: Quantity, moves: Moves): readonly [number, number] {
  let [low, high] = [Number.POSITIVE_INFINITY, Number.NEGATIVE_INFINITY];
  for (let k = 0; k < moves.speeds.length; k++) {
    if (!isBead(moves, k)) continue;
    const value = quantity(by, moves, k);
    if (value < low) low = value;
    if (value > high) high = value;
  }
  return [low, high];
}

/** The index into the palette for each move. */
export function indices(
  by: ColourBy,
  moves: Moves,
  range: readonly [number, number] | undefined,
): Uint8Array<ArrayBuffer> {
  const found = new Uint8Array(moves.speeds.length);
  const [low, high] = range ?? [0, 1];
  const scale = STEPS / Math.max(high - low, 1e-9);
  for (let k = 0; k < found.length; k++) {
    if (!isBead(moves, k)) found[k] = TRAVEL;
    else if (by === 'role') found[k] = Math.min(moves.roles[k] ?? UNKNOWN, UNKNOWN);
    else if (by === 'tool') found[k] = Math.min(moves.tools[k] ?? 0, UNKNOWN);
    else found[k] = Math.round(Math.min(Math.max((quantity(by, moves, k) - low) * scale, 0), STEPS));
  }
  return found;
}

/** 256 colours, red green blue and opacity, 0 to 255 each; hidden roles have no opacity. */
export function palette(
  by: ColourBy,
  roles: readonly RoleColour[],
  hidden: ReadonlySet<string>,
): Uint8Array<ArrayBuffer> {
  const colours = new Uint8Array(4 * 256);
  const set = (index: number, hex: string, opacity = 255): void => {
    const value = Number.parseInt(hex.slice(1), 16);
    colours.set([value >> 16, (value >> 8) & 255, value & 255, opacity], 4 * index);
  };
  if (by === 'role') for (const [k, { role, color }] of roles.entries()) set(k, color, hidden.has(role) ? 0 : 255);
  else if (by === 'tool') for (let k = 0; k < UNKNOWN; k++) set(k, SCALE[(k * 2 + 1) % SCALE.length] ?? '#000000');
  else for (let k = 0; k <= STEPS; k++) set(k, scaleColour(k / STEPS));
  set(UNKNOWN, '#8a8f98');
  set(TRAVEL, '#5b8fd9', hidden.has('travel') ? 0 : 255);
  return colours;
}

/** Roles that the walls around them hide, by name, where something lies on them. */
const covered: readonly string[] = ['inner_wall', 'gap_fill', 'solid_infill'];

/** The indices of roles that are not seen from outside. */
export function insideRoles(roles: readonly RoleColour[]): Inside {
  const those = (names: readonly string[]): ReadonlySet<number> =>
    new Set(roles.flatMap(({ role }, k) => (names.includes(role) ? [k] : [])));
  return { covered: those(covered), hidden: those(['infill']) };
}

/** The colour of a scale at 0 to 1. */
export function scaleColour(share: number): string {
  const at = Math.min(Math.max(share, 0), 1) * (SCALE.length - 1);
  const below = Math.min(Math.floor(at), SCALE.length - 2);
  const channel = (hex: string | undefined, shift: number): number =>
    (Number.parseInt((hex ?? '#000').slice(1), 16) >> shift) & 255;
  const mixed = [16, 8, 0].map((shift) => {
    const [a, b] = [channel(SCALE[below], shift), channel(SCALE[below + 1], shift)];
    return Math.round(a + (b - a) * (at - below));
  });
  return `#${mixed.map((it) => it.toString(16).padStart(2, '0')).join('')}`;
}

function quantity(by: Exclude<ColourBy, 'role' | 'tool'>, moves: Moves, k: number): number {
  switch (by) {
    case 'speed':
      return moves.speeds[k] ?? 0;
    case 'width':
      return moves.sizes[2 * k] ?? 0;
    case 'flow':
      return moves.flows[k] ?? 0;
    case 'fan':
      return ((moves.fans[k] ?? 0) * 100) / 255;
    default:
      return by satisfies never;
  }
}

function isBead(moves: Moves, k: number): boolean {
  return (moves.sizes[2 * k] ?? 0) > 0;
}
