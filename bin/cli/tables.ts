// Reports of the engine as tables of text, one possibility a line.
import type { AdhesionReport, OrientationReport } from '../../www/src/generated/report.ts';

/** The figures of each direction; the chosen one is marked. `report` is an OrientationReport as JSON. */
export function directionTable(report: string): string {
  const { directions, chosen } = JSON.parse(report) as OrientationReport;
  const rows = directions.map((it) => [
    it.id === chosen ? '>' : '',
    String(it.id),
    it.up.map((x) => x.toFixed(2)).join(' '),
    it.support_mm3.toFixed(1),
    it.total_mm3.toFixed(1),
    String(it.structures),
    it.bed_contact_mm2.toFixed(0),
    it.height_mm.toFixed(1),
  ]);
  return aligned([['', 'id', 'up', 'support mm3', 'with base', 'structures', 'bed mm2', 'height mm'], ...rows]);
}

/** What each kind of base layer comes to. `report` is a list of AdhesionReports as JSON. */
export function adhesionTable(report: string): string {
  const kinds = JSON.parse(report) as AdhesionReport[];
  const rows = kinds.map((it) => [
    it.kind,
    it.filament_mm3.toFixed(1),
    it.time_s.toFixed(0),
    it.slicing_ms.toFixed(1),
    it.bed_contact_mm2.toFixed(1),
    it.attachment_mm.toFixed(1),
    `${(100 * it.attachment_share).toFixed(0)} %`,
    it.teeth === null || it.teeth === undefined ? '' : String(it.teeth.placed),
  ]);
  const head = ['kind', 'filament mm3', 'time s', 'slicing ms', 'bed mm2', 'attachment mm', 'share', 'teeth'];
  return aligned([head, ...rows]);
}

function aligned(rows: readonly string[][]): string {
  const widths = (rows[0] ?? []).map((_, column) => Math.max(...rows.map((row) => (row[column] ?? '').length)));
  const line = (row: readonly string[]) => row.map((cell, column) => cell.padStart(widths[column] ?? 0)).join('  ');
  return rows.map((row) => `${line(row).trimEnd()}\n`).join('');
}
