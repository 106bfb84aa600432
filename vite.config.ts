import { createHash } from 'node:crypto';
import { readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { defineConfig, type Plugin } from 'vite';
import { crateLicences } from './scripts/crate-licences.mjs';

const out = 'dist/page';

// The page: static files that work under any sub-path and need no special headers.
export default defineConfig({
  root: 'www',
  base: './',
  build: {
    outDir: `../${out}`,
    emptyOutDir: true,
    target: 'es2023',
    assetsInlineLimit: 0,
    modulePreload: { polyfill: false },
    license: { fileName: 'licences.md' },
    rolldownOptions: {
      input: { index: 'www/index.html', offline: 'www/src/offline.worker.ts' },
      output: { entryFileNames: ({ name }) => (name === 'offline' ? 'offline.js' : 'assets/[name]-[hash].js') },
    },
  },
  worker: { format: 'es' },
  plugins: [crateLicences(), knowingFiles()],
  preview: { port: 4173 },
});

const digest = (file: string): string => createHash('sha256').update(readFileSync(file)).digest('hex').slice(0, 16);

/** Tells the service worker all files of the page, each with its digest where its name holds none. */
function knowingFiles(): Plugin {
  const offline = `${out}/offline.js`;
  return {
    name: 'knowing files',
    apply: 'build',
    closeBundle: () => {
      const files = readdirSync(out, { recursive: true, withFileTypes: true })
        .filter((it) => it.isFile())
        .map((it) => `${it.parentPath}/${it.name}`)
        .filter((it) => it !== offline)
        .sort()
        .map((file) => ({
          url: file.slice(out.length + 1),
          revision: file.startsWith(`${out}/assets/`) ? null : digest(file),
        }));
      const script = readFileSync(offline, 'utf8');
      if (!script.includes('self.FOOTHOLD_FILES')) throw new Error(`${offline} has no place for the files`);
      writeFileSync(
        offline,
        script.replace('self.FOOTHOLD_FILES', () => JSON.stringify(files)),
      );
    },
  };
}
