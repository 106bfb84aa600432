// The package as others get it: packed, installed into an empty project, used in Node, by tsc, by Vite and in a page.
import { execFile } from 'node:child_process';
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { promisify } from 'node:util';
import { test } from '@playwright/test';
import { serve } from '../../scripts/serve.mjs';
import { root } from '../node/command.ts';
import { expect } from './page.ts';

const run = promisify(execFile);
const sample = path.join(root, 'www/public/sample.stl');

/** A project of somebody else, with the packed package in it. */
let project = '';
let packed: { filename: string; size: number; files: { path: string }[] };

/** Runs one of this repository's tools in the project. */
const tool = (script: string, ...words: string[]) =>
  run(process.execPath, [path.join(root, 'node_modules', script), ...words], { cwd: project });

function write(files: Readonly<Record<string, string>>): void {
  for (const [name, content] of Object.entries(files)) {
    mkdirSync(path.dirname(path.join(project, name)), { recursive: true });
    writeFileSync(path.join(project, name), content);
  }
}

test.describe.configure({ mode: 'serial' });

test.beforeAll(async () => {
  project = mkdtempSync(path.join(tmpdir(), 'foothold-package-'));
  const { stdout } = await run('npm', ['pack', '--json', '--pack-destination', project], { cwd: root });
  [packed] = JSON.parse(stdout) as [typeof packed];
  write({ 'package.json': '{ "name": "shop", "private": true, "type": "module" }' });
  const words = ['install', '--offline', '--no-audit', '--no-fund', path.join(project, packed.filename)];
  await run('npm', words, { cwd: project });
});

test.afterAll(() => {
  rmSync(project, { recursive: true, force: true });
});

