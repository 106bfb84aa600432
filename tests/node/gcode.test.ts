import { expect, test } from 'vitest';
import { type Gcode, layerOf, layersOf } from '../../www/src/slicer/gcode.ts';

const bytes = (text: string): Uint8Array<ArrayBuffer> => new TextEncoder().encode(text);
const words = (it: Uint8Array): string => new TextDecoder().decode(it);

/** A start, three layers with a joining line in front of the later ones, and an end. */
function gcodeOf(layers: readonly string[]): Gcode {
  const glue = ['M107 ; fan off\nT0\n', ';to 1\n', 'T1\n;to 2\n', 'M107\n'];
  const startOf = (k: number): number => glue.slice(0, k).join('').length;
  const spans = glue.map((_, k) => [0, startOf(k), startOf(k + 1)]);
  const pieces = layers.flatMap((text, k) => [...(spans[k] ?? []), k + 1, 0, text.length]);
  const joined = { glue: bytes(glue.join('')), pieces: Uint32Array.from([...pieces, ...(spans[3] ?? [])]) };
  return { layers: layers.map(bytes), joined } as unknown as Gcode;
}

test('a layer read alone knows the fan and the tool of those before it', () => {
  const gcode = gcodeOf([';TYPE:a\nG1 X1\n', 'G1 X2\nM106 S128\nG1 X3 ;M107\nM1067\n', 'G1 X4\n']);
  expect(words(layerOf(gcode, 0))).toBe('M83\nM107 ; fan off\nT0\n;TYPE:a\nG1 X1\n');
  expect(words(layerOf(gcode, 2))).toBe('M83\nM106 S128\nT0\nT1\n;to 2\nG1 X4\n');
  expect(words(layerOf(gcode, 1))).toMatch(/^M83\nM107 ; fan off\nT0\n;to 1\nG1 X2\n/);
  expect(words(layersOf(gcode, 1, 3))).toMatch(/^M83\nM107 ; fan off\nT0\n;to 1\n[\s\S]*T1\n;to 2\nG1 X4\n$/);
});
