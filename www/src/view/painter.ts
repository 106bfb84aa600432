// What the view asks for to be painted: layers by the view lane, the model's picture by the lead.
import type { Bounds, CameraNumbers, LegendEntry, Moves, PictureView, Shape, Standing, Theme } from '../messages.ts';
import type { Pool } from '../slicer/pool.ts';
import type { ViewLane } from '../slicer/threads.ts';
import type { RoleColour } from './colours.ts';

/** A layer's G-code, with the travel to it, and the settings it was made with. */
export interface LayerText {
  readonly text: Uint8Array;
  readonly settings: string;
  /** What is drawn besides the paths: rail and teeth on the first layer. */
  readonly marks: Uint8Array;
}

export interface Painter {
  /** Gives the layer canvas away; once. */
  adopt(canvas: OffscreenCanvas): Promise<void>;
  layer(layer: LayerText): Promise<{ readonly bounds: Bounds; readonly legend: readonly LegendEntry[] }>;
  paintLayer(camera: CameraNumbers, theme: Theme): Promise<void>;
  picture(side: PictureView, standing: Standing | undefined): Promise<Bounds>;
  /** All roles with their colours, as the moves count them. */
  roles(): Promise<readonly RoleColour[]>;
  /** The triangles of an open model. */
  shape(model: number): Promise<Shape>;
  /** The moves of some layers' G-code. */
  moves(layers: Omit<LayerText, 'marks'>): Promise<Moves>;
  /** Undefined when the picture has to be asked for again. */
  paintPicture(camera: CameraNumbers, theme: Theme): Promise<ImageBitmap | undefined>;
}

export function painter(pool: Pool, lane: ViewLane): Painter {
  return {
    adopt: async (canvas) => void (await lane.call({ kind: 'canvas', canvas }, [canvas])),
    layer: ({ text, settings, marks }) => lane.call({ kind: 'layer', text, settings, marks }),
    paintLayer: async (camera, theme) => void (await lane.call({ kind: 'paint', camera, theme })),
    picture: (side, standing) => pool.picture(side, standing),
    roles: async () => JSON.parse((await lane.call({ kind: 'roles' })).roles) as readonly RoleColour[],
    shape: (model) => pool.shape(model),
    moves: ({ text, settings }) => lane.call({ kind: 'moves', text, settings }),
    paintPicture: (camera, theme) => pool.paint(camera, theme),
  };
}
