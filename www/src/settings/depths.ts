// How much of the settings is shown: the few that most prints change, the usual ones, or all.
import type { Field, Group } from './fields.ts';

export type Depth = 'basic' | 'usual' | 'all';

export const depths: readonly Depth[] = ['basic', 'usual', 'all'];

/** Shown first, in this order; those that the schema does not have are left out. */
const basic = [
  'layers.height',
  'walls.count',
  'infill.density',
  'infill.pattern',
  'adhesion.kind',
  'support.method',
  'orientation.mode',
  'filament.nozzle_temp',
  'filament.bed_temp',
];

/** What a depth below "all" adds to the basic ones: whole groups, or single settings. */
const usual = [
  ...basic,
  'print.sequence',
  'layers',
  'walls',
  'skin',
  'infill',
  'seam',
  'first_layer',
  'adhesion.brim.width',
  'adhesion.skirt.distance',
  'adhesion.skirt.loops',
  'adhesion.teeth.pitch',
  'support.overhang_angle_deg',
  'support.everywhere',
  'support.gap_z',
  'filament.material',
  'filament.fan_speed',
  'filament.first_layer_nozzle_temp',
  'filament.first_layer_bed_temp',
  'filament.cost_per_kg',
  'retraction.length',
  'retraction.z_hop',
  'speed.outer_wall',
  'speed.inner_wall',
  'speed.infill',
  'speed.top_skin',
  'speed.travel',
  'printer.bed_size',
  'printer.height',
  'printer.nozzle_diameter',
];

/** The groups as a depth shows them: without fields that it leaves out; the basic ones are one list. */
export function shownAt(depth: Depth, groups: readonly Group[]): readonly Group[] {
  switch (depth) {
    case 'basic': {
      const fields = groups.flatMap((group) => group.fields);
      const found = basic.map((path) => fields.find((field) => field.path === path)).filter((it) => it !== undefined);
      return [{ path: '', label: '', fields: found }];
    }
    case 'usual':
      return only(groups, ({ path }) => usual.some((it) => path === it || path.startsWith(`${it}.`)));
    case 'all':
      return groups;
    default:
      return depth satisfies never;
  }
}

/** The least depth that shows a setting. */
export function depthOf(path: string, groups: readonly Group[]): Depth | undefined {
  return depths.find((depth) => shownAt(depth, groups).some(({ fields }) => fields.some((it) => it.path === path)));
}

/** The groups with the fields that a search finds: every word stands in its label (English, and as `labelOf` says it), its path or its help. */
export function found(
  groups: readonly Group[],
  search: string,
  labelOf: (field: Field) => string = ({ label }) => label,
): readonly Group[] {
  const words = search
    .toLowerCase()
    .split(/\s+/)
    .filter((it) => it !== '');
  return only(groups, (field) => {
    const { label, path, help } = field;
    const text = `${labelOf(field)} ${label} ${path.replaceAll('_', ' ')} ${path} ${help}`.toLowerCase();
    return words.every((word) => text.includes(word));
  });
}

function only(groups: readonly Group[], keep: (field: Field) => boolean): readonly Group[] {
  return groups
    .map((group) => ({ ...group, fields: group.fields.filter(keep) }))
    .filter(({ fields }) => fields.length > 0);
}
