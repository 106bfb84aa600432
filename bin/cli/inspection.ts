// An inspection in words, one fact a line.

/** `inspection` is the engine's JSON; numbers are shortened to what a person reads. */
export function inWords(inspection: string): string {
  const facts = JSON.parse(inspection) as Record<string, unknown>;
  const { warnings, ...rest } = facts;
  const told = Object.entries(rest).filter(([, value]) => words(value) !== '');
  const width = Math.max(...told.map(([name]) => name.length));
  const lines = told.map(([name, value]) => `${name.padEnd(width)}  ${words(value)}`);
  return [...lines, ...warningLines(warnings)].map((line) => `${line}\n`).join('');
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
