// Pointers, wheel and keys -> zooming and panning.
import type { Spot } from './camera.ts';

export interface Moves {
  pan(right: number, down: number): void;
  /** `spot` is where to zoom; undefined means the middle. */
  zoom(factor: number, spot?: Spot): void;
  fit(): void;
  /** So many layers up. */
  step(layers: number): void;
}

const KEY_PAN = 40; // pixels a key press moves the picture
const KEY_ZOOM = 1.25;
/** Zoom per pixel of wheel travel: a notch of a mouse (100) is a fifth closer. */
const WHEEL_ZOOM = 0.0018;

/** Keys of the view; undefined when the key does nothing there. */
export function keyMove(key: string, moves: Moves): (() => void) | undefined {
  const table: Readonly<Record<string, () => void>> = {
    ArrowLeft: () => moves.pan(KEY_PAN, 0),
    ArrowRight: () => moves.pan(-KEY_PAN, 0),
    ArrowUp: () => moves.pan(0, KEY_PAN),
    ArrowDown: () => moves.pan(0, -KEY_PAN),
    '+': () => moves.zoom(KEY_ZOOM),
    '=': () => moves.zoom(KEY_ZOOM),
    '-': () => moves.zoom(1 / KEY_ZOOM),
    '0': () => moves.fit(),
    PageUp: () => moves.step(1),
    PageDown: () => moves.step(-1),
  };
  return table[key];
}

/** Listens to everything that moves the picture in `stage`. */
export function listen(stage: HTMLElement, moves: Moves): void {
  const pointers = new Map<number, Spot>();
  const spot = (event: MouseEvent): Spot => {
    const box = stage.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  };

  stage.addEventListener('pointerdown', (event) => {
    if ((event.target as HTMLElement).closest('button, input') !== null) return;
    stage.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, spot(event));
  });
  stage.addEventListener('pointermove', (event) => {
    const before = pointers.get(event.pointerId);
    if (before === undefined) return;
    const now = spot(event);
    const other = [...pointers].find(([id]) => id !== event.pointerId)?.[1];
    pointers.set(event.pointerId, now);
    if (other !== undefined)
      moves.zoom(distance(now, other) / Math.max(distance(before, other), 1), middle(now, other));
    const share = other === undefined ? 1 : 0.5;
    moves.pan((now.x - before.x) * share, (now.y - before.y) * share);
  });
  const leave = (event: PointerEvent): void => void pointers.delete(event.pointerId);
  stage.addEventListener('pointerup', leave);
  stage.addEventListener('pointercancel', leave);
  stage.addEventListener('dblclick', () => moves.fit());
  stage.addEventListener(
    'wheel',
    (event) => {
      event.preventDefault();
      moves.zoom(Math.exp(-WHEEL_ZOOM * event.deltaY * (event.deltaMode === 1 ? 33 : 1)), spot(event));
    },
    { passive: false },
  );
  stage.addEventListener('keydown', (event) => {
    if (event.target !== stage || event.ctrlKey || event.metaKey || event.altKey) return;
    const move = keyMove(event.key, moves);
    if (move === undefined) return;
    event.preventDefault();
    move();
  });
}

const distance = (a: Spot, b: Spot): number => Math.hypot(a.x - b.x, a.y - b.y);
const middle = (a: Spot, b: Spot): Spot => ({ x: (a.x + b.x) / 2, y: (a.y + b.y) / 2 });
