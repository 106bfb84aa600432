// Where the view looks: pure functions between millimetres on the bed and pixels on the screen.
import type { Bounds, CameraNumbers } from '../messages.ts';

/** `scale` is CSS pixels per mm; `x`, `y` the point in mm at the middle of the view. */
export interface Camera {
  readonly scale: number;
  readonly x: number;
  readonly y: number;
}

/** Size of the view in CSS pixels. */
export interface Size {
  readonly width: number;
  readonly height: number;
}

/** A place in the view, CSS pixels from its top left corner. */
export interface Spot {
  readonly x: number;
  readonly y: number;
}

/** Farthest out and in, CSS pixels per mm: a bed of metres, a bead as wide as the screen. */
const SCALES = [0.05, 2000] as const;
/** Share of the view that a fitted picture fills. */
const FIT_SHARE = 0.9;

/** The camera that shows all of `bounds`. */
export function fitTo([minX, minY, maxX, maxY]: Bounds, size: Size): Camera {
  const [width, height] = [Math.max(maxX - minX, 1), Math.max(maxY - minY, 1)];
  const scale = FIT_SHARE * Math.min(size.width / width, size.height / height);
  return { scale: clamp(scale), x: (minX + maxX) / 2, y: (minY + maxY) / 2 };
}

/** Zooms by `factor`; what is under `spot` stays there. */
export function zoom(camera: Camera, factor: number, spot: Spot, size: Size): Camera {
  const scale = clamp(camera.scale * factor);
  const before = toMm(camera, spot, size);
  const after = toMm({ ...camera, scale }, spot, size);
  return { scale, x: camera.x + before.x - after.x, y: camera.y + before.y - after.y };
}

/** Moves the picture by so many pixels to the right and down. */
export function pan(camera: Camera, right: number, down: number): Camera {
  return { ...camera, x: camera.x - right / camera.scale, y: camera.y + down / camera.scale };
}

/** The millimetres under a spot; y goes up on the bed and down on the screen. */
export function toMm(camera: Camera, spot: Spot, size: Size): Spot {
  return {
    x: camera.x + (spot.x - size.width / 2) / camera.scale,
    y: camera.y - (spot.y - size.height / 2) / camera.scale,
  };
}

/** The spot that shows a point in millimetres. */
export function toScreen(camera: Camera, point: Spot, size: Size): Spot {
  return {
    x: size.width / 2 + (point.x - camera.x) * camera.scale,
    y: size.height / 2 - (point.y - camera.y) * camera.scale,
  };
}

/** As the engine's painter takes it; `ratio` is device pixels per CSS pixel. */
export function numbers(camera: Camera, size: Size, ratio: number): CameraNumbers {
  return [camera.scale, camera.x, camera.y, size.width, size.height, ratio];
}

/** The canvas for it, in pixels of the device. */
export function canvasSize([, , , width, height, ratio]: CameraNumbers): Size {
  const pixels = (length: number): number => Math.max(1, Math.round(length * ratio));
  return { width: pixels(width), height: pixels(height) };
}

const clamp = (scale: number): number => Math.min(Math.max(scale, SCALES[0]), SCALES[1]);
