// The package in Node: models in, G-code and a report out, by the pool that the command line runs.
import { availableParallelism } from 'node:os';
import { fileURLToPath } from 'node:url';
import type { ModelSource } from '../../www/src/messages.ts';
import { ids, type Kind, settingsFiles } from '../../www/src/profiles/catalog.ts';
import { EngineError } from '../../www/src/slicer/errors.ts';
import { partsOf } from '../../www/src/slicer/gcode.ts';
import { Pool } from '../../www/src/slicer/pool.ts';
import { DiskFile, openModel } from '../cli/disk-file.ts';
import { nodeLanes } from '../cli/lanes.ts';
import type * as api from './types.ts';

const kinds: readonly Kind[] = ['printer', 'material', 'quality'];

export const profiles: typeof api.profiles = {
  printer: ids('printer'),
  material: ids('material'),
  quality: ids('quality'),
};

export const slice: api.Slice = async (models, options = {}) => {
  const { workers = Math.min(availableParallelism(), 4), signal, progress } = options;
  const sources = (isMany(models) ? models : [models]).map(sourceOf);
  const pool = new Pool(nodeLanes(), workers);
  try {
    const settings = await pool.settings(filesOf(options), []);
    await pool.open(await pool.unpack(sources));
    const gcode = await pool.slice({
      settings,
      ...(signal === undefined ? {} : { signal }),
      ...(progress === undefined ? {} : { progress }),
    });
    const { fileName, report } = gcode.joined;
    return { gcode: Buffer.concat(partsOf(gcode)), fileName, report: JSON.parse(report) as api.Report };
  } finally {
    pool.close();
    for (const { file } of sources) if (file instanceof DiskFile) file.close();
  }
};

/** The profiles named, then the settings, as settings files. */
function filesOf({ settings = {}, ...options }: api.SliceOptions): string[] {
  for (const kind of kinds) {
    const id = options[kind];
    if (id === undefined || ids(kind).includes(id)) continue;
    const message = `there is no ${kind} "${id}": there are ${ids(kind).join(', ')}`;
    throw new EngineError({ name: 'SettingsError', message, fatal: false });
  }
  const named = kinds.flatMap((kind) => (options[kind] === undefined ? [] : [[kind, options[kind]]]));
  return [...settingsFiles(Object.fromEntries(named)), JSON.stringify(settings)];
}

function sourceOf(model: api.Model): ModelSource {
  if (typeof model === 'string') return openModel(model);
  if (model instanceof URL) return openModel(fileURLToPath(model));
  return { name: model.name, file: new Blob([model.bytes as Uint8Array<ArrayBuffer>]) };
}

const isMany = (models: api.Model | readonly api.Model[]): models is readonly api.Model[] => Array.isArray(models);
