// The pictures in space, drawn by the browser's own software renderer.
import type { Page } from '@playwright/test';
import { binaryStl, box } from '../node/shapes.ts';
import { expect, layerSlider, opened, openFile, picture, ready, settled, sliceButton, stepTab, test } from './page.ts';

test.use({
  launchOptions: [
    async ({ launchOptions }, use) => {
      const args = (launchOptions.args ?? []).filter((it) => !['--disable-gpu', '--disable-3d-apis'].includes(it));
      await use({ ...launchOptions, args: [...args, '--use-angle=swiftshader', '--enable-unsafe-swiftshader'] });
    },
    { scope: 'worker' },
  ],
});

const row = (page: Page) => page.getByRole('list', { name: 'Parts on the bed' }).getByRole('button').first();

test('a part is chosen, dragged and laid on a face in the picture', async ({ page }) => {
  await opened(page);
  await openFile(page, { name: 'bar.stl', bytes: binaryStl(box(40, 20, 10)) });
  await expect(row(page)).toContainText('40 × 20 × 10 mm');
  await page.getByRole('button', { name: 'Top', exact: true }).click();
  const before = await settled(page);
  const view = await picture(page).boundingBox();
  if (view === null) throw new Error('no picture');
  const [x, y] = [view.x + view.width / 2, view.y + view.height / 2];
  await page.mouse.click(x, y);
  await expect(row(page)).toHaveAttribute('aria-pressed', 'true');
  expect((await settled(page)).equals(before)).toBe(false);
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 60, y, { steps: 5 });
  await page.mouse.up();
  await expect.poll(async () => Number(await page.getByLabel('Middle along X, mm').inputValue())).toBeGreaterThan(111);
  expect(Number(await page.getByLabel('Middle along Y, mm').inputValue())).toBeCloseTo(110, 0);
  await page.getByRole('button', { name: 'Undo' }).click();
  await expect(page.getByLabel('Middle along X, mm')).toHaveValue('110');

  await page.getByRole('button', { name: 'Front', exact: true }).click();
  await page.getByRole('button', { name: 'Lay a face flat' }).click();
  await settled(page);
  await page.mouse.click(x, y);
  await expect(row(page)).toContainText('40 × 10 × 20 mm');

  await picture(page).focus();
  await page.keyboard.press('Shift+ArrowRight');
  await expect(page.getByLabel('Middle along X, mm')).toHaveValue('111');
  await page.keyboard.press('Delete');
  await expect(row(page)).toHaveCount(0);
});

/** What the page tells the graphics card, counted from now on. */
interface Told {
  /** Calls that draw, and frames that have any. */
  draws: number;
  /** Calls that hand over vertices, colours or pictures. */
  uploads: number;
}

/** Counts what goes to the graphics card. */
function countGraphics(): void {
  const told: Told = { draws: 0, uploads: 0 };
  Object.assign(window, { told });
  const count = (kind: keyof Told, names: readonly string[]): void => {
    const methods = WebGL2RenderingContext.prototype as unknown as Record<string, (...all: unknown[]) => unknown>;
    for (const name of names) {
      const method = methods[name];
      methods[name] = function (...all) {
        told[kind]++;
        return method?.apply(this, all);
      };
    }
  };
  count('draws', ['drawElements', 'drawElementsInstanced', 'drawArrays', 'drawArraysInstanced']);
  count('uploads', ['bufferData', 'bufferSubData', 'texImage2D', 'texSubImage2D']);
}

test('a move of the camera hands nothing over and draws each batch of layers once', async ({ page }) => {
  await page.addInitScript(countGraphics);
  await ready(page);
  await stepTab(page, 'Preview').click();
  await expect(page.getByRole('slider', { name: 'Move' })).toBeVisible();
  const told = (): Promise<Told> => page.evaluate(() => (window as unknown as { told: Told }).told);
  // Batches that nothing can be seen of may come after the picture has settled.
  let before: Told = { draws: -1, uploads: -1 };
  const isQuiet = async (): Promise<boolean> => {
    const last = before;
    before = await told();
    return before.draws === last.draws && before.uploads === last.uploads;
  };
  await expect.poll(isQuiet, { intervals: [700] }).toBe(true);
  await picture(page).focus();
  // The first moves may hand over what a slow device draws while the picture moves, each detail once.
  const handedOver = async (): Promise<number> => {
    const { uploads } = before;
    await page.keyboard.press('ArrowLeft');
    await settled(page);
    await expect.poll(isQuiet, { intervals: [700] }).toBe(true);
    return before.uploads - uploads;
  };
  await expect.poll(handedOver, { timeout: 60_000 }).toBe(0);
  const still = await settled(page);
  const draws = before.draws;
  await page.keyboard.press('ArrowLeft');
  await expect.poll(async () => (await told()).draws).toBeGreaterThan(draws);
  // 240 layers are ten batches, in five parts on a slow device; plate, grids, borders and arrows are a dozen more;
  // two frames at the most.
  expect((await told()).draws - draws).toBeLessThanOrEqual(2 * (5 * 10 + 12));
  expect((await settled(page)).equals(still)).toBe(false);
});

test('the beads in space: layers, moves, colours, roles, flat view', async ({ page }) => {
  await ready(page);
  await sliceButton(page).click();
  await expect(stepTab(page, 'Preview')).toHaveAttribute('aria-selected', 'true');
  const moves = page.getByRole('slider', { name: 'Move' });
  await expect(moves).toBeVisible();
  await layerSlider(page).fill('120');
  const half = await settled(page);
  await layerSlider(page).fill('240');
  const whole = await settled(page);
  expect(whole.equals(half)).toBe(false);
  await page.getByRole('button', { name: 'Speed', exact: true }).click();
  const bySpeed = await settled(page);
  expect(bySpeed.equals(whole)).toBe(false);
  await expect(page.locator('.colour-scale')).toContainText('mm/s');
  await page.getByRole('button', { name: 'Role', exact: true }).click();
  expect((await settled(page)).equals(whole)).toBe(true);
  await page.getByLabel('Show Outer wall').uncheck({ force: true });
  expect((await settled(page)).equals(whole)).toBe(false);
  await page.getByLabel('Show Outer wall').check({ force: true });
  await moves.fill('1');
  expect((await settled(page)).equals(whole)).toBe(false);
  await page.getByRole('button', { name: 'Play' }).click();
  await expect.poll(async () => Number(await moves.inputValue())).toBeGreaterThan(1);
  await page.getByRole('button', { name: 'Stop' }).click();
  await page.getByRole('button', { name: 'Flat' }).click();
  await expect(moves).toHaveCount(0);
  expect((await settled(page)).length).toBeGreaterThan(0);
});

test('two clicks measure a distance', async ({ page }) => {
  await opened(page);
  await page.getByRole('button', { name: 'Top', exact: true }).click();
  await settled(page);
  await page.getByRole('button', { name: 'Measure' }).click();
  const view = await picture(page).boundingBox();
  if (view === null) throw new Error('no picture');
  await page.mouse.click(view.x + 100, view.y + 120);
  await page.mouse.click(view.x + 300, view.y + 120);
  await expect(page.locator('output')).toHaveText(/^[\d.]+ mm$/);
});
