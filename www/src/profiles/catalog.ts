// The printers, materials and qualities that ship: data of the folder profiles/, checked by tests/profiles.rs.
import abs from '../../../profiles/materials/abs.json';
import asa from '../../../profiles/materials/asa.json';
import pa from '../../../profiles/materials/pa.json';
import petg from '../../../profiles/materials/petg.json';
import pla from '../../../profiles/materials/pla.json';
import tpu from '../../../profiles/materials/tpu.json';
import a1Mini from '../../../profiles/printers/a1_mini.json';
import delta from '../../../profiles/printers/delta.json';
import ender3 from '../../../profiles/printers/ender3.json';
import ender3V3 from '../../../profiles/printers/ender3_v3.json';
import k1 from '../../../profiles/printers/k1.json';
import kobra2 from '../../../profiles/printers/kobra2.json';
import mini from '../../../profiles/printers/mini.json';
import mk3s from '../../../profiles/printers/mk3s.json';
import mk4 from '../../../profiles/printers/mk4.json';
import neptune4 from '../../../profiles/printers/neptune4.json';
import p1s from '../../../profiles/printers/p1s.json';
import sv06 from '../../../profiles/printers/sv06.json';
import voron24 from '../../../profiles/printers/voron24.json';
import draft from '../../../profiles/qualities/draft.json';
import fine from '../../../profiles/qualities/fine.json';
import normal from '../../../profiles/qualities/normal.json';
import type { Layers } from './layers.ts';

/** Whether G-code can be sent over USB: yes, with reservations, or not at all. */
export type UsbCapability = 'ok' | 'limited' | 'none';

export interface Profile {
  readonly id: string;
  readonly name: string;
  /** Where the values come from: addresses of public documents. */
  readonly sources?: readonly string[];
  /** What to know about it, one sentence. */
  readonly note?: string;
  /** A part of the settings. */
  readonly settings: object;
}

export interface PrinterProfile extends Profile {
  readonly vendor: string;
  readonly usb: string;
  readonly usb_note: string;
}

export const printers: readonly PrinterProfile[] = [
  a1Mini,
  delta,
  ender3,
  ender3V3,
  k1,
  kobra2,
  mini,
  mk3s,
  mk4,
  neptune4,
  p1s,
  sv06,
  voron24,
].toSorted((a, b) => `${a.vendor} ${a.name}`.localeCompare(`${b.vendor} ${b.name}`, 'en'));
export const materials: readonly Profile[] = [pla, petg, abs, asa, tpu, pa];
export const qualities: readonly Profile[] = [fine, normal, draft];

const kinds = { printer: printers, material: materials, quality: qualities } as const;
export type Kind = keyof typeof kinds;

/** The profile of this id; undefined when there is none. */
export function profile(kind: Kind, id: string): Profile | undefined {
  return kinds[kind].find((it) => it.id === id);
}

/** The ids that can be chosen. */
export const ids = (kind: Kind): string[] => kinds[kind].map((it) => it.id);

/** Whether the printer takes G-code over USB; a printer of unknown make may. */
export function usbOf(printer: string): UsbCapability {
  const usb = printers.find((it) => it.id === printer)?.usb;
  return usb === 'none' || usb === 'limited' ? usb : 'ok';
}

/** The chosen profiles as settings files, from printer to quality: each lies over the one before. */
export function settingsFiles(layers: Layers): string[] {
  const chosen = (['printer', 'material', 'quality'] as const).map((kind) => {
    const id = layers[kind];
    return id === undefined ? undefined : profile(kind, id);
  });
  return chosen.filter((it) => it !== undefined).map((it) => JSON.stringify(it.settings));
}
