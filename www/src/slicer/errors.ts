// The engine's errors as they cross threads: a stable name, a readable message.
import type { Failure } from '../messages.ts';

/** Names of errors that the engine throws on purpose; anything else is a bug of ours. */
const expected = ['ModelError', 'SettingsError', 'FitError', 'UsageError'];

/** An error of the engine. `source` is the name of the model file it is about, where there is one. */
export class EngineError extends Error {
  readonly fatal: boolean;
  readonly source: string | undefined;
  /** A change to every part, the engine's `Edit` as JSON, that would mend it. */
  readonly fix: string | undefined;

  constructor(failure: Failure) {
    super(failure.message);
    this.name = failure.name;
    this.fatal = failure.fatal;
    this.source = failure.source;
    this.fix = failure.fix;
  }

  /** As it crosses threads; `source` is the file that it is about, unless it names one itself. */
  failure(source?: string): Failure {
    const about = this.source ?? source;
    const { name, message, fatal, fix } = this;
    return {
      name,
      message,
      fatal,
      ...(about === undefined ? {} : { source: about }),
      ...(fix === undefined ? {} : { fix }),
    };
  }
}

/** A lane's thread ended, or its engine broke: what it was doing is lost. */
export function laneDied(reason: string): EngineError {
  return new EngineError({ name: 'InternalError', message: reason, fatal: true });
}

/** What the engine's last panic said; its hook prints that to the console before the trap. */
let panic: string | undefined;

/** Remembers what a panic prints, for the error's message; `show` gets it as well. */
export function watchPanics(show: (...text: unknown[]) => void): void {
  console.error = (...text: unknown[]) => {
    const lines = String(text[0]).split('\n');
    panic = lines[0]?.startsWith('panicked at') === true ? lines.slice(0, 2).join(' ').trim() : panic;
    show(...text);
  };
}

/** Any thrown value as a failure; what the engine does not throw on purpose makes its lane untrusted. */
export function toFailure(error: unknown, source?: string): Failure {
  const about = source === undefined ? {} : { source };
  if (error instanceof EngineError) return error.failure(source);
  if (error instanceof Error && expected.includes(error.name)) {
    const fix = 'fix' in error && typeof error.fix === 'string' ? { fix: error.fix } : {};
    return { name: error.name, message: error.message, fatal: false, ...about, ...fix };
  }
  const message = panic ?? (error instanceof Error ? error.message : String(error));
  return { name: 'InternalError', message, fatal: true, ...about };
}

/** Whether a rejection only says that somebody cancelled. */
export function isCancel(error: unknown): boolean {
  return error instanceof DOMException && error.name === 'AbortError';
}
