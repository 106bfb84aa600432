// The progress bar, on a terminal only.
import type { Progress } from '../../www/src/slicer/pool.ts';

const words: Record<Progress['stage'], string> = {
  read: 'reading',
  orient: 'orienting',
  prepare: 'preparing',
  layers: 'slicing',
  join: 'joining',
};

const WIDTH = 30;

/** One line of progress, as wide as every other. */
export function bar({ stage, done, total }: Progress): string {
  const filled = total === 0 ? 0 : Math.round((WIDTH * done) / total);
  const count = stage === 'layers' || stage === 'orient' ? ` ${done}/${total}` : '';
  return `${words[stage].padEnd(10)}[${'#'.repeat(filled).padEnd(WIDTH, '.')}]${count}`.padEnd(60);
}

/** Shows progress on `stream` while it is a terminal; `clear` wipes the line. */
export function progressBar(stream: NodeJS.WriteStream): { show(progress: Progress): void; clear(): void } {
  if (!stream.isTTY) return { show: () => undefined, clear: () => undefined };
  return {
    show: (progress) => void stream.write(`\r${bar(progress)}`),
    clear: () => void stream.write(`\r${' '.repeat(60)}\r`),
  };
}
