// What each lesson lets a person change in place, and how its state stands in the page's address.
import type { Changes } from '../settings/changes.ts';
import type { Value } from '../settings/fields.ts';
import type { Lesson } from '../studies.ts';

export const lessons: readonly Lesson[] = ['teeth', 'plates', 'features', 'orientation'];

/** Where a person is in the lessons; `at` is a plane (y=110), a layer (17), or empty. */
export interface Place {
  readonly lesson: Lesson;
  /** Counted from 0. */
  readonly step: number;
  readonly at: string;
}

export const firstPlace: Place = { lesson: 'teeth', step: 0, at: '' };

/** A setting with the range its slider has in a lesson; the engine's own limits are wider. */
export interface Knob {
  readonly path: string;
  readonly low: number;
  readonly high: number;
  readonly step: number;
}

export const knobs: Readonly<Record<Lesson, readonly Knob[]>> = {
  teeth: [
    { path: 'adhesion.teeth.offset', low: 0.5, high: 5, step: 0.1 },
    { path: 'adhesion.teeth.height', low: 0.6, high: 7, step: 0.1 },
    { path: 'adhesion.teeth.base', low: 0.5, high: 9.5, step: 0.1 },
    { path: 'adhesion.teeth.pitch', low: 1, high: 12, step: 0.1 },
    { path: 'adhesion.teeth.simplify_length', low: 0, high: 5, step: 0.1 },
    { path: 'adhesion.teeth.simplify_height', low: 0, high: 1, step: 0.01 },
  ],
  plates: [
    { path: 'support.overhang_angle_deg', low: 0, high: 80, step: 1 },
    { path: 'support.plates.spacing_x', low: 1, high: 15, step: 0.5 },
    { path: 'support.plates.spacing_y', low: 1, high: 15, step: 0.5 },
  ],
  features: [
    { path: 'orientation.self_support_angle_deg', low: 0, high: 45, step: 1 },
    { path: 'layers.height', low: 0.05, high: 0.6, step: 0.05 },
  ],
  orientation: [
    { path: 'orientation.self_support_angle_deg', low: 0, high: 45, step: 1 },
    { path: 'orientation.base_layers', low: 0, high: 20, step: 1 },
    { path: 'orientation.layer_height', low: 0.1, high: 1, step: 0.05 },
  ],
};

/** What an address says about lessons and settings; undefined when it names no lesson. */
export function placeIn(address: string): { readonly place: Place; readonly changes: Changes } | undefined {
  const { searchParams } = new URL(address);
  const [name = '', number = '1'] = (searchParams.get('learn') ?? '').split('/');
  const lesson = lessons.find((it) => it === name);
  if (lesson === undefined) return undefined;
  const step = Math.max(0, Math.trunc(Number(number)) - 1 || 0);
  const pairs = searchParams.getAll('set').map((text): [string, Value] => {
    const cut = text.indexOf('=');
    return [text.slice(0, cut), settingOf(text.slice(cut + 1))];
  });
  const changes = Object.fromEntries(pairs.filter(([path]) => /^[a-z0-9_]+(\.[a-z0-9_]+)*$/.test(path)));
  return { place: { lesson, step, at: searchParams.get('at') ?? '' }, changes };
}

/** The address that brings back a place with these settings; the model stays the one that the address names. */
export function addressOf(address: string, { lesson, step, at }: Place, changes: Changes): string {
  const url = new URL(address);
  for (const name of ['learn', 'at', 'set']) url.searchParams.delete(name);
  url.searchParams.set('learn', `${lesson}/${step + 1}`);
  if (at !== '') url.searchParams.set('at', at);
  for (const [path, value] of Object.entries(changes)) {
    url.searchParams.append('set', `${path}=${typeof value === 'string' ? value : JSON.stringify(value)}`);
  }
  return url.href;
}

/** The address without any place in the lessons. */
export function withoutPlace(address: string): string {
  const url = new URL(address);
  for (const name of ['learn', 'at', 'set']) url.searchParams.delete(name);
  return url.href;
}

function settingOf(text: string): Value {
  try {
    const value: unknown = JSON.parse(text);
    const isList = Array.isArray(value) && value.every((it) => typeof it === 'number');
    if (typeof value === 'number' || typeof value === 'boolean' || isList) return value as Value;
  } catch {
    // A plain word.
  }
  return text;
}
