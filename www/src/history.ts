// Undo and redo: everything the visitor decides is a value, and the history is a list of such values.
import type { Part } from './parts.ts';
import type { Changes } from './settings/changes.ts';

/** What undo brings back: the parts and the settings. */
export interface Plan {
  readonly parts: readonly Part[];
  /** The parts stand as the engine arranges them; nobody has moved one. */
  readonly arranged: boolean;
  readonly changes: Changes;
}

export interface History {
  readonly past: readonly Plan[];
  readonly future: readonly Plan[];
}

export const noHistory: History = { past: [], future: [] };

/** Steps that can be undone; older ones are forgotten. */
const MOST_STEPS = 200;

export function planOf({ parts, arranged, changes }: Plan): Plan {
  return { parts, arranged, changes };
}

/** Whether the two are the same for the visitor. */
export function samePlan(a: Plan, b: Plan): boolean {
  return a.parts === b.parts && a.arranged === b.arranged && a.changes === b.changes;
}

/** The history after a change of `before`. */
export function recorded({ past }: History, before: Plan): History {
  return { past: [...past, before].slice(-MOST_STEPS), future: [] };
}

/** The plan before the last change, and the history there; undefined when there is none. */
export function undone({ past, future }: History, now: Plan): (Plan & { readonly history: History }) | undefined {
  const plan = past.at(-1);
  return plan && { ...plan, history: { past: past.slice(0, -1), future: [...future, now] } };
}

/** The plan that was undone last, and the history there; undefined when there is none. */
export function redone({ past, future }: History, now: Plan): (Plan & { readonly history: History }) | undefined {
  const plan = future.at(-1);
  return plan && { ...plan, history: { past: [...past, now], future: future.slice(0, -1) } };
}
