import { copyFileSync } from 'node:fs';
import { defineConfig, type Plugin } from 'vite';

// What bin/foothold.mjs runs: the command line, and the thread that slices beside it; and the package's own module.
export default defineConfig({
  publicDir: false,
  build: {
    ssr: true,
    outDir: 'dist/node',
    emptyOutDir: true,
    target: 'node20',
    rollupOptions: {
      input: { cli: 'bin/cli/main.ts', lane: 'bin/cli/lane.ts', index: 'bin/api/index.ts' },
      output: { format: 'es', entryFileNames: '[name].mjs', chunkFileNames: '[name].mjs' },
    },
  },
  plugins: [
    besideBundle('www/src/generated/engine/foothold_bg.wasm'),
    besideBundle('www/src/generated/files/foothold_files_bg.wasm'),
    besideBundle('schema/settings.schema.json'),
  ],
});

/** Copies a file next to the bundle, which reads it at run time. */
function besideBundle(file: string): Plugin {
  return { name: `beside ${file}`, closeBundle: () => copyFileSync(file, `dist/node/${file.split('/').at(-1)}`) };
}
