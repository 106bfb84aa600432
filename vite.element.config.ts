import { defineConfig } from 'vite';
import { crateLicences } from './scripts/crate-licences.mjs';

// <foothold-slicer>: one module to name, and beside it what that loads, all by addresses relative to the module.
export default defineConfig({
  root: 'www',
  base: './',
  publicDir: false,
  build: {
    outDir: '../dist/element',
    emptyOutDir: true,
    target: 'es2023',
    assetsInlineLimit: 0,
    modulePreload: false,
    // three.js alone is larger than a bundler likes; it comes when something is drawn in space.
    chunkSizeWarningLimit: 700,
    license: { fileName: 'licences.md' },
    rolldownOptions: {
      input: 'www/src/element.ts',
      preserveEntrySignatures: 'strict',
      output: { entryFileNames: 'foothold-slicer.js' },
    },
  },
  plugins: [crateLicences()],
  // A worker's module is one file: bundlers of host pages copy it, and would not see what it imports.
  worker: { format: 'es', rolldownOptions: { output: { codeSplitting: false } } },
});
