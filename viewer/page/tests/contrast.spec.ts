// SPDX-License-Identifier: BSD-3-Clause
// Text can be read in every state of every control, by day and by night: WCAG 2.2, 1.4.3 (4.5, large text 3)
// and 1.4.11 (3 for the mark of the focus).
import type { CDPSession, Page } from "@playwright/test";
import { expect, test } from "./fixtures";

const PAGES = [
  "#chart?t=60&vehicle=scout-1",
  "#section?t=30&link=quay~gate",
  "#matrix?t=30&link=quay~gate",
  "#time-line?t=33&packet=quay:1",
  "#vehicle?t=60&vehicle=scout-1",
];
const CONTROLS = "button, select, input, summary, a, [tabindex], tr";
// What a pointer or the keyboard does to a control; the last one is what a click leaves behind.
const STATES = [[], ["hover"], ["focus", "focus-visible"], ["hover", "active"], ["hover", "focus", "focus-visible"]];

/** What is too faint on the page as it is: text, or the outline of a control that has the focus. */
function faint(): string[] {
  const context = Object.assign(document.createElement("canvas"), { width: 1, height: 1 }).getContext("2d", {
    willReadFrequently: true,
  })!;
  type Colour = [number, number, number, number];
  const colourOf = (text: string): Colour => {
    context.clearRect(0, 0, 1, 1);
    context.fillStyle = text;
    context.fillRect(0, 0, 1, 1);
    const [r, g, b, a] = context.getImageData(0, 0, 1, 1).data;
    return [r!, g!, b!, a! / 255];
  };
  const over = (top: Colour, alpha: number, below: Colour): Colour => [
    top[0] * alpha + below[0] * (1 - alpha),
    top[1] * alpha + below[1] * (1 - alpha),
    top[2] * alpha + below[2] * (1 - alpha),
    1,
  ];
  const background = (element: Element | null): Colour => {
    if (!element) return [255, 255, 255, 1];
    const own = colourOf(getComputedStyle(element).backgroundColor);
    return own[3] === 1 ? own : over(own, own[3], background(element.parentElement));
  };
  const opacity = (element: Element | null): number =>
    element ? Number(getComputedStyle(element).opacity) * opacity(element.parentElement) : 1;
  const luminance = (colour: Colour) => {
    const [r, g, b] = colour.slice(0, 3).map((c) => (c / 255 <= 0.04045 ? c / 255 / 12.92 : ((c / 255 + 0.055) / 1.055) ** 2.4));
    return 0.2126 * r! + 0.7152 * g! + 0.0722 * b!;
  };
  const contrast = (one: Colour, other: Colour) => {
    const [low, high] = [luminance(one), luminance(other)].sort((a, b) => a - b);
    return (high! + 0.05) / (low! + 0.05);
  };
  const found: string[] = [];
  for (const element of document.querySelectorAll("body *")) {
    const style = getComputedStyle(element);
    if (style.visibility !== "visible" || !element.getClientRects().length || element.closest(".visually-hidden")) continue;
    const hasText =
      element.matches("input, select") || [...element.childNodes].some((node) => node.nodeType === 3 && node.textContent!.trim());
    const behind = background(element);
    const name = `${element.tagName} "${element.textContent!.trim().slice(0, 30)}"`;
    if (hasText) {
      const ink = colourOf(element instanceof SVGElement ? style.fill : style.color);
      const size = parseFloat(style.fontSize);
      const wanted = size >= 24 || (size >= 18.66 && Number(style.fontWeight) >= 700) ? 3 : 4.5;
      const ratio = contrast(over(ink, ink[3] * opacity(element), behind), behind);
      if (ratio < wanted) found.push(`${name}: ${ratio.toFixed(2)} of ${wanted}`);
    }
    if (style.outlineStyle !== "none" && parseFloat(style.outlineWidth) > 0) {
      const around = background(element.parentElement);
      const ratio = contrast(colourOf(style.outlineColor), around);
      if (ratio < 3) found.push(`outline of ${name}: ${ratio.toFixed(2)} of 3`);
    }
  }
  return [...new Set(found)];
}

async function force(cdp: CDPSession, states: string[]) {
  const { root } = await cdp.send("DOM.getDocument");
  const { nodeIds } = await cdp.send("DOM.querySelectorAll", { nodeId: root.nodeId, selector: CONTROLS });
  for (const nodeId of nodeIds) await cdp.send("CSS.forcePseudoState", { nodeId, forcedPseudoClasses: states });
  return nodeIds.length;
}

async function openIn(page: Page, theme: string, hash: string) {
  await page.goto(`/${hash}`);
  await expect(page.locator(".source")).toContainText("harbour");
  await expect(page.getByLabel("Selection").locator("section").first()).toBeVisible();
  await page.evaluate((name) => (document.documentElement.dataset.theme = name), theme);
}

for (const theme of ["light", "dark"]) {
  test(`text can be read in every state of every control, ${theme}`, async ({ page }) => {
    test.setTimeout(240_000);
    for (const hash of PAGES) {
      await openIn(page, theme, hash);
      const cdp = await page.context().newCDPSession(page);
      await cdp.send("DOM.enable");
      await cdp.send("CSS.enable");
      for (const states of STATES) {
        expect(await force(cdp, states)).toBeGreaterThan(10);
        expect(await page.evaluate(faint), `${theme} ${hash} ${states.join(" ")}`).toEqual([]);
      }
      await cdp.detach();
    }
  });
}

// The page's own chosen tab, under the pointer that has just chosen it.
test("a tab that was clicked can be read", async ({ page }) => {
  await openIn(page, "light", "#chart?t=60");
  for (const view of ["Section", "Matrix", "Time line", "Vehicle", "Chart"]) {
    await page.getByRole("button", { name: view, exact: true }).click();
    expect(await page.evaluate(faint), view).toEqual([]);
  }
});
