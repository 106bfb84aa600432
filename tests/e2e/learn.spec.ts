// The lessons and the panels with pictures: what they show is what the engine computed.
import type { Page } from '@playwright/test';
import { expect, noFindings, opened, test } from './page.ts';

interface Facts {
  readonly [name: string]: number;
}

/** Opens a step of a lesson by its link, and waits until its picture stands. */
async function step(page: Page, link: string, id: string): Promise<Facts> {
  await page.goto(`./?learn=${link}`);
  const text = page.locator(`.lesson-text[data-step="${id}"]`);
  await expect(text).toBeVisible();
  return JSON.parse((await text.getAttribute('data-facts')) ?? '{}') as Facts;
}

const drawn = (page: Page, ink: string) => page.locator(`.lesson-pictures .${ink}`);

test('teeth: the tips that the picture shows are those that the engine counts', async ({ page }) => {
  const facts = await step(page, 'teeth/5', 'tips');
  expect(facts['teeth']).toBeGreaterThan(20);
  await expect(drawn(page, 'tip')).toHaveCount(facts['biting'] ?? -1);
  await expect(drawn(page, 'tip-outside')).toHaveCount(facts['outside'] ?? -1);
  await page.getByRole('button', { name: 'Next', exact: true }).click();
  await expect(page.locator('.lesson-text[data-step="path"]')).toBeVisible();
  await page.getByRole('button', { name: 'Next', exact: true }).click();
  await expect(page.locator('.lesson-pictures figure')).toHaveCount(2);
  await expect(page.getByRole('button', { name: 'Next', exact: true })).toBeDisabled();
});

test('plates: points, region and sheets', async ({ page }) => {
  const points = await step(page, 'plates/3&at=y%3D110', 'points');
  await expect(drawn(page, 's-point-a')).toHaveCount(points['type_a'] ?? -1);
  await expect(drawn(page, 's-point-b')).toHaveCount(points['type_b'] ?? -1);
  await expect(drawn(page, 'g-point')).toHaveCount(points['g'] ?? -1);
  await expect(drawn(page, 'io-point')).toHaveCount(points['io'] ?? -1);
  const crossing = await step(page, 'plates/5', 'crossing');
  await expect(drawn(page, 'sheet')).toHaveCount(crossing['plates'] ?? -1);
});

test('features and orientation: colours and cells', async ({ page }) => {
  const structures = await step(page, 'features/5', 'structures');
  expect(structures['total']).toBeCloseTo((structures['support'] ?? 0) + (structures['base'] ?? 0), 6);
  const fills = await drawn(page, 'structure').evaluateAll(
    (all) => new Set(all.map((it) => it.getAttribute('fill'))).size,
  );
  expect(fills).toBe(Math.min(6, (structures['structures'] ?? 0) + (structures['specks'] ?? 0) - 1));
  const volumes = await step(page, 'orientation/1', 'volumes');
  expect(volumes['smallest']).toBeLessThanOrEqual(volumes['largest'] ?? 0);
  await step(page, 'orientation/2', 'matrix');
  await expect(drawn(page, 'share')).toHaveCount(36);
});

test('a number changed in place changes the picture and the link', async ({ page }) => {
  const before = await step(page, 'teeth/4', 'divide');
  const pitch = page.getByRole('slider', { name: 'Tooth pitch' });
  await pitch.focus();
  for (let presses = 0; presses < 20; presses++) await page.keyboard.press('ArrowRight');
  await expect(async () => {
    const facts = JSON.parse((await page.locator('.lesson-text').getAttribute('data-facts')) ?? '{}') as Facts;
    expect(facts['pitch']).toBeCloseTo(7, 6);
    expect(facts['teeth']).toBeLessThan(before['teeth'] ?? 0);
  }).toPass();
  expect(new URL(page.url()).searchParams.getAll('set')).toEqual(['adhesion.teeth.pitch=7']);
  const text = await page.locator('.lesson-text').textContent();
  await page.reload();
  await expect(page.locator('.lesson-text')).toHaveText(text ?? '');
});

test('settings that contradict each other are said, not drawn', async ({ page }) => {
  await page.goto('./?learn=teeth/1&set=adhesion.teeth.base%3D9');
  await expect(page.getByRole('alert')).toContainText('adhesion.teeth.base');
});

test('every kind of base layer is drawn, and one is chosen', async ({ page }) => {
  await opened(page);
  const kinds = page.getByRole('radiogroup', { name: 'How shall it stick?' });
  await expect(kinds.getByRole('radio')).toHaveCount(5);
  await expect(kinds.locator('svg')).toHaveCount(5);
  await expect(kinds.locator('.kind.chosen')).toContainText('Teeth');
  const placed = await kinds.locator('.kind.chosen .tip').count();
  await expect(page.locator('base-layer-panel')).toContainText(`${placed} teeth`);
  await kinds.getByRole('radio', { name: /Brim/ }).press('Space');
  await expect(kinds.locator('.kind.chosen')).toContainText('Brim');
  await expect(page.getByLabel('Bed adhesion').first()).toHaveValue('brim');
});

test('directions are compared, and their pictures shown', async ({ page }) => {
  await opened(page);
  await page.getByText('Which way up?').click();
  await page.getByRole('button', { name: 'Compare directions' }).click();
  const strip = page.getByRole('radiogroup', { name: 'Which way up?' });
  await expect(strip.getByRole('radio').first()).toBeAttached({ timeout: 60_000 });
  expect(await strip.getByRole('radio').count()).toBeGreaterThanOrEqual(6);
  await expect(page.locator('.chart .mark')).toHaveCount(await strip.getByRole('radio').count());
  await expect(strip.getByText('least support')).toHaveCount(1);
});

test('axe finds nothing in the lessons', async ({ page }) => {
  for (const [link, id] of [
    ['teeth/7', 'compare'],
    ['plates/4', 'region'],
    ['features/5', 'structures'],
    ['orientation/3', 'network'],
  ] as const) {
    await page.emulateMedia({ colorScheme: 'light' });
    await step(page, link, id);
    await noFindings(page, link);
  }
});
