// Builds everything that can be served or run: `npm run build`. Installs what is missing first.
//
//   Rust -> schema/*.json -> TypeScript types
//   Rust -> wasm -> wasm-bindgen -> wasm-opt -> www/src/generated/engine, files and link
//   www, bin -> dist/page (static files, any sub-path), dist/element (<foothold-slicer> for other sites),
//               dist/node (what bin/foothold.mjs runs, and the package in Node), dist/types (the package's types)
//
// FOOTHOLD_QUICK=1 builds the engine in a third of the time, larger and a little slower, for trying things out.
import { existsSync, mkdirSync, readFileSync, rmSync, statSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { pathToFileURL } from 'node:url';
import { gzipSync } from 'node:zlib';
import { at, generated, schema, wasmTarget } from './places.mjs';
import { run, runPackage } from './run.mjs';
import { npmPackages, wasmBindgen, wasmTargetInstalled } from './setup.mjs';
import { step } from './step.mjs';

/** The engine's cargo profile; the quick one is not run through wasm-opt either. */
const quick = process.env.FOOTHOLD_QUICK === '1';
const profile = quick ? 'quick' : 'release';
const rust = ['src', 'crates', 'Cargo.toml', 'Cargo.lock', 'rust-toolchain.toml', '.cargo'];
const web = ['www', 'profiles', 'package-lock.json', 'Cargo.lock', 'scripts/crate-licences.mjs'];

export async function build() {
  await npmPackages();
  await wasmTargetInstalled();
  const bindgen = await wasmBindgen();
  const { engine, files, link } = modules;
  // The end of an optimised build is one thread's work, so that there is room for another beside it.
  await together(
    async () => {
      await schemas();
      await types();
      await bound(bindgen, files);
    },
    () => bound(bindgen, engine),
    () => bound(bindgen, link),
  );
  await sample();
  await page();
  await element();
  await node();
  await declarations();
}

/** Does all at the same time and waits until all have ended; throws what the first of them threw. */
async function together(...works) {
  const ends = await Promise.allSettled(works.map((work) => work()));
  const failed = ends.find((it) => it.status === 'rejected');
  if (failed !== undefined) throw failed.reason;
}

function schemas() {
  const outputs = ['settings', 'report', 'gcode-figures', 'printer-event', 'printer-outline'].map(
    (it) => `schema/${it}.schema.json`,
  );
  return step('schema', { inputs: [...rust, 'examples/schema.rs'], outputs }, async () => {
    mkdirSync(schema, { recursive: true });
    const fast = quick ? ['--target-dir', at('target', 'unoptimised'), '--config', 'profile.dev.opt-level=0'] : [];
    const example = ['--features', 'schema', '--example', 'schema'];
    await run('cargo', ['run', '--quiet', '--locked', ...fast, ...example, '--', schema]);
  });
}

function types() {
  const names = ['settings', 'report', 'gcode-figures', 'printer-event', 'printer-outline'];
  const outputs = names.map((it) => `www/src/generated/${it}.ts`);
  return step('types', { inputs: ['schema', 'scripts/build.mjs', 'package-lock.json'], outputs }, async () => {
    const { compileFromFile } = await import('json-schema-to-typescript');
    mkdirSync(generated, { recursive: true });
    for (const name of names) {
      const bannerComment = `// Written by scripts/build.mjs from schema/${name}.schema.json.`;
      const text = await compileFromFile(path.join(schema, `${name}.schema.json`), {
        bannerComment,
        additionalProperties: false,
      });
      writeFileSync(path.join(generated, `${name}.ts`), text);
    }
  });
}

/** The wasm modules: where each is written, how it is called there, and what cargo builds for it. */
const modules = {
  engine: { folder: 'engine', name: 'foothold', cargo: ['-p', 'foothold'], crate: 'foothold', inputs: rust },
  // For files of other programs.
  files: {
    folder: 'files',
    name: 'foothold_files',
    cargo: ['-p', 'foothold-files'],
    crate: 'foothold_files',
    inputs: ['crates', 'schema', 'Cargo.toml', 'Cargo.lock', 'rust-toolchain.toml', '.cargo'],
  },
  // The serial protocol.
  link: {
    folder: 'link',
    name: 'foothold_link',
    // In a folder of its own: cargo calls both builds of the crate by the same name.
    cargo: ['-p', 'foothold', '--no-default-features', '--features', 'link', '--target-dir', targetFolder('link')],
    target: targetFolder('link'),
    crate: 'foothold',
    inputs: ['src/lib.rs', 'src/printer', 'src/wasm', 'Cargo.toml', 'Cargo.lock', 'rust-toolchain.toml', '.cargo'],
  },
};

/** Builds a module as wasm, with JavaScript around it, into an empty folder. */
function bound(bindgen, { folder, name, cargo, crate, inputs, target = targetFolder() }) {
  const files = [`${name}.js`, `${name}.d.ts`, `${name}_bg.wasm`];
  const outputs = files.map((it) => `www/src/generated/${folder}/${it}`);
  return step(folder, { inputs: [...inputs, 'scripts/build.mjs'], outputs, variant: profile }, async () => {
    await run('cargo', ['build', '--locked', '--profile', profile, '--target', wasmTarget, '--lib', ...cargo]);
    const raw = path.join(target, wasmTarget, profile, `${crate}.wasm`);
    const out = path.join(generated, folder);
    rmSync(out, { recursive: true, force: true });
    await run(path.join(bindgen, 'wasm-bindgen'), [raw, '--target', 'web', '--out-dir', out, '--out-name', name]);
    if (profile === 'release') await optimise(name, path.join(out, `${name}_bg.wasm`));
  });
}

function targetFolder(...parts) {
  return path.join(process.env.CARGO_TARGET_DIR ?? at('target'), ...parts);
}

async function optimise(name, file) {
  const features = ['simd', 'bulk-memory', 'nontrapping-float-to-int', 'sign-ext', 'mutable-globals'];
  const before = statSync(file).size;
  // The compiler has put functions into others where that is faster; a second time it only makes them larger.
  const level = ['-O2', '--one-caller-inline-max-function-size', '0'];
  await runPackage('binaryen/bin/wasm-opt', [...level, ...features.map((it) => `--enable-${it}`), file, '-o', file]);
  const bytes = readFileSync(file);
  const kib = (n) => `${(n / 1024).toFixed(0)} KiB`;
  console.log(
    `build: ${name} ${kib(before)} -> ${kib(bytes.length)}, gzip'd ${kib(gzipSync(bytes, { level: 9 }).length)}`,
  );
}

function sample() {
  return step('sample', { inputs: ['scripts/sample.mjs'], outputs: ['www/public/sample.stl'] }, async () => {
    const { sampleStl } = await import('./sample.mjs');
    mkdirSync(at('www', 'public'), { recursive: true });
    writeFileSync(at('www', 'public', 'sample.stl'), sampleStl());
  });
}

function page() {
  return step('page', { inputs: [...web, 'schema', 'vite.config.ts'], outputs: ['dist/page/index.html'] }, () =>
    runPackage('vite/bin/vite.js', ['build', '--logLevel', 'warn']),
  );
}

function element() {
  const config = 'vite.element.config.ts';
  const outputs = ['dist/element/foothold-slicer.js'];
  return step('element', { inputs: [...web, 'schema', config], outputs }, () => bundled(config));
}

function node() {
  const config = 'vite.node.config.ts';
  const outputs = ['cli', 'lane', 'index'].map((it) => `dist/node/${it}.mjs`);
  return step('node', { inputs: [...web, 'bin', 'schema', config], outputs }, () => bundled(config));
}

const bundled = (config) => runPackage('vite/bin/vite.js', ['build', '--config', config, '--logLevel', 'warn']);

/** What the package's two modules offer, as declarations. */
function declarations() {
  const inputs = ['bin/api', 'www/src/element-types.ts', 'schema', 'tsconfig.package.json', 'tsconfig.strict.json'];
  const outputs = ['dist/types/bin/api/types.d.ts', 'dist/types/www/src/element-types.d.ts'];
  return step('declarations', { inputs, outputs }, () =>
    runPackage('typescript/bin/tsc', ['-p', 'tsconfig.package.json']),
  );
}

if (existsSync(process.argv[1]) && import.meta.url === pathToFileURL(process.argv[1]).href) {
  await build();
}
