// The licences of the Rust crates that are compiled into the wasm modules, as a file beside what Vite builds.
// Vite itself tells those of the npm packages (`build.license`).
import { execFileSync } from 'node:child_process';
import { readdirSync, readFileSync } from 'node:fs';
import path from 'node:path';
import { at, wasmTarget } from './places.mjs';

/** A Vite plugin that writes licences-engine.md. */
export function crateLicences() {
  return {
    name: 'crate licences',
    /** @this {import('rolldown').PluginContext} */
    generateBundle() {
      this.emitFile({ type: 'asset', fileName: 'licences-engine.md', source: text() });
    },
  };
}

function text() {
  const crates = compiledCrates().map(({ name, version, license, manifest_path }) => {
    const folder = path.dirname(manifest_path);
    return `## ${name} ${version} (${license})\n\n${texts(folder).join('\n\n')}`;
  });
  return `# Licences\n\nThe engine is made of these crates besides our own:\n\n${crates.join('\n\n')}\n`;
}

/** The licence files of a crate; of several to choose from the MIT licence. */
function texts(folder) {
  const files = readdirSync(folder).filter((it) => /^(LICENSE|LICENCE|COPYING)/i.test(it));
  const mit = files.filter((it) => /MIT/i.test(it));
  return (mit.length > 0 ? mit : files).sort().map((it) => readFileSync(path.join(folder, it), 'utf8').trim());
}

/** Crates behind ours that are not only used while building. */
function compiledCrates() {
  const args = ['metadata', '--locked', '--format-version', '1', '--filter-platform', wasmTarget];
  const found = execFileSync('cargo', args, { cwd: at(), encoding: 'utf8', maxBuffer: 1 << 28 });
  const { packages, resolve, workspace_members: own } = JSON.parse(found);
  const byId = new Map(packages.map((it) => [it.id, it]));
  const uses = new Map(resolve.nodes.map((it) => [it.id, it.deps]));
  const isCompiled = ({ pkg, dep_kinds }) =>
    dep_kinds.some(({ kind }) => kind === null) &&
    !byId.get(pkg).targets.some(({ kind }) => kind.includes('proc-macro'));
  const seen = new Set(own);
  for (const id of seen) {
    for (const dep of uses.get(id).filter(isCompiled)) seen.add(dep.pkg);
  }
  const foreign = [...seen].filter((id) => !own.includes(id)).map((id) => byId.get(id));
  return foreign.sort((a, b) => (`${a.name} ${a.version}` < `${b.name} ${b.version}` ? -1 : 1));
}
