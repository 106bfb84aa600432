// The lessons and the panels with pictures: what they show is what the engine computed.
import type { Page } from '@playwright/test';
import { expect, noFindings, opened, test } from './page.ts';

interface Facts {
  readonly [name: string]: number;
}

/** Opens a step of a lesson by its link, and waits until its picture stands. */
async function step(page: Page, link: string, id: string): Promise<Facts> {
  await page.goto(`./?learn=${link}`);
  return await factsOf(page, id);
}

/** The facts of the step that is shown now, which is `id`. */
async function factsOf(page: Page, id: string): Promise<Facts> {
  const text = page.locator(`.lesson-text[data-step="${id}"]`);
  await expect(text).toBeVisible();
  return JSON.parse((await text.getAttribute('data-facts')) ?? '{}') as Facts;
}

const drawn = (page: Page, ink: string) => page.locator(`.lesson-pictures .${ink}`);

/** What is measured in a picture, which is drawn in mm: a count, a length or an area of all that has this ink. */
type Measure = readonly [how: 'count' | 'length' | 'area', ink: string, fact: (n: (name: string) => number) => number];

/** For each step of each lesson, in order, what its picture shows of its facts. */
const lessons: Readonly<Record<string, readonly (readonly [id: string, ...measures: Measure[]])[]>> = {
  teeth: [
    ['outline', ['count', 'vertex', (n) => n('vertices')], ['count', 'outline', (n) => n('contours')]],
    ['offset', ['count', 'vertex', (n) => n('vertices')], ['count', 'rail', (n) => n('rails')]],
    ['simplify', ['count', 'vertex', (n) => n('after')]],
    ['divide', ['count', 's-point-a', (n) => n('teeth')], ['count', 's-point-b', (n) => n('teeth')]],
    ['tips', ['count', 'tip', (n) => n('biting')], ['count', 'tip-outside', (n) => n('outside')]],
    ['path', ['length', 'teeth', (n) => n('length')]],
    [
      'compare',
      ['count', 'tip', (n) => n('paper_biting') + n('ours_biting')],
      ['count', 'tip-outside', (n) => n('paper') - n('paper_biting')],
    ],
  ],
  plates: [
    ['plane', ['count', 'guide', (n) => n('planes')], ['count', 'plane', () => 1]],
    [
      'contour',
      ['count', 'outline', (n) => n('contours')],
      ['area', 'part', (n) => n('area')],
      ['length', 'hanging', (n) => n('hanging')],
    ],
    [
      'points',
      ['count', 's-point-a', (n) => n('type_a')],
      ['count', 's-point-b', (n) => n('type_b')],
      ['count', 'g-point', (n) => n('g')],
      ['count', 'io-point', (n) => n('io')],
    ],
    ['region', ['area', 'held', (n) => n('area')], ['area', 'held-at-zero', (n) => n('at_zero')]],
    ['crossing', ['count', 'sheet', (n) => n('plates')]],
  ],
  features: [
    ['layers', ['area', 'part', (n) => n('below')], ['area', 'above', (n) => n('above')]],
    ['grown', ['area', 'grown', (n) => n('grown')]],
    ['overhang', ['area', 'hanging', (n) => n('area')]],
    ['regions'],
    ['structures'],
  ],
};

/** All that has an ink, counted or measured: closed loops turn so that holes take away. */
function measured(page: Page, how: Measure[0], ink: string): Promise<number> {
  return drawn(page, ink).evaluateAll((all, how) => {
    if (how === 'count') return all.length;
    const loops = all.flatMap((it) =>
      (it.getAttribute('d') ?? '')
        .split('M')
        .slice(1)
        .map((loop) => ({
          closed: loop.includes('Z'),
          points: [...loop.matchAll(/(-?[\d.]+) (-?[\d.]+)/g)].map(([, x, y]) => [Number(x), Number(y)] as const),
        })),
    );
    const sides = loops.flatMap(({ closed, points }) =>
      points.flatMap(([x, y], k) => {
        const next = points[k + 1] ?? (closed ? points[0] : undefined);
        return next === undefined ? [] : [[x, y, ...next] as const];
      }),
    );
    const length = sides.reduce((sum, [x, y, u, v]) => sum + Math.hypot(u - x, v - y), 0);
    const area = Math.abs(sides.reduce((sum, [x, y, u, v]) => sum + x * v - u * y, 0)) / 2;
    return how === 'length' ? length : area;
  }, how);
}

for (const [lesson, steps] of Object.entries(lessons)) {
  test(`${lesson}: each step's picture shows what the engine computed`, async ({ page }) => {
    await step(page, `${lesson}/1`, steps[0]?.[0] ?? '');
    for (const [k, [id, ...measures]] of steps.entries()) {
      if (k > 0) await page.getByRole('button', { name: 'Next', exact: true }).click();
      const facts = await factsOf(page, id);
      for (const [how, ink, fact] of measures) {
        const expected = fact((name) => facts[name] ?? Number.NaN);
        const within = how === 'count' ? 0 : 1e-3 * expected;
        expect(Math.abs((await measured(page, how, ink)) - expected), `${id}: ${how} of ${ink}`).toBeLessThanOrEqual(
          within,
        );
      }
    }
    await expect(page.getByRole('button', { name: 'Next', exact: true })).toBeDisabled();
  });
}

test('features and orientation: volumes, colours and cells', async ({ page }) => {
  const structures = await step(page, 'features/5', 'structures');
  expect(structures['total']).toBeCloseTo((structures['support'] ?? 0) + (structures['base'] ?? 0), 6);
  const fills = await drawn(page, 'structure').evaluateAll(
    (all) => new Set(all.map((it) => it.getAttribute('fill'))).size,
  );
  expect(fills).toBe(Math.min(6, (structures['structures'] ?? 0) + (structures['specks'] ?? 0) - 1));
  const volumes = await step(page, 'orientation/1', 'volumes');
  // The bar of the direction with the least is drawn as the chosen one.
  await expect(drawn(page, 'share')).toHaveCount(5);
  await expect(drawn(page, 'chosen')).toHaveCount(1);
  expect(volumes['smallest']).toBeLessThanOrEqual(volumes['largest'] ?? 0);
  await page.getByRole('button', { name: 'Next', exact: true }).click();
  await factsOf(page, 'matrix');
  await expect(drawn(page, 'share')).toHaveCount(36);
  await page.getByRole('button', { name: 'Next', exact: true }).click();
  const network = await factsOf(page, 'network');
  await expect(drawn(page, 'vertex')).toHaveCount(6);
  await page.getByRole('button', { name: 'Next', exact: true }).click();
  const choice = await factsOf(page, 'choice');
  expect([choice['chosen'], choice['volume']]).toEqual([network['row'], volumes['smallest']]);
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
