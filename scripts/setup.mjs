// Installs what is missing on a machine that has only Rust and Node. Node's own modules only:
// `npm start` runs this before node_modules is there.
import { existsSync, readFileSync } from 'node:fs';
import path from 'node:path';
import { at, cache, wasmTarget } from './places.mjs';
import { ask, run, which } from './run.mjs';

const exe = process.platform === 'win32' ? '.exe' : '';

/** npm packages of the lock file; again when the lock file is newer than what is installed. */
export async function npmPackages() {
  const installed = at('node_modules', '.package-lock.json');
  if (existsSync(installed) && samePackages(installed)) return;
  console.log('setup: npm packages');
  await run(`npm${process.platform === 'win32' ? '.cmd' : ''}`, ['ci']);
}

function samePackages(installed) {
  const versions = (file) =>
    Object.entries(JSON.parse(readFileSync(file, 'utf8')).packages).filter(([name, it]) => name !== '' && !it.optional);
  const here = new Map(versions(installed));
  return versions(at('package-lock.json')).every(([name, it]) => here.get(name)?.version === it.version);
}

/** The wasm target of the pinned toolchain. */
export async function wasmTargetInstalled() {
  const sysroot = ask('rustc', ['--print', 'sysroot']);
  if (sysroot === undefined) throw new Error('Rust is missing: install it first (rustup)');
  if (existsSync(path.join(sysroot, 'lib', 'rustlib', wasmTarget, 'lib'))) return;
  console.log(`setup: Rust target ${wasmTarget}`);
  await run('rustup', ['target', 'add', wasmTarget]);
}

/** Folder of the wasm-bindgen programs; their version must be the crate's. Built from source once. */
export async function wasmBindgen() {
  const version = lockedVersion('wasm-bindgen');
  const folder = path.join(cache, `wasm-bindgen-${version}`);
  const bin = path.join(folder, 'bin');
  if (!['wasm-bindgen', 'wasm-bindgen-test-runner'].every((it) => existsSync(path.join(bin, it + exe)))) {
    console.log(`setup: wasm-bindgen-cli ${version}, built from source: this takes a few minutes, once`);
    await run('cargo', [
      ...['install', 'wasm-bindgen-cli', '--version', version],
      ...['--locked', '--debug', '--root', folder],
    ]);
  }
  return bin;
}

function lockedVersion(crate) {
  const lock = readFileSync(at('Cargo.lock'), 'utf8');
  const version = lock.match(new RegExp(`name = "${crate}"\\nversion = "([^"]+)"`))?.[1];
  if (version === undefined) throw new Error(`Cargo.lock does not name ${crate}`);
  return version;
}

/** A Chromium for the browser tests: one on PATH, Playwright's own, or Debian's package. */
export async function browser() {
  const found = findBrowser() ?? (await playwrightBrowser());
  if (found !== undefined) return found;
  console.log('setup: a browser for the tests');
  if (which('apt-get') !== undefined && process.getuid?.() === 0) {
    await run('apt-get', ['update']);
    await run('apt-get', ['install', '-y', 'chromium'], { env: { DEBIAN_FRONTEND: 'noninteractive' } });
    return findBrowser();
  }
  await run(process.execPath, [at('node_modules', 'playwright', 'cli.js'), 'install', 'chromium']);
  return playwrightBrowser();
}

/** A browser that is installed on the machine: $CHROMIUM, or Chromium or Chrome on PATH. */
export function findBrowser() {
  const names = ['chromium', 'chromium-browser', 'google-chrome', 'google-chrome-stable'];
  return process.env.CHROMIUM ?? names.map(which).find((it) => it !== undefined);
}

async function playwrightBrowser() {
  const { chromium } = await import('@playwright/test');
  const file = chromium.executablePath();
  return existsSync(file) ? file : undefined;
}
