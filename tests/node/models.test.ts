// The shared models do what their manifest expects of them; FOOTHOLD_MODELS names their folder.
import { existsSync, readFileSync } from 'node:fs';
import path from 'node:path';
import { afterAll, describe, expect, test } from 'vitest';
import { foothold, root, temporaryFolder } from './command.ts';

type Expect = 'slice' | 'slice_or_repair' | 'slice_or_reject' | 'reject' | 'reject_or_bed_error' | 'no_crash';

interface Entry {
  readonly name: string;
  readonly expect: Expect;
}

const places = [
  process.env['FOOTHOLD_MODELS'],
  path.join(root, '../shared/models'),
  path.join(root, '../../shared/models'),
];
const models = places.find((it) => it !== undefined && existsSync(path.join(it, 'manifest.json')));
const manifest =
  models === undefined
    ? []
    : (JSON.parse(readFileSync(path.join(models, 'manifest.json'), 'utf8')) as { files: Entry[] }).files;
if (models === undefined) console.log('skipped: the shared models are not here (set FOOTHOLD_MODELS)');

const { folder, remove } = temporaryFolder();
afterAll(remove);

/** Whether an entry may be refused. */
const mayRefuse: Readonly<Record<Expect, boolean>> = {
  slice: false,
  slice_or_repair: true,
  slice_or_reject: true,
  reject: true,
  reject_or_bed_error: true,
  no_crash: true,
};

describe.skipIf(models === undefined)('shared models', () => {
  test.each(manifest.map((entry) => [entry.name, entry] as const))('%s', async (name, entry) => {
    const report = path.join(folder, `${name}.json`);
    const model = path.join(models ?? '', name);
    const ended = await foothold(['slice', model, '-o', `${name}.gcode`, '--report', report], folder);
    if (ended.code !== 0) {
      expect(ended.err).toMatch(/^foothold: .+\n$/);
      expect(ended.code).toBeGreaterThanOrEqual(2);
      expect(mayRefuse[entry.expect], ended.err).toBe(true);
      return;
    }
    expect(['reject', 'reject_or_bed_error']).not.toContain(entry.expect);
    expect(ended.err).toMatch(/^(foothold: warning: .+\n)*$/);
    expect(readFileSync(path.join(folder, `${name}.gcode`), 'utf8')).not.toMatch(/\b[A-Z]-?(nan|inf)/i);
    expect(JSON.parse(readFileSync(report, 'utf8'))).toHaveProperty('warnings');
  });
});
