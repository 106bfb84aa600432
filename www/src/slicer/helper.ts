// A helper lane's side of the conversation: it slices what the lead hands out and keeps nothing of it; for
// directions it holds the mesh that it was given.
import type { SharedMesh } from '../generated/engine/foothold.js';
import type { HelperReply, HelperRequest } from '../messages.ts';
import { type Engine, taken } from './lead.ts';

export class Helper {
  readonly #engine: Engine;
  #mesh: SharedMesh | undefined;

  constructor(engine: Engine) {
    this.#engine = engine;
  }

  handle(request: HelperRequest): HelperReply {
    switch (request.kind) {
      case 'slice': {
        const chunk = this.#engine.slice_share(request.share);
        return { kind: 'slice', meta: chunk.meta(), ...taken(chunk) };
      }
      case 'mesh':
        this.#mesh?.free();
        this.#mesh = new this.#engine.SharedMesh(request.mesh);
        return { kind: 'mesh' };
      case 'evaluate': {
        if (this.#mesh === undefined) throw new Error('there is no mesh');
        const { settings, id, up } = request;
        return { kind: 'evaluate', figures: this.#mesh.evaluate(settings, id, Float64Array.from(up)) };
      }
      default:
        return request satisfies never;
    }
  }
}
