// Builds what the browser tests put in front of `navigator.serial`: the simulated printer of the Rust tests
// as wasm, and the stand-in around it, as one script. No part of the product.
import { existsSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { pathToFileURL } from 'node:url';
import { at, wasmTarget } from './places.mjs';
import { run } from './run.mjs';
import { wasmBindgen, wasmTargetInstalled } from './setup.mjs';
import { step } from './step.mjs';

const standIn = 'tests/e2e/serial-stand-in.js';
const inputs = [
  'examples/printer_sim.rs',
  'tests/common/printer_sim.rs',
  standIn,
  'Cargo.lock',
  'rust-toolchain.toml',
  'scripts/simulator.mjs',
];

/** The script is dist/simulator/serial.js. */
export async function simulator() {
  await wasmTargetInstalled();
  const bindgen = await wasmBindgen();
  await step('simulator', { inputs, outputs: ['dist/simulator/serial.js'] }, async () => {
    // As the tests in Node are built, of which most is used again.
    const profile = ['--features', 'link', '--target', wasmTarget];
    await run('cargo', ['build', '--locked', ...profile, '--example', 'printer_sim']);
    const target = process.env.CARGO_TARGET_DIR ?? at('target');
    const raw = path.join(target, wasmTarget, 'debug', 'examples', 'printer_sim.wasm');
    const out = at('dist', 'simulator');
    mkdirSync(out, { recursive: true });
    const shape = ['--target', 'no-modules', '--no-typescript', '--out-dir', out, '--out-name', 'printer_sim'];
    await run(path.join(bindgen, 'wasm-bindgen'), [raw, ...shape]);
    const glue = readFileSync(path.join(out, 'printer_sim.js'), 'utf8');
    const wasm = readFileSync(path.join(out, 'printer_sim_bg.wasm')).toString('base64');
    const script = `(() => {\n${glue}\nconst WASM = '${wasm}';\n${readFileSync(at(standIn), 'utf8')}\n})();\n`;
    writeFileSync(path.join(out, 'serial.js'), script);
  });
}

if (existsSync(process.argv[1]) && import.meta.url === pathToFileURL(process.argv[1]).href) await simulator();
