// Runs the command line in this process and says on file descriptor 3 what the process used.
import { writeSync } from 'node:fs';
import { main } from '../dist/node/cli.mjs';

const started = performance.now();
process.on('exit', () => {
  const { userCPUTime, systemCPUTime, maxRSS } = process.resourceUsage();
  const wall_s = (performance.now() - started) / 1000;
  writeSync(3, JSON.stringify({ wall_s, cpu_s: (userCPUTime + systemCPUTime) / 1e6, peak_mib: maxRSS / 1024 }));
});
await main(process.argv.slice(2));