test('it holds licences, readme and what runs, and not the world', () => {
  const files = packed.files.map((it) => it.path);
  for (const file of ['LICENSE-MIT', 'LICENSE-APACHE', 'README.md', 'dist/element/licences.md', 'bin/foothold.mjs']) {
    expect(files).toContain(file);
  }
  expect(files.filter((it) => /^(src|www|tests|crates|target|node_modules|dist\/page)\//.test(it))).toEqual([]);
  expect(files.length).toBeLessThan(60);
  const installed = JSON.parse(readFileSync(path.join(project, 'package-lock.json'), 'utf8')) as { packages: object };
  expect(Object.keys(installed.packages)).toEqual(['', 'node_modules/foothold']);
});

test('in Node it slices a file, as its command does', async () => {
  write({
    'slice.mjs': `
      import { readFileSync, writeFileSync } from 'node:fs';
      import { profiles, slice } from 'foothold';
      const stages = new Set();
      const options = { printer: 'ender3', settings: { layers: { height: 0.3 } }, progress: ({ stage }) => stages.add(stage) };
      const { gcode, fileName, report } = await slice(process.argv[2], options);
      writeFileSync('api.gcode', gcode);
      const bytes = await slice({ name: 'sample.stl', bytes: readFileSync(process.argv[2]) }, { ...options, workers: 1 });
      const refused = await Promise.allSettled([
        slice('none.stl'),
        slice({ name: 'x.stl', bytes: new Uint8Array(3) }),
        slice(process.argv[2], { printer: 'nobody' }),
        slice(process.argv[2], { settings: { layers: { hight: 1 } } }),
        slice(process.argv[2], { settings: { printer: { bed_size: [20, 20] } } }),
        slice(process.argv[2], { signal: AbortSignal.abort() }),
      ]);
      console.log(JSON.stringify({
        fileName,
        layers: report.layers,
        stages: [...stages],
        same: Buffer.compare(bytes.gcode, gcode) === 0,
        printers: profiles.printer.includes('ender3'),
        refused: refused.map(({ reason }) => reason?.name),
      }));
    `,
  });
  const { stdout } = await run(process.execPath, ['slice.mjs', sample], { cwd: project });
  const told = JSON.parse(stdout) as { fileName: string; refused: string[] };
  expect(told).toMatchObject({ layers: 160, same: true, printers: true });
  expect(told).toMatchObject({ stages: ['read', 'prepare', 'layers', 'join'] });
  expect(told.fileName).toMatch(/^sample_0\.3mm_.*\.gcode$/);
  const names = ['FileError', 'ModelError', 'SettingsError', 'SettingsError', 'FitError', 'AbortError'];
  expect(told.refused).toEqual(names);

  const words = ['slice', sample, '-o', 'cli.gcode', '--printer', 'ender3', '--set', 'layers.height=0.3'];
  await run('npx', ['--offline', 'foothold', ...words], { cwd: project });
  const [api, cli] = ['api.gcode', 'cli.gcode'].map((name) => readFileSync(path.join(project, name)));
  expect(api?.equals(cli ?? Buffer.from(''))).toBe(true);
});

test('its types check a consumer, for Node and for bundlers', async () => {
  const compilerOptions = { strict: true, noEmit: true, target: 'ES2022', lib: ['ES2023', 'DOM'], types: [] };
  const config = (module: string, moduleResolution: string, file: string): string =>
    JSON.stringify({ compilerOptions: { ...compilerOptions, module, moduleResolution }, files: [file] });
  write({
    'node.ts': `
      import { slice, type Report } from 'foothold';
      const { gcode, report } = await slice(['a.stl'], { quality: 'fine', settings: { walls: { count: 2 } } });
      export const told: [Uint8Array, Report, number] = [gcode, report, report.layers];
      // @ts-expect-error: no such model
      await slice(1);
      // @ts-expect-error: no such setting
      await slice('a.stl', { settings: { walls: { cuont: 2 } } });
    `,
    'page.ts': `
      import 'foothold';
      import type { Report } from 'foothold/element';
      const slicer = document.createElement('foothold-slicer');
      slicer.addEventListener('foothold-sliced', ({ detail }) => console.log(detail.filament.mass_g.toFixed(1)));
      slicer.settings = { infill: { density: 0.2 } };
      await slicer.load(new Blob([]));
      export const report: Report = await slicer.slice();
      // @ts-expect-error: G-code is a File, if there is one
      export const text: string = slicer.gcode();
    `,
    'tsconfig.node.json': config('NodeNext', 'NodeNext', 'node.ts'),
    'tsconfig.page.json': config('ESNext', 'Bundler', 'page.ts'),
  });
  for (const name of ['node', 'page']) {
    const { stdout } = await tool('typescript/bin/tsc', '-p', `tsconfig.${name}.json`);
    expect(stdout).toBe('');
  }
});

/** A box as Wavefront OBJ. */
const obj = (x: number, y: number, z: number): string => `
${[0, 1].flatMap((k) => [0, 1].flatMap((j) => [0, 1].map((i) => `v ${i * x} ${j * y} ${k * z}`))).join('\n')}
f 1 3 4 2
f 5 6 8 7
f 1 2 6 5
f 3 7 8 4
f 1 5 7 3
f 2 4 8 6
`;

for (const how of ['plain HTML', 'Vite']) {
  test(`by ${how} it shows the element in a page, which slices`, async ({ page }) => {
    const script = how === 'Vite' ? 'main.js' : 'node_modules/foothold/dist/element/foothold-slicer.js';
    write({
      'index.html': `<!doctype html><title>shop</title><foothold-slicer></foothold-slicer>
        <script type="module" src="./${script}"></script>`,
      'main.js': `import 'foothold';`,
      'vite.config.js': `export default { base: './', logLevel: 'error' };`,
    });
    if (how === 'Vite') await tool('vite/bin/vite.js', 'build');
    const server = await serve({ '/deep/er/': path.join(project, how === 'Vite' ? 'dist' : '.') });
    const complaints: string[] = [];
    page.on('pageerror', (error) => complaints.push(String(error)));
    try {
      await page.goto(`${server.origin}/deep/er/`);
      await expect(page.getByRole('button', { name: 'Open model' })).toBeVisible();
      // The element needs its second module for it.
      const layers = await page.evaluate(
        async (text) => {
          const slicer = document.querySelector('foothold-slicer') as HTMLElement & {
            load(file: Blob): Promise<void>;
            slice(): Promise<{ layers: number }>;
          };
          await slicer.load(new File([text], 'box.obj'));
          return (await slicer.slice()).layers;
        },
        obj(20, 10, 8),
      );
      expect(layers).toBe(40);
      expect(complaints).toEqual([]);
    } finally {
      await server.close();
    }
  });
}
