// What the steps' panels have in common: they see the whole state and act through store and session.
import type { Session } from '../session.ts';
import { initial, type State, type Store } from '../state.ts';
import { Part } from './part.ts';

export abstract class StepPart extends Part {
  static override properties = {
    state: { attribute: false },
    store: { attribute: false },
    session: { attribute: false },
  };
  declare state: State;
  declare store: Store | undefined;
  declare session: Session | undefined;

  constructor() {
    super();
    this.state = initial;
    this.store = undefined;
    this.session = undefined;
  }
}
