// Reports of the engine as tables of text, one possibility a line.

import type { Entry, Imported } from '../../www/src/files/files.ts';
import type { AdhesionReport, OrientationReport } from '../../www/src/generated/report.ts';
import { materials, printers, qualities } from '../../www/src/profiles/catalog.ts';

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

/** All profiles that ship, by kind. */
export function profileTable(): string {
  const rows = [
    ...printers.map((it) => ['--printer', it.id, `${it.vendor} ${it.name}`, `USB: ${it.usb}`]),
    ...materials.map((it) => ['--material', it.id, it.name, '']),
    ...qualities.map((it) => ['--quality', it.id, it.name, it.note ?? '']),
  ];
  const widths = [0, 1, 2].map((column) => Math.max(...rows.map((row) => (row[column] ?? '').length)));
  const line = (row: readonly string[]): string =>
    row.map((cell, column) => cell.padEnd(widths[column] ?? 0)).join('  ');
  return rows.map((row) => `${line(row).trimEnd()}\n`).join('');
}

/** What became of each value of a profile, one a line. */
export function importTable({ slicer, mapped, changed, unknown }: Imported): string {
  const line = (what: string, { key, value, path, to, why }: Entry): string => {
    const became = path === undefined ? '' : ` -> ${path} = ${to}`;
    return `${what.padEnd(8)} ${key} = ${oneLine(value)}${became}${why === undefined ? '' : ` (${why})`}\n`;
  };
  const lines = [
    ...mapped.map((it) => line('taken', it)),
    ...changed.map((it) => line(it.path === undefined ? 'left' : 'changed', it)),
    ...unknown.map((it) => line('unknown', it)),
  ];
  const left = changed.filter((it) => it.path === undefined).length;
  const counts = `${mapped.length} taken, ${changed.length - left} changed, ${left} left, ${unknown.length} unknown`;
  return `${lines.join('')}${slicer}: ${counts}\n`;
}

const oneLine = (text: string): string => text.replaceAll('\n', '\\n').slice(0, 60);

function aligned(rows: readonly string[][]): string {
  const widths = (rows[0] ?? []).map((_, column) => Math.max(...rows.map((row) => (row[column] ?? '').length)));
  const line = (row: readonly string[]) => row.map((cell, column) => cell.padStart(widths[column] ?? 0)).join('  ');
  return rows.map((row) => `${line(row).trimEnd()}\n`).join('');
}
