// Whether there can be pictures in space.

let drawsSpace: boolean | undefined;

/** Whether the browser can draw in space; tried once. */
export function canDrawSpace(): boolean {
  if (drawsSpace !== undefined) return drawsSpace;
  const context = document.createElement('canvas').getContext('webgl2');
  context?.getExtension('WEBGL_lose_context')?.loseContext();
  drawsSpace = context !== null;
  return drawsSpace;
}

/** Whether pictures in space are drawn by more than software, which would take five times as long for smooth edges. */
export function hasGraphicsCard(): boolean {
  const context = document.createElement('canvas').getContext('webgl2', { failIfMajorPerformanceCaveat: true });
  context?.getExtension('WEBGL_lose_context')?.loseContext();
  return context !== null;
}
