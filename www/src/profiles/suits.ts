// Which temperatures suit a material that another slicer's profile names.
import { materials } from './catalog.ts';

/** What other slicers call our materials. */
const otherNames: Readonly<Record<string, string>> = { PET: 'PETG', NYLON: 'PA', FLEX: 'TPU' };

/** Of other materials nothing is known: everything suits them. */
const ANY = { nozzle_temp_range: [0, 500], bed_temp_range: [0, 200] };

interface Filament {
  readonly material?: string;
  readonly nozzle_temp_range?: readonly number[];
  readonly bed_temp_range?: readonly number[];
}

/** Imported settings with the temperatures that suit their material, as far as they name one and say none. */
export function suited(settings: { readonly filament?: Filament }): object {
  const { filament } = settings;
  if (filament?.material === undefined) return settings;
  const name = filament.material.toUpperCase();
  const known = materials.find((it) => filamentOf(it.settings).material === (otherNames[name] ?? name));
  const { nozzle_temp_range, bed_temp_range } = known === undefined ? ANY : filamentOf(known.settings);
  return { ...settings, filament: { nozzle_temp_range, bed_temp_range, ...filament } };
}

function filamentOf(settings: { readonly filament?: Filament }): Filament {
  return settings.filament ?? {};
}
