// Several parts: added, changed, undone, kept; the settings' depths, search and files.
import { readFileSync } from 'node:fs';
import path from 'node:path';
import type { Page } from '@playwright/test';
import { foothold } from '../node/command.ts';
import { ball, binaryStl, box } from '../node/shapes.ts';
import { download, downloadButton, expect, fileIn, opened, openFile, sliceButton, stepTab, test } from './page.ts';

const part = (page: Page, name: string) =>
  page.getByRole('list', { name: 'Parts on the bed' }).getByRole('button', { name: new RegExp(`^${name}`) });

/** Types into a field of the chosen part. */
async function type(page: Page, label: string, value: string): Promise<void> {
  const field = page.getByLabel(label, { exact: true });
  await field.fill(value);
  await field.press('Enter');
}

const cube = { name: 'cube.stl', bytes: binaryStl(box(20, 10, 6)) };
const round = { name: 'round.stl', bytes: binaryStl(ball(8, 16)) };

/** Both, as files for the command line. */
const onDisk = (folder: string): string[] => [cube, round].map((it) => fileIn(folder, it.name, it.bytes));

test("two models are arranged, and their bytes are the command line's", async ({ page }, { outputDir }) => {
  await opened(page);
  await openFile(page, cube);
  await expect(part(page, 'cube.stl')).toBeVisible();
  await openFile(page, round, 'Add model');
  await expect(part(page, 'round.stl')).toBeVisible();
  await sliceButton(page).click();
  await expect(downloadButton(page)).toBeEnabled();
  const bytes = readFileSync((await download(page)).file);
  expect(await foothold(['slice', ...onDisk(outputDir), '-o', 'both.gcode'], outputDir)).toMatchObject({ code: 0 });
  expect(readFileSync(path.join(outputDir, 'both.gcode')).equals(bytes)).toBe(true);
});

test('a part is turned, scaled, mirrored, moved, duplicated and removed; all of it can be undone', async ({ page }) => {
  await opened(page);
  await openFile(page, cube);
  await expect(part(page, 'cube.stl')).toContainText('20 × 10 × 6 mm');
  await part(page, 'cube.stl').click();
  await page.getByRole('button', { name: 'Turn about X by 90°' }).click();
  await expect(part(page, 'cube.stl')).toContainText('20 × 6 × 10 mm');
  await type(page, 'Scale, %', '200');
  await expect(part(page, 'cube.stl')).toContainText('40 × 12 × 20 mm');
  await page.getByLabel('Keep proportions').uncheck();
  await type(page, 'Size along Z, mm', '5');
  await expect(part(page, 'cube.stl')).toContainText('40 × 12 × 5 mm');
  await page.getByRole('button', { name: 'Mirror X' }).click();
  await type(page, 'Middle along X, mm', '30');
  await page.getByRole('button', { name: 'Duplicate' }).click();
  await expect(part(page, 'cube.stl')).toHaveCount(2);
  await page.getByRole('button', { name: 'Remove cube.stl 1' }).click();
  await expect(part(page, 'cube.stl')).toHaveCount(1);

  await page.getByRole('button', { name: 'Undo' }).click();
  await expect(part(page, 'cube.stl')).toHaveCount(2);
  for (let step = 0; step < 6; step++) await page.getByRole('button', { name: 'Undo' }).click();
  await expect(part(page, 'cube.stl')).toContainText('20 × 10 × 6 mm');
  await expect(page.getByRole('button', { name: 'Undo' })).toHaveAttribute('aria-disabled', 'true');
  await stepTab(page, 'Prepare').focus();
  await page.keyboard.press('Control+Shift+Z');
  await expect(part(page, 'cube.stl')).toContainText('20 × 6 × 10 mm');
  await page.keyboard.press('Control+Z');
  await expect(part(page, 'cube.stl')).toContainText('20 × 10 × 6 mm');
});

