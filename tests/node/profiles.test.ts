// Profiles: every file of the folder is in the catalogue; what is chosen is found again.
import { readdirSync } from 'node:fs';
import { expect, test } from 'vitest';
import { ids, materials, printers, settingsFiles, usbOf } from '../../www/src/profiles/catalog.ts';
import { chosenIn, isOfProfile, offered, withProfile } from '../../www/src/profiles/choice.ts';
import { parseSaved } from '../../www/src/profiles/layers.ts';
import { suited } from '../../www/src/profiles/suits.ts';

test('the catalogue holds every file', () => {
  for (const [kind, folder] of [
    ['printer', 'printers'],
    ['material', 'materials'],
    ['quality', 'qualities'],
  ] as const) {
    const files = readdirSync(`profiles/${folder}`).map((it) => it.replace('.json', ''));
    expect(ids(kind).toSorted()).toEqual(files.toSorted());
  }
  expect(printers.length).toBeGreaterThanOrEqual(13);
  expect(materials.length).toBeGreaterThanOrEqual(6);
});

test('printer, then material, then quality', () => {
  const [first = '', second = '', third] = settingsFiles({ quality: 'fine', printer: 'mk4', material: 'pa' });
  expect(JSON.parse(first)).toMatchObject({ printer: { flavor: 'prusa' } });
  expect(JSON.parse(second)).toMatchObject({ filament: { material: 'PA' } });
  expect(JSON.parse(third ?? '')).toMatchObject({ layers: { height: 0.12 } });
  expect(settingsFiles({})).toEqual([]);
});

test('whether a printer takes G-code over USB', () => {
  expect([usbOf('ender3'), usbOf('mk4'), usbOf('a1_mini'), usbOf('own')]).toEqual(['ok', 'limited', 'none', 'ok']);
});

test('profiles chosen in the form', () => {
  for (const { id } of offered.printer) {
    const changes = withProfile(withProfile(withProfile({}, 'quality', 'fine'), 'printer', id), 'material', 'petg');
    expect(chosenIn(changes)).toEqual({ printer: id, material: 'petg', quality: 'fine' });
    expect(
      Object.entries(changes).every(([path, value]) => typeof value !== 'object' || isOfProfile(path, value)),
    ).toBe(true);
  }
  const tuned = { ...withProfile({}, 'printer', 'p1s'), 'walls.count': 4, 'retraction.length': 1.25 };
  expect(chosenIn(tuned).printer).toBeUndefined();
  // Nothing of the last printer stays, own settings do.
  expect(withProfile(tuned, 'printer', undefined)).toEqual({ 'walls.count': 4 });
});

test('settings files may name profiles', () => {
  const profiles = { printer: 'k1', material: 'pla' };
  const text = JSON.stringify({ profiles, settings: { walls: { count: 4 } } });
  const settings = { walls: { count: 4 } };
  expect(parseSaved(text)).toEqual({ profiles, settings, models: {} });
  expect(parseSaved('{"walls":{"count":4}}')).toEqual({ profiles: {}, settings, models: {} });
  const models = { cube: { infill: { density: 1 } } };
  expect(parseSaved(JSON.stringify({ ...settings, models }))).toEqual({ profiles: {}, settings, models });
  expect(parseSaved(JSON.stringify({ profiles, models }))).toEqual({ profiles, settings: {}, models });
  for (const [text, fault] of [
    ['[]', /JSON object/],
    ['{"profiles":3}', /"profiles" is not/],
    ['{"profiles":{"printers":"k1"}}', /kind "printers"/],
    ['{"profiles":{"printer":1}}', /not named by a word/],
    ['{"profiles":{},"extra":1}', /unknown "extra"/],
    ['{"models":{"cube":1}}', /model "cube" are not an object/],
  ] as const) {
    expect(() => parseSaved(text)).toThrow(fault);
  }
});

test('an imported material has the temperatures that suit it', () => {
  const of = (filament: object): object => suited({ filament });
  const petg = { nozzle_temp_range: [220, 260], bed_temp_range: [60, 95] };
  expect(of({ material: 'PETG', nozzle_temp: 240 })).toEqual({
    filament: { material: 'PETG', nozzle_temp: 240, ...petg },
  });
  expect(of({ material: 'pet' })).toEqual({ filament: { material: 'pet', ...petg } });
  expect(of({ material: 'PCTG' })).toMatchObject({
    filament: { nozzle_temp_range: [0, 500], bed_temp_range: [0, 200] },
  });
  expect(of({ material: 'PLA', nozzle_temp_range: [1, 2] })).toMatchObject({ filament: { nozzle_temp_range: [1, 2] } });
  expect(of({ nozzle_temp: 240 })).toEqual({ filament: { nozzle_temp: 240 } });
});
