// Whether there can be pictures in space.

/** What draws them; "nothing" where there are none. */
type Drawer = 'card' | 'software' | 'nothing';

let drawer: Drawer | undefined;

/** Whether the browser can draw in space; tried once. */
export const canDrawSpace = (): boolean => drawerOfSpace() !== 'nothing';

/** Whether pictures in space are drawn by more than software, which would take five times as long for smooth edges. */
export const hasGraphicsCard = (): boolean => drawerOfSpace() === 'card';

function drawerOfSpace(): Drawer {
  drawer ??= canDraw({ failIfMajorPerformanceCaveat: true }) ? 'card' : canDraw() ? 'software' : 'nothing';
  return drawer;
}

function canDraw(options?: WebGLContextAttributes): boolean {
  const context = document.createElement('canvas').getContext('webgl2', options);
  context?.getExtension('WEBGL_lose_context')?.loseContext();
  return context !== null;
}
