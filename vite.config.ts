import { defineConfig } from 'vite';

// The page: static files that work under any sub-path and need no special headers.
export default defineConfig({
  root: 'www',
  base: './',
  build: {
    outDir: '../dist/page',
    emptyOutDir: true,
    target: 'es2023',
    assetsInlineLimit: 0,
    modulePreload: { polyfill: false },
  },
  worker: { format: 'es' },
  preview: { port: 4173 },
});
