// What comparing the six directions at 0.2 mm costs in the engine as pages run it: balls of 101,760 triangles,
// plain and with bumps, best of three, on one core. `npm run build`, then `node benches/orientation.mjs`; models
// given as arguments are measured too.
//
// Target: under 3 s for any of them. CPU seconds, as the machine may be busy.
import { readFileSync } from 'node:fs';
import path from 'node:path';
import { binaryStl } from '../scripts/sample.mjs';
import * as engine from '../www/src/generated/engine/foothold.js';

const RINGS = 160;
const AROUND = 2 * RINGS;
const UPS = [2, 0, 1].flatMap((axis) => [1, -1].map((sign) => [0, 0, 0].with(axis, sign)));

/** A point of the ball, `bump` times its radius out or in; the same shape as in the native benchmark. */
function spot(bump, i, j) {
  const [theta, phi] = [(Math.PI * i) / RINGS, (2 * Math.PI * j) / AROUND];
  const n = [Math.sin(theta) * Math.cos(phi), Math.sin(theta) * Math.sin(phi), Math.cos(theta)];
  const wave = Math.sin(9 * n[0] + 1) * Math.sin(8 * n[1]) * Math.sin(7 * n[2] + 2);
  return n.map((it) => it * 25 * (1 + bump * wave));
}

function ball(bump) {
  const at = (i, j) => spot(bump, i, j % AROUND);
  const triangles = [];
  for (let i = 0; i < RINGS; i++) {
    for (let j = 0; j < AROUND; j++) {
      const [a, b, c, d] = [at(i, j), at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)];
      if (i < RINGS - 1) triangles.push([a, c, d]);
      if (i > 0) triangles.push([a, d, b]);
    }
  }
  return binaryStl(triangles);
}

function sixDirections(bytes) {
  const reader = new engine.ModelReader();
  reader.push(bytes);
  const model = reader.finish();
  const settings = engine.resolve_settings([], []);
  let least = Number.POSITIVE_INFINITY;
  for (let run = 0; run < 3; run++) {
    const before = process.cpuUsage();
    for (const [k, up] of UPS.entries()) model.evaluate(settings, k + 1, Float64Array.from(up));
    least = Math.min(least, process.cpuUsage(before).user / 1e6);
  }
  model.free();
  return least;
}

const wasm = new URL('../www/src/generated/engine/foothold_bg.wasm', import.meta.url);
engine.initSync({ module: new WebAssembly.Module(readFileSync(wasm)) });
const parts = [0, 0.1, 0.3].map((bump) => [`ball, bumps of ${100 * bump} %`, () => ball(bump)]);
parts.push(...process.argv.slice(2).map((file) => [path.basename(file), () => readFileSync(file)]));
for (const [name, bytes] of parts) console.log(`${name}: ${sixDirections(bytes()).toFixed(2)} s`);