test('a part outside the printer is marked, and slicing says where it stands', async ({ page }) => {
  await opened(page);
  await openFile(page, cube);
  await part(page, 'cube.stl').click();
  await type(page, 'Middle along X, mm', '5');
  await expect(part(page, 'cube.stl')).toContainText('Stands outside the printer');
  await sliceButton(page).click();
  await expect(page.getByRole('region', { name: 'Job' }).getByRole('alert')).toContainText(
    'part 1 reaches from (-5.0, 105.0, 0.0)',
  );
  await page.getByRole('button', { name: 'Arrange' }).click();
  await expect(page.getByLabel('Middle along X, mm')).toHaveValue('110');
  await expect(part(page, 'cube.stl')).not.toContainText('Stands outside the printer');
  await expect(page.getByRole('button', { name: 'Arrange' })).toHaveCount(0);
  await type(page, 'Middle along X, mm', '50');
  await sliceButton(page).click();
  await expect(downloadButton(page)).toBeEnabled();
  const text = readFileSync((await download(page)).file, 'utf8');
  const inWalls = text.slice(text.indexOf(';TYPE:External perimeter'));
  const xs = [...inWalls.matchAll(/^G1 X([\d.]+) Y/gm)].slice(0, 4).map((match) => Number(match[1]));
  for (const x of xs) expect(Math.abs(x - 50)).toBeLessThan(10);
});

test('another printer is one step to undo and to do again', async ({ page }) => {
  await opened(page);
  const [undo, redo] = ['Undo', 'Redo'].map((name) => page.getByRole('button', { name }));
  if (undo === undefined || redo === undefined) throw new Error('no history');
  const printer = page.getByLabel('Printer', { exact: true });
  await part(page, 'sample.stl').click();
  // Its bed has its middle at 0, 0: the part is arranged anew, and again with each step.
  const middle = page.getByLabel('Middle along X, mm');
  await expect(middle).toHaveValue('110');
  await printer.selectOption({ label: 'generic Delta with a round bed' });
  await expect(middle).toHaveValue('0');
  await undo.click();
  await expect(middle).toHaveValue('110');
  await expect(undo).toHaveAttribute('aria-disabled', 'true');
  await redo.click();
  await expect(middle).toHaveValue('0');
  await expect(printer).toHaveValue('delta');
  await expect(redo).toHaveAttribute('aria-disabled', 'true');
});

test('settings and parts are there again at the next visit', async ({ page }) => {
  await opened(page);
  await openFile(page, cube);
  await part(page, 'cube.stl').click();
  await page.getByRole('button', { name: 'Turn about Y by 90°' }).click();
  await expect(part(page, 'cube.stl')).toContainText('6 × 10 × 20 mm');
  await page.getByLabel('Walls', { exact: true }).fill('5');
  await page.getByLabel('Walls', { exact: true }).press('Tab');
  await page.goto('./');
  await expect(part(page, 'cube.stl')).toContainText('6 × 10 × 20 mm');
  await expect(page.getByLabel('Walls', { exact: true })).toHaveValue('5');
});

test('settings: depths, search, export, import, undo', async ({ page }) => {
  await opened(page);
  await expect(page.getByLabel('Travel', { exact: true })).toHaveCount(0);
  await page.getByRole('button', { name: 'Usual' }).click();
  await expect(page.getByLabel('Travel', { exact: true })).toBeVisible();
  await page.getByLabel('Search settings').fill('junction deviation');
  await page.getByLabel('Junction deviation', { exact: true }).fill('0.05');
  await page.getByLabel('Junction deviation', { exact: true }).press('Tab');
  const waiting = page.waitForEvent('download');
  await page.getByRole('button', { name: 'Export' }).click();
  const file = await (await waiting).path();
  expect(JSON.parse(readFileSync(file, 'utf8'))).toEqual({ printer: { junction_deviation: 0.05 } });
  await page.getByRole('button', { name: 'Reset', exact: true }).click();
  await expect(page.getByLabel('Junction deviation', { exact: true })).not.toHaveValue('0.05');

  const importText = (bytes: string): Promise<void> => openFile(page, { name: 'my.json', bytes }, 'Import');
  await importText(readFileSync(file, 'utf8'));
  await expect(page.getByLabel('Junction deviation', { exact: true })).toHaveValue('0.05');
  await importText('{"walls":{"count":-3}}');
  await expect(page.getByRole('alert')).toContainText('walls.count');
  await page.getByRole('button', { name: 'Undo' }).click();
  await expect(page.getByLabel('Junction deviation', { exact: true })).not.toHaveValue('0.05');
});

