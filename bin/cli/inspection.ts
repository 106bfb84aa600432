// An inspection in words, one fact a line.
import type { GcodeFigures } from '../../www/src/generated/gcode-figures.ts';

/** `inspection` is the engine's JSON; numbers are shortened to what a person reads. */
export function inWords(inspection: string): string {
  const facts = JSON.parse(inspection) as Record<string, unknown>;
  const { warnings, ...rest } = facts;
  const told = Object.entries(rest).filter(([, value]) => words(value) !== '');
  const width = Math.max(...told.map(([name]) => name.length));
  const lines = told.map(([name, value]) => `${name.padEnd(width)}  ${words(value)}`);
  return [...lines, ...warningLines(warnings)].map((line) => `${line}\n`).join('');
}

/** Figures of a G-code file in words; `figures` is the engine's GcodeFigures as JSON. */
export function gcodeInWords(figures: string): string {
  const { by_role, filament, time_s, bounds, settings, ...facts } = JSON.parse(figures) as GcodeFigures;
  const [low, high] = bounds;
  const roles = Object.entries(by_role).map(([role, { length_mm, volume_mm3, time_s }]) => {
    const numbers = [`${(length_mm / 1000).toFixed(2)} m`, `${volume_mm3.toFixed(0)} mm3`, duration(time_s)];
    return [`  ${role}`, numbers.join(', ')] as const;
  });
  const told = { ...facts, settings: settings === '' ? '' : `of ${settings}; foothold import reads them` };
  return inWords(
    JSON.stringify({
      ...told,
      bounds: { min: low, max: high },
      filament_m: filament.length_mm / 1000,
      filament_mm3: filament.volume_mm3,
      filament_g: filament.mass_g,
      filament_diameter_mm: filament.diameter_mm,
      time: duration(time_s),
      ...Object.fromEntries(roles),
    }),
  );
}

/** "1h 2m 3s" */
function duration(seconds: number): string {
  const whole = Math.round(seconds);
  const parts = [
    [Math.floor(whole / 3600), 'h'],
    [Math.floor(whole / 60) % 60, 'm'],
    [whole % 60, 's'],
  ] as const;
  const first = parts.findIndex(([count]) => count > 0);
  return parts
    .slice(first < 0 ? -1 : first)
    .map(([count, unit]) => `${count}${unit}`)
    .join(' ');
}

function warningLines(warnings: unknown): string[] {
  if (!Array.isArray(warnings)) return [];
  return warnings.map((it: { message?: unknown }) => `warning: ${it.message ?? JSON.stringify(it)}`);
}

function words(value: unknown): string {
  if (typeof value === 'number') return String(Math.round(value * 1000) / 1000);
  if (Array.isArray(value)) return value.map(words).join(' ');
  if (isExtent(value)) return `${words(value.min)} to ${words(value.max)}`;
  return String(value);
}

function isExtent(value: unknown): value is { min: unknown; max: unknown } {
  return typeof value === 'object' && value !== null && 'min' in value && 'max' in value;
}
