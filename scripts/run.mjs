// Runs programs; a program that fails ends the step with its name and exit code.
import { spawn, spawnSync } from 'node:child_process';
import { existsSync } from 'node:fs';
import path from 'node:path';
import { root } from './places.mjs';

export class CommandFailed extends Error {
  name = 'CommandFailed';
  constructor(command, code, output) {
    super(`${command} ended with ${code}`);
    this.output = output;
  }
}

/**
 * Runs a program, shows what it prints, and resolves to that text.
 * `env` adds to the environment.
 */
export function run(command, args, { env = {}, cwd = root } = {}) {
  return new Promise((resolve, reject) => {
    const child = spawn(command, args, { cwd, env: { ...process.env, ...env }, stdio: ['ignore', 'pipe', 'pipe'] });
    let output = '';
    const show = (stream) => (text) => {
      output += text;
      stream.write(text);
    };
    child.stdout.setEncoding('utf8').on('data', show(process.stdout));
    child.stderr.setEncoding('utf8').on('data', show(process.stderr));
    child.on('error', (error) => reject(new CommandFailed(command, error.message, output)));
    child.on('close', (code, signal) =>
      code === 0 ? resolve(output) : reject(new CommandFailed([command, ...args].join(' '), code ?? signal, output)),
    );
  });
}

/** What a program prints, or undefined when it is missing or fails. */
export function ask(command, args) {
  const result = spawnSync(command, args, { cwd: root, encoding: 'utf8' });
  return result.status === 0 ? result.stdout.trim() : undefined;
}

/** The full path of a program on PATH, or undefined. */
export function which(program) {
  return (process.env.PATH ?? '')
    .split(path.delimiter)
    .map((folder) => path.join(folder, program))
    .find((file) => existsSync(file));
}

/** Runs a program of an npm package in this checkout, such as vite. */
export function runPackage(packageBin, args, options) {
  return run(process.execPath, [path.join(root, 'node_modules', packageBin), ...args], options);
}
