// The view lane: owns the canvas of the layer view and an engine that paints on it.
import * as engine from '../generated/engine/foothold.js';
import type { CameraNumbers, LegendEntry, Moves, Theme, ToLane, ViewReply, ViewRequest } from '../messages.ts';
import { watchPanics } from '../slicer/errors.ts';
import { serve } from '../slicer/lane.ts';
import { boundsOf } from '../slicer/lead.ts';
import { live } from '../slicer/life.ts';
import { canvasSize } from './camera.ts';

declare const self: DedicatedWorkerGlobalScope;

let context: OffscreenCanvasRenderingContext2D | null = null;
let scene: engine.Scene | undefined;

function handle(request: ViewRequest): ViewReply {
  switch (request.kind) {
    case 'canvas':
      context = request.canvas.getContext('2d');
      return { kind: 'canvas' };
    case 'roles':
      return { kind: 'roles', roles: engine.role_colours() };
    case 'layer':
      scene?.free();
      scene = engine.Scene.layer(request.text, request.settings, request.marks);
      return { kind: 'layer', bounds: boundsOf(scene), legend: JSON.parse(scene.legend()) as LegendEntry[] };
    case 'moves':
      return { kind: 'moves', ...movesOf(request.text, request.settings) };
    case 'paint':
      paint(request.camera, request.theme);
      return { kind: 'paint' };
    default:
      return request satisfies never;
  }
}

function movesOf(text: Uint8Array, settings: string): Moves {
  const read = engine.Moves.read(text, settings);
  const moves = {
    ends: read.ends(),
    sizes: read.sizes(),
    roles: read.roles(),
    speeds: read.speeds(),
    flows: read.flows(),
    fans: read.fans(),
    tools: read.tools(),
    layers: read.layers(),
  };
  read.free();
  return moves;
}

function paint(camera: CameraNumbers, theme: Theme): void {
  if (context === null || scene === undefined) return;
  const { width, height } = canvasSize(camera);
  if (context.canvas.width !== width) context.canvas.width = width;
  if (context.canvas.height !== height) context.canvas.height = height;
  scene.paint(context, Float64Array.from(camera), theme);
}

watchPanics(console.warn);

const receive = serve<ViewRequest, ViewReply>(
  (module) => {
    engine.initSync({ module });
    return handle;
  },
  (message, transfer) => self.postMessage(message, transfer),
);

live((message) => self.postMessage(message));
self.onmessage = ({ data }: MessageEvent<ToLane<ViewRequest>>) => receive(data);
