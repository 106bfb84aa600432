// The tables of words: the same words in each language, and which one a visitor gets.
import { expect, test } from 'vitest';
import schema from '../../schema/settings.schema.json';
import { en } from '../../www/src/i18n/en.ts';
import { named } from '../../www/src/i18n/settings.ts';
import { closest, languages, tables } from '../../www/src/i18n/text.ts';
import { kept } from '../../www/src/preferences.ts';
import { shownAt } from '../../www/src/settings/depths.ts';
import { groupsOf, type Schema } from '../../www/src/settings/fields.ts';

/** Dotted paths of all texts in a table, with what they say. */
function texts(table: object, path = ''): [string, unknown][] {
  return Object.entries(table).flatMap(([name, value]): [string, unknown][] => {
    const at = `${path}.${name}`;
    return typeof value === 'object' && value !== null ? texts(value, at) : [[at, value]];
  });
}

/** Texts that may be the same in another language: names, and words that it shares with English. */
const shared = /^\.(title|format\.|settings\.unit|view\.units|view\.inSpace)/;

test.each(languages.filter((it) => it !== 'en'))('%s says everything, in its own words', (language) => {
  const english = new Map(texts(en));
  const own = texts(tables[language]);
  expect(own.map(([path]) => path)).toEqual([...english.keys()]);
  const empty = own.filter(([, text]) => text === '');
  expect(empty).toEqual([]);
  const same = own.filter(
    ([path, text]) => typeof text === 'string' && !shared.test(path) && text === english.get(path),
  );
  expect(same.length, `still in English: ${same.map(([path]) => path).join(', ')}`).toBeLessThan(own.length / 20);
});

test('durations as a person says them', () => {
  const times = [42, 90, 3600, 3900];
  expect(times.map(en.format.duration)).toEqual(['42 s', '2 min', '1 h', '1 h 5 min']);
  expect(tables.zh.format.duration(3900)).toBe('1 小时 5 分');
});

test('numbers are written as the language does', () => {
  expect(en.format.metres(15960)).toBe('15.96 m');
  expect(tables.de.format.metres(15960)).toBe('15,96 m');
});

test('a visitor gets the first wished language that there is', () => {
  expect(closest(['de-AT', 'en'])).toBe('de');
  expect(closest(['fr', 'zh-Hans-CN', 'en'])).toBe('zh');
  expect(closest(['fr', 'it'])).toBe('en');
  expect(closest([])).toBe('en');
});

test('what was kept wins over what the browser asks for, and nonsense is passed over', () => {
  expect(kept('{"language":"zh","theme":"dark"}', ['de'])).toEqual({ language: 'zh', theme: 'dark' });
  expect(kept('{"language":"xx","theme":7}', ['de'])).toEqual({ language: 'de', theme: 'system' });
  for (const text of [null, '', 'null', '{', '[]']) {
    expect(kept(text, ['en'])).toEqual({ language: 'en', theme: 'system' });
  }
});

test.each(Object.entries(named))(
  '%s names the basic settings, and only settings that there are',
  (_, { labels, groups, values }) => {
    const all = groupsOf(schema as Schema);
    const fields = all.flatMap((group) => group.fields);
    const choices = fields.flatMap((field) => (field.kind === 'choice' ? field.choices.map(({ value }) => value) : []));
    const unknown = [
      ...Object.keys(labels).filter((path) => !fields.some((field) => field.path === path)),
      ...Object.keys(groups).filter((path) => !all.some((group) => group.path === path)),
    ];
    expect(unknown).toEqual([]);
    const basic = shownAt('basic', all).flatMap((group) => group.fields.map((field) => field.path));
    expect(basic.filter((path) => !(path in labels))).toEqual([]);
    expect(choices.some((value) => value in values)).toBe(true);
  },
);
