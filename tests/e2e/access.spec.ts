// For everyone: no findings of axe in any state, and the whole way by keyboard alone.
import { binaryStl, box } from '../node/shapes.ts';
import {
  choose,
  downloadButton,
  expect,
  layerSlider,
  noFindings,
  openFile,
  picture,
  ready,
  settled,
  sliceButton,
  stepTab,
  test,
  UNSLICED,
} from './page.ts';

test('axe finds nothing', async ({ page }) => {
  await ready(page);
  await noFindings(page, 'prepare');
  await stepTab(page, 'Preview').click();
  await expect(layerSlider(page)).toBeVisible();
  await noFindings(page, 'preview');
  await stepTab(page, 'Prepare').click();
  await page.getByRole('button', { name: 'All', exact: true }).click();
  for (const group of await page.locator('details.group > summary').all()) await group.click();
  await noFindings(page, 'all settings');
  await page.getByRole('button', { name: 'Basic', exact: true }).click();
  await page.getByLabel('Walls', { exact: true }).first().fill('4');
  await page.getByLabel('Layer height').first().fill('90');
  await page.getByLabel('Layer height').first().press('Tab');
  await page.getByRole('button', { name: /^sample.stl/ }).click();
  await noFindings(page, 'a fault, a stale result, a part is chosen');
  await openFile(page, { name: 'cut.stl', bytes: binaryStl(box(20, 20, 20), 120) });
  await expect(page.getByRole('alert')).toBeVisible();
  await noFindings(page, 'a broken file');
});

test('the whole way by keyboard', async ({ page }) => {
  await ready(page);
  const reach = async (name: RegExp): Promise<void> => {
    for (let presses = 0; presses < 90; presses++) {
      await page.keyboard.press('Tab');
      const label = await page.evaluate(() => {
        const at = document.activeElement;
        const labelled = at instanceof HTMLInputElement ? at.labels?.[0]?.textContent : undefined;
        return at?.getAttribute('aria-label') ?? labelled ?? at?.textContent ?? '';
      });
      if (name.test(label.trim())) return;
    }
    throw new Error(`Tab does not reach ${name}`);
  };

  await reach(/^Open model$/);
  await choose(page, () => page.keyboard.press('Enter'), { name: 'bar.stl', bytes: binaryStl(box(30, 10, 20)) });
  await expect(page.getByText('30 × 10 × 20 mm')).toBeVisible();

  await reach(/^bar.stl/);
  await page.keyboard.press('Space');
  await reach(/^Lay a face flat$/);
  await page.keyboard.press('Space');
  await expect(page.getByRole('button', { name: 'Lay it as in picture 1' })).toBeVisible();
  await reach(/^Lay it as in picture 3$/);
  await page.keyboard.press('Enter');
  await expect(page.getByText('20 × 10 × 30 mm')).toBeVisible();

  await reach(/^Walls$/);
  await page.keyboard.press('Control+A');
  await page.keyboard.type('2');
  await reach(/^Slice$/);
  await page.keyboard.press('Enter');
  await expect(downloadButton(page)).toBeEnabled();
  await expect(page.getByRole('status')).toContainText('Sliced: 150 layers');
  await expect(sliceButton(page)).toBeFocused();

  const waiting = page.waitForEvent('download');
  await reach(/^Download G-code$/);
  await page.keyboard.press('Enter');
  expect((await waiting).suggestedFilename()).toMatch(/^bar_/);

  await reach(/^Picture/);
  const before = await settled(page);
  await page.keyboard.press('+');
  await page.keyboard.press('ArrowLeft');
  expect((await settled(page)).equals(before)).toBe(false);
  const layer = Number(await layerSlider(page).inputValue());
  await page.keyboard.press('PageUp');
  await expect(layerSlider(page)).toHaveValue(String(layer + 1));
  await expect(picture(page)).toBeFocused();
  await reach(/^Layer$/);
  await page.keyboard.press('Home');
  await expect(layerSlider(page)).toHaveValue('1');

  await reach(/^Preview$/);
  await page.keyboard.press('ArrowLeft');
  await expect(stepTab(page, 'Prepare')).toBeFocused();
  await expect(page.getByRole('tabpanel', { name: 'Prepare' })).toBeVisible();
});

test('language and colours are chosen, and kept', async ({ page }) => {
  await ready(page);
  await page.getByLabel('Language').selectOption('de');
  await expect(page.getByRole('button', { name: 'G-Code herunterladen' })).toBeVisible();
  await expect(page.locator('html')).toHaveAttribute('lang', 'de');
  await page.getByRole('switch', { name: 'Dunkle Farben' }).click();
  const ground = () => page.evaluate(() => getComputedStyle(document.documentElement).backgroundColor);
  expect(await ground()).toBe('rgb(22, 25, 23)');
  await page.reload();
  await expect(page.getByRole('button', { name: 'G-Code herunterladen' })).toBeEnabled();
  expect(await ground()).toBe('rgb(22, 25, 23)');
  await page.getByLabel('Sprache').selectOption('zh');
  await expect(page.getByRole('tab', { name: '准备' })).toBeVisible();
});

test('the whole way on a phone, and nothing is wider than the screen', async ({ browser, baseURL }) => {
  const context = await browser.newContext({ viewport: { width: 360, height: 740 }, isMobile: true, hasTouch: true });
  const page = await context.newPage();
  const fits = async (state: string): Promise<void> => {
    expect(await page.evaluate(() => document.documentElement.scrollWidth), state).toBeLessThanOrEqual(360);
    await noFindings(page, state);
  };
  await page.goto(`${baseURL}${UNSLICED}`);
  const opener = page.getByRole('button', { name: 'Open model' });
  await choose(page, () => opener.tap(), { name: 'bar.stl', bytes: binaryStl(box(30, 10, 4)) });
  await page.getByRole('button', { name: /^bar.stl/ }).tap();
  await page.getByRole('button', { name: 'Turn about Z by 90°' }).tap();
  await expect(page.getByRole('button', { name: /^bar.stl/ })).toContainText('10 × 30 × 4 mm');
  await page.getByRole('button', { name: 'Lay a face flat' }).tap();
  await expect(page.getByRole('button', { name: 'Lay it as in picture 6' })).toBeAttached();
  await page.getByLabel('Walls', { exact: true }).fill('2');
  await fits('phone, prepare');
  await sliceButton(page).tap();
  await expect(downloadButton(page)).toBeEnabled();
  await expect(stepTab(page, 'Preview')).toHaveAttribute('aria-selected', 'true');
  await layerSlider(page).fill('7');
  await expect(layerSlider(page)).toHaveAttribute('aria-valuetext', 'Layer 7 of 20, 1.4 mm');
  await fits('phone, preview');
  await stepTab(page, 'Learn').tap();
  await expect(page.locator('.lesson-text')).toBeVisible();
  await page.getByRole('button', { name: 'Next', exact: true }).tap();
  await expect(page.locator('.lesson-text[data-step="offset"]')).toBeVisible();
  await fits('phone, learn');
  await stepTab(page, 'Print').tap();
  const waiting = page.waitForEvent('download');
  await downloadButton(page).tap();
  expect((await waiting).suggestedFilename()).toMatch(/^bar_/);
  await fits('phone, print');
  await context.close();
});
