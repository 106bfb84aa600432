// What base layers cost in the engine as pages run it: skirt, brim, raft and teeth for first layers of 10,000
// vertices, best of eight, on one core. `npm run build`, then `node benches/adhesion.mjs`.
//
// Target: all four under 50 ms, teeth no slower than a brim of 20 lines. The time of each kind is by the clock; on
// a busy machine look at the CPU time of all, in which cutting the first layer and estimating the printing time
// are counted as well.
import { readFileSync } from 'node:fs';
import { binaryStl } from '../scripts/sample.mjs';
import * as engine from '../www/src/generated/engine/foothold.js';

const TAU = 2 * Math.PI;
const around = (n, radius, [cx, cy] = [0, 0]) =>
  Array.from({ length: n }, (_, k) => {
    const angle = (TAU * k) / n;
    const r = radius(angle, k);
    return [cx + r * Math.cos(angle), cy + r * Math.sin(angle)];
  });

/** A fixed sequence of numbers in -0.5..0.5, as of a scanner's noise. */
function dice() {
  let state = 1;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32 - 0.5;
  };
}

const noise = dice();
const shapes = {
  wave: [around(10_000, (a) => 45 + 6 * Math.sin(14 * a))],
  noisy: [around(10_000, (a) => 45 + 6 * Math.sin(14 * a) + 0.04 * noise())],
  gear: [around(10_000, (a) => 80 + (((72 * a) / TAU) % 1 < 0.5 ? 3 : 0))],
  many: Array.from({ length: 100 }, (_, k) => around(100, () => 5, [14 * (k % 10), 14 * Math.floor(k / 10)])),
  comb: Array.from({ length: 10 }, (_, row) => comb(20 * row)),
};

/** A back with 25 round-tipped prongs, 1,000 vertices. */
function comb(y) {
  const prong = (k) => [
    [8 * k + 8, y + 5],
    [8 * k + 8, y + 9],
    ...Array.from({ length: 36 }, (_, j) => [
      8 * k + 6 + 2 * Math.cos((TAU / 70) * j),
      y + 9 + 2 * Math.sin((TAU / 70) * j),
    ]),
    [8 * k + 4, y + 9],
    [8 * k + 4, y + 5],
  ];
  return [[0, y], [200, y], ...Array.from({ length: 25 }, (_, k) => prong(24 - k)).flat()];
}

/** The outlines 1 mm high, as binary STL; lids are fans, which no layer cuts. */
function prism(outlines) {
  const triangles = outlines.flatMap((ring) =>
    ring.flatMap((a, k) => {
      const b = ring[(k + 1) % ring.length];
      const wall = [
        [
          [...a, 0],
          [...b, 0],
          [...b, 1],
        ],
        [
          [...a, 0],
          [...b, 1],
          [...a, 1],
        ],
      ];
      const lid = [
        [
          [...ring[0], 0],
          [...b, 0],
          [...a, 0],
        ],
        [
          [...ring[0], 1],
          [...a, 1],
          [...b, 1],
        ],
      ];
      return k === 0 || k === ring.length - 1 ? wall : [...wall, ...lid];
    }),
  );
  return binaryStl(triangles);
}

const wasm = new URL('../www/src/generated/engine/foothold_bg.wasm', import.meta.url);
engine.initSync({ module: new WebAssembly.Module(readFileSync(wasm)) });
for (const [name, outlines] of Object.entries(shapes)) {
  const reader = new engine.ModelReader();
  reader.push(prism(outlines));
  const settings = engine.resolve_settings([], ['printer.bed_size=[400,400]']);
  const job = new engine.Job([reader.finish()], [name], settings, new Float64Array(), []);
  const best = {};
  let least = Number.POSITIVE_INFINITY;
  for (let run = 0; run < 8; run++) {
    const before = process.cpuUsage();
    const compared = job.compare();
    least = Math.min(least, process.cpuUsage(before).user / 1000);
    for (const { kind, slicing_ms } of JSON.parse(compared)) {
      best[kind] = Math.min(best[kind] ?? Number.POSITIVE_INFINITY, slicing_ms);
    }
  }
  const all = Object.values(best).reduce((sum, ms) => sum + ms, 0);
  const list = Object.entries(best).map(([kind, ms]) => `${kind} ${ms.toFixed(1)}`);
  console.log(
    `${name.padEnd(6)} ${list.join(', ')}; all four ${all.toFixed(1)} ms; ${least.toFixed(1)} ms of CPU with cutting and estimate`,
  );
  job.free();
}
