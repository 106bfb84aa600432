// What the panels and lessons ask the engine about the models, and what it answers (as JSON).
import type { AdhesionReport } from './generated/report.ts';

export type Lesson = 'teeth' | 'plates' | 'features' | 'orientation';

/** Length of a picture's longer side, CSS px, and what ground it stands on. */
interface Paper {
  readonly side: number;
  readonly dark: boolean;
}

export type Question =
  | ({ readonly about: 'baseLayers' } & Paper)
  | ({ readonly about: 'plane'; readonly plane: string } & Paper)
  | { readonly about: 'sheets' }
  | ({ readonly about: 'lesson'; readonly lesson: Exclude<Lesson, 'orientation'>; readonly at: string } & Paper)
  | ({ readonly about: 'orientation' } & Paper);

/** Something about a first layer that makes it lift. */
export type Reason = 'sharp_corners' | 'long' | 'thin' | 'small' | 'material';

export type BaseKind = AdhesionReport['kind'];

export interface BaseLayer extends AdhesionReport {
  readonly svg: string;
  readonly warnings: readonly string[];
}

export interface BaseLayers {
  readonly recommendation: { readonly kind: BaseKind; readonly reasons: readonly Reason[] };
  readonly kinds: readonly BaseLayer[];
}

export interface PlaneStudy {
  readonly svg: string;
  readonly area_mm2: number;
  readonly at_zero_mm2: number;
  readonly s: number;
  readonly type_a: number;
  readonly g: number;
}

/** A plate without thickness, in the plane `axis` = `at_mm`. */
export interface Sheet {
  readonly axis: 'x' | 'y';
  readonly at_mm: number;
  /** Each an outer contour and its holes, as flat lists u0, z0, u1, z1, ... in mm on the bed; u is the other axis. */
  readonly islands: readonly (readonly (readonly number[])[])[];
}

/** A step of a lesson: one picture or two to compare, and the numbers of its sentences. */
export interface LessonStep {
  readonly id: string;
  readonly svgs: readonly string[];
  readonly facts: Readonly<Record<string, number>>;
}
