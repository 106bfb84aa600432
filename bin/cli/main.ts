// The command line: words in; files, an error in one line or remarks on stderr, and an exit code out.
import { constants } from 'node:os';
import { type Command, help, parseCommand } from './args.ts';
import * as commands from './commands.ts';
import { verdict } from './errors.ts';
import { engineVersion } from './lanes.ts';
import { Output, removeTemporary } from './output.ts';

/** Runs one command; `words` are the arguments after the program's name. Sets the exit code. */
export async function main(words: readonly string[]): Promise<void> {
  for (const signal of ['SIGINT', 'SIGTERM', 'SIGHUP'] as const) process.on(signal, () => stop(signal));
  let command: Command | undefined;
  try {
    command = parseCommand(words);
    await perform(command);
  } catch (error) {
    const { code, line } = verdict(error, modelsOf(command), pathsOf(command));
    process.exitCode = code;
    process.stderr.write(`foothold: ${line}\n`);
  } finally {
    removeTemporary();
  }
}

async function perform(command: Command): Promise<void> {
  switch (command.kind) {
    case 'slice':
      return commands.slice(command);
    case 'place':
      return commands.place(command);
    case 'inspect':
      return commands.inspect(command);
    case 'draw':
      return commands.draw(command);
    case 'orient':
      return commands.orient(command);
    case 'compare':
      return commands.compare(command);
    case 'settings':
      return commands.settings(command);
    case 'import':
      return commands.importProfile(command);
    case 'profiles':
      return commands.profiles();
    case 'help':
      return new Output('-').write([help]);
    case 'version':
      return new Output('-').write([`${engineVersion()}\n`]);
    default:
      return command satisfies never;
  }
}

function modelsOf(command: Command | undefined): readonly string[] {
  if (command === undefined) return [];
  if ('models' in command) return command.models;
  return 'model' in command ? [command.model] : [];
}

/** Paths of the settings that were given as words. */
function pathsOf(command: Command | undefined): readonly string[] {
  const sets = command !== undefined && 'settings' in command ? command.settings.sets : [];
  const own = command !== undefined && 'own' in command ? command.own.map(({ set }) => set) : [];
  return [...sets, ...own].map((set) => set.slice(0, set.indexOf('=')));
}

function stop(signal: 'SIGINT' | 'SIGTERM' | 'SIGHUP'): void {
  removeTemporary();
  process.exit(128 + constants.signals[signal]);
}
