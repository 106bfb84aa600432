// `npm start`: installs what is missing, builds, serves the page and prints its address.
// Options are vite preview's: npm start -- --port 8080 --host
import { spawn } from 'node:child_process';
import { build } from './build.mjs';
import { at, root } from './places.mjs';

await build();
const server = spawn(process.execPath, [at('node_modules/vite/bin/vite.js'), 'preview', ...process.argv.slice(2)], {
  cwd: root,
  stdio: 'inherit',
});
for (const signal of ['SIGINT', 'SIGTERM']) process.on(signal, () => server.kill(signal));
server.on('exit', (code) => process.exit(code ?? 0));
