// `npm test`: installs what is missing, builds, runs every test, and ends with one line of totals.
//
//   --long        all of the heavy sets, not a seeded tenth (FOOTHOLD_LONG=1)
//   --only NAME   one group of steps: check, rust, web, node or e2e
import { build } from './build.mjs';
import { at, wasmTarget } from './places.mjs';
import { CommandFailed, run, runPackage } from './run.mjs';
import { browser, npmPackages, wasmBindgen, wasmTargetInstalled } from './setup.mjs';
import { simulator } from './simulator.mjs';

const args = process.argv.slice(2);
const only = args.includes('--only') ? args[args.indexOf('--only') + 1] : undefined;
const env = args.includes('--long') ? { FOOTHOLD_LONG: '1' } : {};

await npmPackages();
await wasmTargetInstalled();
const bindgen = await wasmBindgen();

/** Groups of steps; a step is a name and what it runs. `built` groups need the build. */
const groups = {
  check: [
    ['cargo fmt', () => run('cargo', ['fmt', '--check'])],
    ['clippy', () => clippy('--all-targets', '--features', 'schema')],
    ['clippy wasm32', () => clippy('--lib', '--target', wasmTarget, '--features', 'link')],
    ['build', build],
    ['types: page', () => typeCheck('www/tsconfig.json')],
    ['types: workers', () => typeCheck('www/tsconfig.worker.json')],
    ['types: node', () => typeCheck('tsconfig.json')],
    ['biome', () => runPackage('@biomejs/biome/bin/biome', ['check', '--error-on-warnings'])],
    ['schemas committed', () => run('git', ['diff', '--exit-code', '--stat', '--', 'schema'])],
  ],
  rust: [
    ['cargo test', () => run('cargo', ['test', '--locked', '--features', 'schema'], { env })],
    ['cargo test files', () => run('cargo', ['test', '--locked', '--package', 'foothold-files'], { env })],
  ],
  web: [['wasm in Node', () => wasmTests()]],
  node: [
    ['build', build],
    ['vitest', () => runPackage('vitest/vitest.mjs', ['run'], { env })],
  ],
  e2e: [
    ['build', build],
    ['simulated printer', simulator],
    ['browser', browser],
    ['playwright', () => runPackage('@playwright/test/cli.js', ['test'], { env })],
  ],
};

const clippy = (...what) => run('cargo', ['clippy', '--quiet', '--locked', ...what, '--', '-D', 'warnings']);
const typeCheck = (project) => runPackage('typescript/bin/tsc', ['-p', project]);

function wasmTests() {
  const runner = 'CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUNNER';
  return run('cargo', ['test', '--locked', '--target', wasmTarget, '--features', 'link', '--test', 'web'], {
    env: { ...env, [runner]: `${bindgen}/wasm-bindgen-test-runner` },
  });
}

/** Passed and failed tests as the runners print them; a step that prints none counts as one. */
function count(output) {
  // biome-ignore lint/suspicious/noControlCharactersInRegex: the escape character starts a colour
  const text = output.replaceAll(/\u001b\[[0-9;]*m/g, '');
  const sum = (pattern) => [...text.matchAll(pattern)].reduce((total, [, n]) => total + Number(n), 0);
  return {
    passed: sum(/^test result: .*?(\d+) passed/gm) + sum(/^ +Tests .*?(\d+) passed/gm) + sum(/^ +(\d+) passed \(/gm),
    failed: sum(/^test result: .*?(\d+) failed/gm) + sum(/^ +Tests .*?(\d+) failed/gm) + sum(/^ +(\d+) failed$/gm),
  };
}

async function runStep(name, work) {
  const started = Date.now();
  console.log(`\n== ${name}`);
  try {
    const { passed, failed } = count(String((await work()) ?? ''));
    console.log(`== ${name}: ok, ${((Date.now() - started) / 1000).toFixed(0)} s`);
    return { passed: passed === 0 ? 1 : passed, failed };
  } catch (error) {
    const { passed, failed } = count(error instanceof CommandFailed ? error.output : '');
    console.log(`== ${name}: FAILED: ${error.message}`);
    return { passed, failed: Math.max(failed, 1) };
  }
}

const wanted = Object.entries(groups).filter(([name]) => only === undefined || name === only);
if (wanted.length === 0) throw new Error(`--only takes one of: ${Object.keys(groups).join(', ')}`);
const steps = new Map(wanted.flatMap(([, steps]) => steps));
const total = { passed: 0, failed: 0 };
const broken = [];
for (const [name, work] of steps) {
  const { passed, failed } = await runStep(name, work);
  total.passed += passed;
  total.failed += failed;
  if (failed > 0) broken.push(name);
}
process.chdir(at());
if (broken.length > 0) console.log(`\nfailed: ${broken.join(', ')}`);
console.log(`\n${total.passed} passed, ${total.failed} failed`);
process.exitCode = total.failed > 0 ? 1 : 0;
