// A place in the lessons, and the settings with it, as the page's address tells them.
import { expect, test } from 'vitest';
import { tables } from '../../www/src/i18n/text.ts';
import { addressOf, knobs, lessons, placeIn, withoutPlace } from '../../www/src/lesson/steps.ts';

test('an address brings back the place and the settings', () => {
  const place = { lesson: 'plates', step: 2, at: 'y=112.5' } as const;
  const changes = { 'support.overhang_angle_deg': 30, 'adhesion.kind': 'brim', 'printer.bed_size': [180, 180] };
  const address = addressOf('https://host/page/?model=a.stl#top', place, changes);
  expect(placeIn(address)).toEqual({ place, changes });
  expect(new URL(address).searchParams.get('model')).toBe('a.stl');
  expect(withoutPlace(address)).toBe('https://host/page/?model=a.stl#top');
  expect(addressOf(address, place, changes)).toBe(address);
});

test('an address without a lesson, or with nonsense, is no place', () => {
  expect(placeIn('https://host/')).toBeUndefined();
  expect(placeIn('https://host/?learn=cooking/1')).toBeUndefined();
  const odd = placeIn('https://host/?learn=teeth/-7&set=..x%3D1&set=a.b%3D%7B%22c%22%3A1%7D');
  expect(odd?.place).toEqual({ lesson: 'teeth', step: 0, at: '' });
  // An object is taken as text: the engine says that it is no such setting.
  expect(odd?.changes).toEqual({ 'a.b': '{"c":1}' });
  expect(placeIn('https://host/?learn=teeth/abc')?.place.step).toBe(0);
});

test('every lesson has its words and its knobs', () => {
  for (const { panels } of Object.values(tables)) {
    for (const lesson of lessons) {
      expect(Object.keys(panels.learn[lesson]).length).toBeGreaterThanOrEqual(4);
      for (const step of Object.values(panels.learn[lesson])) {
        const asked: string[] = [];
        const text = step.text((name) => {
          asked.push(name);
          return '7';
        });
        expect(asked.length).toBeGreaterThan(0);
        // Two sentences at least.
        expect(text.match(/[.?!。？！](\s|$|.)/g)?.length ?? 0).toBeGreaterThanOrEqual(1);
      }
    }
  }
  for (const list of Object.values(knobs)) for (const { low, high } of list) expect(low).toBeLessThan(high);
});
