// `npm run bench`: the stages (criterion), then whole runs of the command line with one engine and with two.
// Models are the arguments (npm run bench -- a.stl b.stl), or the sample.
import { spawn } from 'node:child_process';
import path from 'node:path';
import { build } from './build.mjs';
import { at } from './places.mjs';
import { run } from './run.mjs';

const REPEATS = 5;

/** One run: wall and CPU seconds, peak memory. */
function measure(model, workers) {
  const words = ['slice', model, '-o', '/dev/null', '--workers', String(workers)];
  const child = spawn(process.execPath, [at('scripts', 'measured.mjs'), ...words], {
    stdio: ['ignore', 'inherit', 'inherit', 'pipe'],
  });
  let text = '';
  child.stdio[3].setEncoding('utf8').on('data', (part) => {
    text += part;
  });
  return new Promise((resolve, reject) => {
    child.on('close', (code) => (code === 0 ? resolve(JSON.parse(text)) : reject(new Error(`${model}: exit ${code}`))));
  });
}

const median = (values) => values.toSorted((a, b) => a - b)[Math.floor(values.length / 2)];

async function compare(model) {
  const runs = { 1: [], 2: [] };
  for (let k = 0; k < REPEATS; k++) {
    // In turn, so that a change of the machine's speed meets both.
    for (const workers of [1, 2]) runs[workers].push(await measure(model, workers));
  }
  const figure = (workers, name) => median(runs[workers].map((it) => it[name]));
  const row = (workers) => [
    figure(workers, 'wall_s').toFixed(2),
    figure(workers, 'cpu_s').toFixed(2),
    figure(workers, 'peak_mib').toFixed(0),
  ];
  const ratio = figure(1, 'wall_s') / figure(2, 'wall_s');
  console.log([path.basename(model), ...row(1), ...row(2), ratio.toFixed(2)].join('\t'));
}

await build();
await run('cargo', ['bench', '--locked']);
const models = process.argv.slice(2);
console.log('model\t1: wall s\tCPU s\tMiB\t2: wall s\tCPU s\tMiB\ttimes faster');
for (const model of models.length > 0 ? models : [at('www', 'public', 'sample.stl')]) await compare(model);
