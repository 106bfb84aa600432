import { expect, test } from 'vitest';
import { type Camera, canvasSize, fitTo, numbers, pan, toMm, toScreen, zoom } from '../../www/src/view/camera.ts';

const size = { width: 400, height: 300 };
const camera: Camera = { scale: 4, x: 110, y: 100 };

test('the middle of the view is the camera’s point; y goes up', () => {
  expect(toMm(camera, { x: 200, y: 150 }, size)).toEqual({ x: 110, y: 100 });
  expect(toMm(camera, { x: 204, y: 146 }, size)).toEqual({ x: 111, y: 101 });
  expect(toScreen(camera, { x: 111, y: 101 }, size)).toEqual({ x: 204, y: 146 });
});

test('a fitted picture is inside the view and touches nine tenths of one side', () => {
  const fitted = fitTo([0, 0, 100, 20], size);
  expect(fitted).toEqual({ scale: 3.6, x: 50, y: 10 });
  expect(toScreen(fitted, { x: 0, y: 0 }, size).x).toBeCloseTo(20);
});

test('a picture without extent can be fitted', () => {
  expect(Number.isFinite(fitTo([5, 5, 5, 5], size).scale)).toBe(true);
});

test('zooming keeps the point under the pointer, and ends at the limits', () => {
  const spot = { x: 37, y: 250 };
  const closer = zoom(camera, 1.5, spot, size);
  expect(closer.scale).toBe(6);
  expect(toMm(closer, spot, size).x).toBeCloseTo(toMm(camera, spot, size).x);
  expect(toMm(closer, spot, size).y).toBeCloseTo(toMm(camera, spot, size).y);
  expect(zoom(camera, 1e9, spot, size).scale).toBe(2000);
  expect(zoom(camera, 1e-9, spot, size).scale).toBe(0.05);
});

test('panning moves the picture with the pointer', () => {
  const point = { x: 100, y: 90 };
  const before = toScreen(camera, point, size);
  const after = toScreen(pan(camera, 30, -12), point, size);
  expect([after.x - before.x, after.y - before.y]).toEqual([30, -12]);
});

test('the canvas has the pixels of the device', () => {
  expect(numbers(camera, size, 2)).toEqual([4, 110, 100, 400, 300, 2]);
  expect(canvasSize(numbers(camera, size, 1.5))).toEqual({ width: 600, height: 450 });
  expect(canvasSize([1, 0, 0, 0, 0, 1])).toEqual({ width: 1, height: 1 });
});