test('a part has settings of its own: marked, undone, kept, and printed', async ({ page }, { outputDir }) => {
  await opened(page);
  await openFile(page, cube);
  await openFile(page, round, 'Add model');
  await expect(part(page, 'round.stl')).toBeVisible();
  await page.getByRole('button', { name: 'Settings for this part' }).click();
  const own = page.getByRole('region', { name: 'Settings for round.stl' });
  await expect(own.getByLabel('Layer height', { exact: true })).toHaveCount(0);
  await own.getByLabel('Infill density').fill('1');
  await own.getByLabel('Infill density').press('Enter');
  await expect(part(page, 'round.stl')).toContainText('Own settings');
  await expect(own).toContainText('1 changed');
  await page.getByRole('button', { name: 'Undo' }).click();
  await expect(part(page, 'round.stl')).not.toContainText('Own settings');
  await page.getByRole('button', { name: 'Redo' }).click();
  await expect(part(page, 'round.stl')).toContainText('Own settings');
  const exported = page.waitForEvent('download');
  await page.getByRole('button', { name: 'Export' }).click();
  const settings = readFileSync(await (await exported).path(), 'utf8');
  expect(JSON.parse(settings)).toEqual({ models: { round: { infill: { density: 1 } } } });
  await page.getByRole('button', { name: 'Undo' }).click();
  await expect(part(page, 'round.stl')).not.toContainText('Own settings');
  await openFile(page, { name: 'my.json', bytes: settings }, 'Import');
  await expect(part(page, 'round.stl')).toContainText('Own settings');
  const saved = page.waitForEvent('download');
  await page.getByRole('button', { name: 'Save as STL' }).click();
  const stl = await saved;
  expect(stl.suggestedFilename()).toBe('cube_placed.stl');
  const bytes = readFileSync(await stl.path());
  // A header of 84 bytes, and 50 for each triangle of both parts.
  const triangles = (it: Uint8Array): number => (it.length - 84) / 50;
  expect(triangles(bytes)).toBe(triangles(cube.bytes) + triangles(round.bytes));
  expect(bytes.readUInt32LE(80)).toBe(triangles(bytes));
  await page.goto('./');
  await expect(part(page, 'round.stl')).toContainText('Own settings');
  await sliceButton(page).click();
  await expect(downloadButton(page)).toBeEnabled();
  const text = readFileSync((await download(page)).file, 'utf8');
  expect(text).toContain('; models.round.infill.density = 1');
  expect(
    await foothold(
      ['slice', ...onDisk(outputDir), '-o', 'own.gcode', '--set-for', 'round:infill.density=1'],
      outputDir,
    ),
  ).toMatchObject({ code: 0 });
  expect(readFileSync(path.join(outputDir, 'own.gcode'), 'utf8')).toBe(text);
});

test('parts printed one after another: apart on the bed, one done before the next begins', async ({ page }) => {
  await opened(page);
  await openFile(page, cube);
  await openFile(page, round, 'Add model');
  await expect(part(page, 'round.stl')).toBeVisible();
  await page.getByRole('searchbox', { name: 'Search settings' }).last().fill('print sequence');
  await page.getByLabel('Print sequence').selectOption('by_object');
  await part(page, 'cube.stl').click();
  // Moved from the middle by the head's clearance.
  await expect.poll(async () => Number(await page.getByLabel('Middle along X, mm').inputValue())).toBeLessThan(85);
  await sliceButton(page).click();
  await expect(downloadButton(page)).toBeEnabled();
  const text = readFileSync((await download(page)).file, 'utf8');
  const heights = [...text.matchAll(/^;LAYER_CHANGE\n;Z:(.*)/gm)].map((it) => Number(it[1]));
  expect(heights.filter((z) => z === 0.2)).toHaveLength(2);
  expect(heights.filter((z, k) => z < (heights[k - 1] ?? 0))).toEqual([0.2]);
  await page.getByRole('tab', { name: 'Preview', exact: true }).click();
  await expect(page.getByRole('slider', { name: 'Layer' })).toHaveAttribute('max', String(heights.length));
});
