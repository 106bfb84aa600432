// Which printer, material and quality are chosen, and settings files that name them.

/** Ids of the profiles chosen; what is not chosen leaves the engine's defaults. */
export interface Layers {
  readonly printer?: string;
  readonly material?: string;
  readonly quality?: string;
}

/** A settings file: which profiles, and the user's changes over them. */
export interface SavedSettings {
  readonly profiles: Layers;
  readonly settings: object;
  /** Settings of single models, by the models' names. */
  readonly models: Readonly<Record<string, object>>;
}

/** Reads a saved file, or plain settings, which choose no profile. Throws where it is neither. */
export function parseSaved(text: string): SavedSettings {
  const found: unknown = JSON.parse(text);
  if (!isObject(found)) throw new Error('expected a JSON object');
  const { models = {}, ...plate } = found;
  if (!('profiles' in plate)) return { profiles: {}, settings: plate, models: modelsOf(models) };
  const { profiles, settings = {}, ...others } = plate;
  const unknown = Object.keys(others)[0];
  if (unknown !== undefined) throw new Error(`unknown "${unknown}" beside profiles, settings and models`);
  if (!isObject(settings)) throw new Error('"settings" is not an object');
  return { profiles: layersOf(profiles), settings, models: modelsOf(models) };
}

function modelsOf(found: unknown): Readonly<Record<string, object>> {
  if (!isObject(found)) throw new Error('"models" is not an object');
  const models: Record<string, object> = {};
  for (const [name, settings] of Object.entries(found)) {
    if (!isObject(settings)) throw new Error(`the settings of model "${name}" are not an object`);
    models[name] = settings;
  }
  return models;
}

function layersOf(found: unknown): Layers {
  if (!isObject(found)) throw new Error('"profiles" is not an object');
  const layers: Record<string, string> = {};
  for (const [kind, id] of Object.entries(found)) {
    if (!['printer', 'material', 'quality'].includes(kind)) throw new Error(`unknown profile kind "${kind}"`);
    if (typeof id !== 'string') throw new Error(`the ${kind} profile is not named by a word`);
    layers[kind] = id;
  }
  return layers;
}

const isObject = (it: unknown): it is Record<string, unknown> =>
  typeof it === 'object' && it !== null && !Array.isArray(it);
