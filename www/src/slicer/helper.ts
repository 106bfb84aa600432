// A helper lane's side of the conversation: it slices what the lead hands out and keeps nothing.
import type { HelperReply, HelperRequest } from '../messages.ts';
import { type Engine, taken } from './lead.ts';

export function help(engine: Engine, request: HelperRequest): HelperReply {
  const chunk = engine.slice_share(request.share);
  return { kind: 'slice', meta: chunk.meta(), ...taken(chunk) };
}
