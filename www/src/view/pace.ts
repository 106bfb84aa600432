// How much of the picture in space is drawn while it moves, so that a slow device still shows 30 frames a second.

/**
 * How much of the beads is drawn: 0 all, 1 what is seen from outside, 2 to 4 every second, fourth, eighth layer of
 * that.
 */
export type Detail = 0 | 1 | 2 | 3 | 4;

/** The least that is drawn. */
export const COARSEST = 4 satisfies Detail;

/** Layers that one layer of a picture stands for. */
export const layersDrawnAs = (detail: Detail): number => 2 ** Math.max(detail - 1, 0);

/** What a movement of the picture has shown so far. */
export interface Pace {
  readonly detail: Detail;
  /** Frames timed at this detail, and their mean time, ms. */
  readonly frames: number;
  readonly mean: number;
}

/** A mean time of frames, ms, above which less is drawn: 30 a second. */
const SLOW = 1000 / 30;
/** Below this, ms, the next movement may show more: 60 a second, and something to spare. */
const QUICK = 20;
/** Frames before a detail is judged, and before it is found quick. One frame may be late for any reason... */
const FRAMES = 2;
/** ...but not so late, ms. */
const FAR_TOO_SLOW = 300;
const MANY_FRAMES = 12;
/** How many of the last frames count, about. */
const MEMORY = 4;

/** At first everything is drawn. */
export const unhurried: Pace = { detail: 0, frames: 0, mean: 0 };

/**
 * The pace after one more frame, which took `ms`. Inside a movement the picture only gets coarser, so that it does
 * not flicker; by as many steps at once as the time asks for, each taken to halve it.
 */
export function paced({ detail, frames, mean }: Pace, ms: number): Pace {
  const count = frames + 1;
  const share = Math.max(1 / count, 1 / MEMORY);
  const now = { detail, frames: count, mean: mean + share * (ms - mean) };
  const isJudged = count >= FRAMES || ms > FAR_TOO_SLOW;
  if (!isJudged || now.mean <= SLOW || detail === COARSEST) return now;
  const steps = Math.max(Math.floor(Math.log2(now.mean / SLOW)), 1);
  return { detail: Math.min(detail + steps, COARSEST) as Detail, frames: 0, mean: 0 };
}

/** The pace with which the next movement begins: as the last one ended, or a step finer if that was quick. */
export function rested({ detail, frames, mean }: Pace): Pace {
  const isQuick = frames >= MANY_FRAMES && mean < QUICK;
  return { detail: (isQuick ? Math.max(detail - 1, 0) : detail) as Detail, frames: 0, mean: 0 };
}

/** The pace after the whole picture was drawn at rest in `ms`: if that is far too slow, no movement begins with it. */
export function whole(pace: Pace, ms: number): Pace {
  const { detail } = paced(unhurried, ms);
  return detail > pace.detail ? { ...pace, detail } : pace;
}
