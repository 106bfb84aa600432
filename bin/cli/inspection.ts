// An inspection in words, one fact a line.

/** `inspection` is the engine's JSON; numbers are shortened to what a person reads. */
export function inWords(inspection: string): string {
  const facts = JSON.parse(inspection) as Record<string, unknown>;
  const { warnings, ...rest } = facts;
  const width = Math.max(...Object.keys(rest).map((it) => it.length));
  const lines = Object.entries(rest).map(([name, value]) => `${name.padEnd(width)}  ${words(value)}`);
  return [...lines, ...warningLines(warnings)].map((line) => `${line}\n`).join('');
}

function warningLines(warnings: unknown): string[] {
  if (!Array.isArray(warnings)) return [];
  return warnings.map((it: { message?: unknown }) => `warning: ${it.message ?? JSON.stringify(it)}`);
}

function words(value: unknown): string {
  if (typeof value === 'number') return String(Math.round(value * 1000) / 1000);
  if (Array.isArray(value)) return value.map(words).join(Array.isArray(value[0]) ? ' to ' : ' x ');
  if (typeof value === 'object' && value !== null) {
    return Object.entries(value)
      .map(([name, it]) => `${name} ${words(it)}`)
      .join(', ');
  }
  return String(value);
}
