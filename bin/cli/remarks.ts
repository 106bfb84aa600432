// What the engine has to say of a sliced part, for people at a terminal.
import type { Report, Warning } from '../../www/src/generated/report.ts';

/** Lines of one kind at most; the report has all. */
const MOST = 3;

/** One line for each remark: words, place, and the options that would mend it. */
export function remarkLines(report: string): string[] {
  const { warnings } = JSON.parse(report) as Pick<Report, 'warnings'>;
  const kinds = new Map<string, Warning[]>();
  for (const remark of warnings) kinds.set(remark.code, [...(kinds.get(remark.code) ?? []), remark]);
  return [...kinds].flatMap(([code, remarks]) => {
    const lines = remarks.slice(0, MOST).map(remarkLine);
    const more = remarks.length - lines.length;
    return more > 0 ? [...lines, `warning: ${more} more like these (${code}): --report has them all`] : lines;
  });
}

function remarkLine({ message, layer, at, fix }: Warning): string {
  const onLayer = typeof layer === 'number' ? [`layer ${layer}`] : [];
  const beside = at ? [`at ${at.map((x) => x.toFixed(1)).join(', ')}`] : [];
  const place = [...onLayer, ...beside].join(' ');
  const mend = fix.map((set) => `--set ${set.replace(/="([\w.-]+)"$/, '=$1')}`).join(' ');
  return `warning: ${message}${place === '' ? '' : ` (${place})`}${mend === '' ? '' : `; mended by ${mend}`}`;
}
