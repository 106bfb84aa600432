// How much is drawn while the picture moves, from the times of frames alone.
import { describe, expect, test } from 'vitest';
import { layersDrawnAs, type Pace, paced, rested, unhurried, whole } from '../../www/src/view/pace.ts';

/** The details after each of some frames, ms. */
function details(from: Pace, times: readonly number[]): number[] {
  let pace = from;
  return times.map((ms) => {
    pace = paced(pace, ms);
    return pace.detail;
  });
}

/** The pace after a movement of `frames` equal frames. */
const moved = (from: Pace, frames: number, ms: number): Pace =>
  Array.from({ length: frames }).reduce<Pace>((pace) => paced(pace, ms), from);

/** A device that needs `full` ms for everything and half of that with each step, at 60 frames a second at best. */
const device = (full: number) => (detail: number) => Math.max(full / 2 ** detail, 1000 / 60);

describe('the pace of the picture', () => {
  test('a quick device always draws everything', () => {
    expect(moved(unhurried, 1000, 1000 / 60).detail).toBe(0);
    expect(moved(unhurried, 1000, 33).detail).toBe(0);
  });

  test('one late frame changes nothing', () => {
    expect(details(unhurried, [16, 16, 16, 60, 16, 16])).toEqual([0, 0, 0, 0, 0, 0]);
    expect(details(unhurried, [299])).toEqual([0]);
  });

  test('slow frames make it coarser, by as many steps as their time asks for', () => {
    expect(details(unhurried, [40, 40])).toEqual([0, 1]);
    expect(details(unhurried, [140, 140])).toEqual([0, 2]);
    expect(details(unhurried, [200, 2000, 2000])).toEqual([0, 4, 4]);
  });

  test('a frame of a third of a second is judged at once', () => {
    expect(details(unhurried, [301, 40, 40])).toEqual([3, 3, 4]);
    expect(details(unhurried, [16, 16, 3000])).toEqual([0, 0, 4]);
  });

  test.each([20, 40, 90, 200, 450])(
    'a device of %d ms for everything finds what it can do, and stays with it',
    (full) => {
      const time = device(full);
      let pace = unhurried;
      const seen: number[] = [];
      for (let movement = 0; movement < 6; movement++) {
        const during: number[] = [];
        for (let frame = 0; frame < 60; frame++) {
          pace = paced(pace, time(pace.detail));
          during.push(pace.detail);
        }
        // Inside a movement it never gets finer again.
        expect(during).toEqual([...during].sort());
        seen.push(pace.detail);
        pace = rested(pace);
      }
      expect(time(seen[0] ?? 0)).toBeLessThanOrEqual(1000 / 30);
      expect(new Set(seen).size).toBe(1);
    },
  );

  test('between 30 and 50 frames a second nothing changes from movement to movement', () => {
    const coarse = moved(unhurried, 2, 140);
    expect(rested(moved(coarse, 100, 25)).detail).toBe(2);
    expect(rested(moved(coarse, 100, 18)).detail).toBe(1);
    expect(rested(moved(coarse, 3, 18)).detail).toBe(2);
    expect(rested(moved(unhurried, 100, 10)).detail).toBe(0);
  });

  test('a movement does not begin with a whole picture that took far too long', () => {
    expect(whole(unhurried, 200).detail).toBe(0);
    expect(whole(unhurried, 400).detail).toBe(3);
    expect(whole(unhurried, 9000).detail).toBe(4);
    expect(whole(moved(unhurried, 2, 3000), 400).detail).toBe(4);
  });

  test('each step above what is seen from outside halves the layers', () => {
    expect(([0, 1, 2, 3, 4] as const).map(layersDrawnAs)).toEqual([1, 1, 2, 4, 8]);
  });
});
