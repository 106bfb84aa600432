// Files of other programs in the page: G-code of other slicers, and parts that need a hint.
import { readFile, writeFile } from 'node:fs/promises';
import { binaryStl, box } from '../node/shapes.ts';
import { download, expect, layerSlider, opened, openFile, ready, sliceButton, test } from './page.ts';

const gcode = (name: string): string => `tests/fixtures/gcode/${name}.gcode`;

for (const slicer of ['prusaslicer', 'cura', 'orcaslicer']) {
  test(`G-code of ${slicer} is shown in Preview`, async ({ page }) => {
    await ready(page);
    await openFile(page, gcode(slicer));
    await expect(layerSlider(page)).toHaveAttribute('max', /^[12]$/);
    await expect(page.getByRole('row', { name: /Outer wall/ })).toContainText('0.16');
    // What is handed over is the file as it came.
    const { file } = await download(page);
    expect(await readFile(file)).toEqual(await readFile(gcode(slicer)));
  });
}

test('binary G-code is refused by name', async ({ page }, info) => {
  const file = info.outputPath('print.bgcode');
  await writeFile(file, 'GCDE\u0001');
  await ready(page);
  await openFile(page, file);
  await expect(page.getByRole('alert')).toContainText('binary G-code (bgcode) is not read');
});

test('a part that fits turned is turned at one press', async ({ page }, info) => {
  const file = info.outputPath('bar.stl');
  await writeFile(file, binaryStl(box(300, 8, 4)));
  await ready(page);
  await openFile(page, file);
  await expect(page.getByText('300 × 8 × 4 mm')).toBeVisible();
  await sliceButton(page).click();
  await page.getByRole('button', { name: 'Turn it by 45° and slice' }).click();
  await expect(layerSlider(page)).toHaveAttribute('max', /^(19|20)$/);
});

test('another unit is offered, not taken', async ({ page }, info) => {
  const file = info.outputPath('inches.stl');
  await writeFile(file, binaryStl(box(2, 1, 0.5)));
  await ready(page);
  await openFile(page, file);
  await expect(page.getByText('2 × 1 × 0.5 mm')).toBeVisible();
  await page.getByRole('button', { name: 'Make it 25.4 times as large' }).click();
  await expect(page.getByText('50.8 × 25.4 × 12.7 mm')).toBeVisible();
});

test('an error about a setting leads to its field', async ({ page }) => {
  await opened(page);
  const refuse = async (settings: object, message: string): Promise<void> => {
    await openFile(page, { name: 'my.json', bytes: JSON.stringify(settings) }, 'Import');
    await expect(page.getByRole('alert')).toContainText(message);
    await page.getByRole('button', { name: 'Show the setting' }).click();
  };
  await refuse({ walls: { width: 9 } }, 'walls.width: 9 is outside 0.1 to 2 mm');
  const width = page.getByRole('textbox', { name: 'Wall line width' });
  await expect(width).toBeFocused();
  await expect(width).toBeInViewport();
  await expect(page.getByRole('button', { name: 'Usual' })).toHaveAttribute('aria-pressed', 'true');
  await expect(page.locator('.field.pointed')).toContainText('Wall line width');
  await width.fill('0.5');
  await width.press('Tab');
  await expect(page.locator('.field.pointed')).toHaveCount(0);
  // One that stands in a folded group.
  await refuse({ cooling: { min_speed: 0 } }, 'cooling.min_speed: 0 is outside');
  await expect(page.getByRole('textbox', { name: 'Lowest speed' })).toBeFocused();
  await expect(page.getByRole('button', { name: 'All', exact: true })).toHaveAttribute('aria-pressed', 'true');
});
