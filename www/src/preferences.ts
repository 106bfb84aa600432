// What the page keeps between visits about itself: language and colours.
import { closest, type Language, languages } from './i18n/text.ts';

export type ThemeChoice = 'system' | 'light' | 'dark';

export const themes: readonly ThemeChoice[] = ['system', 'light', 'dark'];

export interface Preferences {
  readonly language: Language;
  readonly theme: ThemeChoice;
}

const KEY = 'foothold.preferences';

/** What was kept, as far as it can be used; else what the browser asks for. */
export function kept(text: string | null, wished: readonly string[]): Preferences {
  const found = parsed(text);
  return {
    language: languages.find((it) => it === found['language']) ?? closest(wished),
    theme: themes.find((it) => it === found['theme']) ?? 'system',
  };
}

export function loadPreferences(): Preferences {
  return kept(read(), navigator.languages);
}

export function savePreferences(preferences: Preferences): void {
  try {
    localStorage.setItem(KEY, JSON.stringify(preferences));
  } catch {
    // A visitor who allows no storage chooses anew at each visit.
  }
}

function read(): string | null {
  try {
    return localStorage.getItem(KEY);
  } catch {
    return null;
  }
}

function parsed(text: string | null): Readonly<Record<string, unknown>> {
  try {
    const value: unknown = JSON.parse(text ?? '{}');
    return typeof value === 'object' && value !== null ? (value as Record<string, unknown>) : {};
  } catch {
    return {};
  }
}
