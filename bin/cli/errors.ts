// Any error -> one line and the exit code for it.
import { EngineError } from '../../www/src/slicer/errors.ts';
import { UsageError } from './args.ts';
import { settingHint } from './nearest.ts';

/** A file of the user that can't be used: a model (3), or settings and output (2). */
export class FileError extends Error {
  override name = 'FileError';
  readonly exitCode: 2 | 3;

  constructor(file: string, reason: string, exitCode: 2 | 3) {
    super(`${file}: ${reason}`);
    this.exitCode = exitCode;
  }
}

/** What a failed file operation says, in words. */
export function reasonOf(error: unknown): string {
  const code = error instanceof Error && 'code' in error ? String(error.code) : '';
  const words: Record<string, string> = {
    ENOENT: 'no such file or folder',
    EACCES: 'no permission',
    EPERM: 'no permission',
    EISDIR: 'is a folder',
    ENOTDIR: 'its folder is not a folder',
    ENOSPC: 'no space left on the disk',
    EROFS: 'the disk is read-only',
  };
  return words[code] ?? (error instanceof Error ? error.message : String(error));
}

/** Errors about what was typed, not about the model. */
const aboutWords = ['SettingsError', 'UsageError'];
const engineCodes: Record<string, number> = { UsageError: 2, SettingsError: 2, ModelError: 3, FitError: 4 };

/** The exit code and the line for stderr; `asked` are the paths of settings that were given as words. */
export function verdict(
  error: unknown,
  models: readonly string[],
  asked: readonly string[] = [],
): { code: number; line: string } {
  if (error instanceof UsageError) return { code: 2, line: error.message };
  if (error instanceof FileError) return { code: error.exitCode, line: error.message };
  if (error instanceof EngineError) {
    const meant = error.name === 'SettingsError' ? settingHint(error.message, asked) : '';
    return { code: engineCodes[error.name] ?? 1, line: oneLine(`${subject(error, models)}${message(error)}${meant}`) };
  }
  return {
    code: 1,
    line: oneLine(`a bug of ours: ${error instanceof Error ? (error.stack ?? error.message) : error}`),
  };
}

function message(error: EngineError): string {
  return error.name in engineCodes ? error.message : `a bug of ours: ${error.message}`;
}

/** The model's name in front of errors about it; settings errors name their own path. */
function subject(error: EngineError, models: readonly string[]): string {
  if (error.source !== undefined) return `${error.source}: `;
  return !aboutWords.includes(error.name) && models.length === 1 ? `${models[0]}: ` : '';
}

const oneLine = (text: string): string => text.replaceAll(/\s*\n\s*/g, ' ').trim();
