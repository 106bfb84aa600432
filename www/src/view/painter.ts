// What the view asks for to be painted: layers by the view lane, the model's picture by the lead.
import type {
  Bounds,
  CameraNumbers,
  LegendEntry,
  Moves,
  PictureView,
  ReplyTo,
  Shape,
  Standing,
  Theme,
  ViewReply,
  ViewRequest,
} from '../messages.ts';
import { EngineError } from '../slicer/errors.ts';
import type { ViewLane } from '../slicer/lane.ts';
import type { Pool } from '../slicer/pool.ts';
import type { RoleColour } from './colours.ts';

/** A layer's G-code, with the travel to it, and the settings it was made with. */
export interface LayerText {
  readonly text: Uint8Array;
  readonly settings: string;
  /** What is drawn besides the paths: rail and teeth on the first layer. */
  readonly marks: Uint8Array;
}

export interface Painter {
  /** Counts the view lanes: one that broke was replaced, and its canvas is lost. */
  readonly lanes: number;
  /** Gives the layer canvas away; once for each view lane. */
  adopt(canvas: OffscreenCanvas): Promise<void>;
  layer(layer: LayerText): Promise<{ readonly bounds: Bounds; readonly legend: readonly LegendEntry[] }>;
  paintLayer(camera: CameraNumbers, theme: Theme): Promise<void>;
  picture(side: PictureView, standing: Standing | undefined): Promise<Bounds>;
  /** All roles with their colours, as the moves count them. */
  roles(): Promise<readonly RoleColour[]>;
  /** The triangles of an open model. */
  shape(model: number): Promise<Shape>;
  /** The moves of some layers' G-code, whose text goes over to the lane. */
  moves(layers: { readonly text: Uint8Array<ArrayBuffer>; readonly settings: string }): Promise<Moves>;
  /** Undefined when the picture has to be asked for again. */
  paintPicture(camera: CameraNumbers, theme: Theme): Promise<ImageBitmap | undefined>;
  /** Ends the view lane; nothing is painted any more. */
  close(): void;
}

/** `start` makes a view lane, and another one when that broke. */
export function painter(pool: Pool, start: () => ViewLane): Painter {
  let lane = start();
  let lanes = 1;
  let closed = false;
  const call = async <R extends ViewRequest>(
    request: R,
    transfer?: Transferable[],
  ): Promise<ReplyTo<ViewReply, R['kind']>> => {
    const asked = lane;
    try {
      return await asked.call(request, transfer);
    } catch (error) {
      if (isBroken(error) && asked === lane && !closed) {
        lane = start();
        lanes++;
      }
      throw error;
    }
  };
  return {
    get lanes() {
      return lanes;
    },
    adopt: async (canvas) => void (await call({ kind: 'canvas', canvas }, [canvas])),
    layer: ({ text, settings, marks }) => call({ kind: 'layer', text, settings, marks }),
    paintLayer: async (camera, theme) => void (await call({ kind: 'paint', camera, theme })),
    picture: (side, standing) => pool.picture(side, standing),
    roles: async () => JSON.parse((await call({ kind: 'roles' })).roles) as readonly RoleColour[],
    shape: (model) => pool.shape(model),
    moves: ({ text, settings }) => call({ kind: 'moves', text, settings }, [text.buffer]),
    paintPicture: (camera, theme) => pool.paint(camera, theme),
    close: () => {
      closed = true;
      lane.close();
    },
  };
}

/** Whether an error ended its lane: another try talks to a new one. */
export const isBroken = (error: unknown): boolean => error instanceof EngineError && error.fatal;
