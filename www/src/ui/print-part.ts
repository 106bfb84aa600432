// What the parts of the Print step have in common: they see the state of printing and act through its session.
import type { PrintSession } from '../printer/print-session.ts';
import { type PrintState, printInitial } from '../printer/print-state.ts';
import { Part } from './part.ts';

export abstract class PrintPart extends Part {
  static override properties = { print: { attribute: false }, printing: { attribute: false } };
  declare print: PrintState;
  declare printing: PrintSession | undefined;

  constructor() {
    super();
    this.print = printInitial;
    this.printing = undefined;
  }
}
