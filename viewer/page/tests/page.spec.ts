// SPDX-License-Identifier: BSD-3-Clause
// The page as a visitor uses it, on a log of scenarios/harbour.toml.
import type { Page } from "@playwright/test";
import { Programs, chart, expect, log, seconds, test, vehicle, vehicles } from "./fixtures";

/** Opens the page at a hash and waits until its chart, or another view, shows vehicles. */
async function open(page: Page, hash = "") {
  await page.goto(`/${hash}`);
  await expect(page.locator(".source")).toContainText("harbour");
  await expect(page.getByLabel("Selection").locator("section").first()).toBeVisible();
}
const vehicleHeading = (page: Page) => page.getByLabel("Selection").getByRole("heading", { name: "scout-1" });
const now = (page: Page) => page.getByTestId("now").textContent();

test("shows every vehicle, moving while it plays", async ({ page }) => {
  await open(page);
  await expect(vehicles(page)).toHaveCount(5);
  await expect(chart(page)).toHaveAttribute("data-vehicles", "5");
  const scout = vehicle(page, "scout-1");
  const before = await scout.textContent();
  await page.getByLabel("Speed").selectOption("10");
  await page.getByRole("button", { name: "Play" }).click();
  await expect.poll(() => seconds(page)).toBeGreaterThan(5);
  await page.getByRole("button", { name: "Pause" }).click();
  expect(await scout.textContent()).not.toBe(before);
});

test("draws a packet's wavefront as it grows, then the marks of its outcomes", async ({ page }) => {
  await open(page, "#chart?t=0");
  await page.keyboard.press("]");
  // Half a second after its departure, at 1500 m/s and a little more.
  await expect(chart(page)).toHaveAttribute("data-fronts", /^7[5-9]\d$/);
  await page.getByLabel("Speed").selectOption("0.1");
  await page.getByRole("button", { name: "Play" }).click();
  await expect.poll(async () => Number(await chart(page).getAttribute("data-fronts"))).toBeGreaterThan(800);
  await page.getByRole("button", { name: "Pause" }).click();
  await expect(page.getByRole("heading", { name: "→" }).first()).toBeVisible();
  await page.keyboard.press("ArrowRight");
  await expect(chart(page)).not.toHaveAttribute("data-marks", "0");
});

test("opens the ladder and one sentence for a packet", async ({ page }) => {
  await open(page, "#time-line?t=20");
  await expect(page.getByTestId("time-line")).not.toHaveAttribute("data-packets", "0");
  await page.keyboard.press("]");
  await expect(page.getByTestId("sentence")).toContainText(/^(Received|Lost) at /);
  const ladder = page.getByTestId("ladder").locator("tbody tr");
  expect(await ladder.count()).toBeGreaterThan(5);
  for (const row of await ladder.all()) await expect(row).toHaveAttribute("title", /\w\.$/);
});

test("shows the rays and the budget of a link", async ({ page }) => {
  await open(page, "#section?t=30&link=quay~gate");
  await expect(page.getByTestId("section").locator("path.ray").first()).toBeAttached({ timeout: 30_000 });
  await expect(page.getByTestId("budget")).toContainText("SINR");
  await page.getByLabel("Receiver").selectOption({ label: "scout-1" });
  await expect(page).toHaveURL(/link=quay%7Escout-1|link=quay~scout-1/);
});

test("shows the matrix, the history of a cell and its rays", async ({ page }) => {
  await open(page, "#matrix?t=60");
  const matrix = page.getByTestId("matrix");
  await expect(page.getByRole("heading", { name: "All pairs" })).toBeVisible();
  // At half delivery of the coded tones of 2000 bit/s in 16 kHz: tests/viewer/sources_test.cc.
  await expect(page.locator(".pane .legend").first()).toContainText(/threshold −\d\.\d dB/);
  await expect(page.getByLabel("Link", { exact: true })).toContainText("SNR");
  await expect(page.locator("table tbody tr").filter({ hasText: "quay" }).first()).toBeVisible();
  await matrix.focus();
  await page.keyboard.press("ArrowRight");
  await expect(page.getByRole("img", { name: /from 0:00 to/ })).toBeVisible();
  await page.getByRole("button", { name: "Show its rays" }).click();
  await expect(page.getByTestId("section").locator("path.ray").first()).toBeAttached({ timeout: 30_000 });
});

test("shows the course of a vehicle and the health of the nodes", async ({ page }) => {
  await open(page, "#vehicle?t=60&vehicle=scout-1");
  await expect(page.getByTestId("panels").locator("figure").first()).toContainText("Depth");
  await expect(page.getByRole("heading", { name: "Health of the nodes" })).toBeVisible();
});

test("seeks by slider, keys and address", async ({ page }) => {
  await open(page, "#chart?t=42");
  await expect.poll(() => now(page)).toBe("0:42.0");
  await page.keyboard.press("Shift+ArrowRight");
  await expect.poll(() => now(page)).toBe("0:52.0");
  await page.getByLabel("Simulation time").fill("30");
  await expect.poll(() => seconds(page)).toBeCloseTo(30, 0);
  await expect(page).toHaveURL(/t=(30|29\.9|30\.1)/);
});

test("keeps time, view and selection in the address", async ({ page }) => {
  await open(page, "#matrix?t=33&vehicle=scout-2&column=sinr_db");
  await expect(page.getByLabel("Selection")).toContainText("scout-2");
  await page.keyboard.press("4");
  await expect(page).toHaveURL(/#time-line\?t=33&vehicle=scout-2&column=sinr_db/);
});

test("finds a vehicle, lists its keys, changes its colours", async ({ page }) => {
  await open(page);
  await page.keyboard.press("/");
  await page.keyboard.type("gate");
  await page.keyboard.press("Enter");
  await expect(page.getByRole("heading", { name: "gate" })).toBeVisible();
  await page.keyboard.press("?");
  await expect(page.getByRole("dialog")).toContainText("next packet");
  await page.keyboard.press("Escape");
  await page.getByRole("button", { name: /^Colours/ }).click();
  await page.getByRole("button", { name: /^Colours/ }).click();
  await expect(page.locator("html")).toHaveAttribute("data-theme", "dark");
});

test("fits a phone", async ({ page }) => {
  await page.setViewportSize({ width: 390, height: 800 });
  await open(page);
  expect(await page.evaluate(() => document.documentElement.scrollWidth)).toBeLessThanOrEqual(390);
  for (const view of ["Section", "Matrix", "Time line", "Vehicle", "Chart"]) {
    await page.getByRole("button", { name: view, exact: true }).click();
    expect(await page.evaluate(() => document.documentElement.scrollWidth)).toBeLessThanOrEqual(390);
  }
});

test.describe("beside a monitor that ends", () => {
  const programs = new Programs();
  test.use({ expectedErrors: [/WebSocket connection/] });
  test.afterAll(() => programs.stop());

  test("says so, and comes back with it", async ({ page }) => {
    const url = new URL(await programs.monitor(log()));
    await page.goto(`${url.href}#chart?t=30&vehicle=scout-1`);
    await expect(vehicleHeading(page)).toBeVisible();
    await expect.poll(() => now(page)).toBe("0:30.0");
    await programs.stop();
    await expect(page.getByTestId("condition")).toContainText("The monitor is gone");
    await expect(vehicleHeading(page)).toBeVisible();
    await programs.monitor("--port", url.port, log());
    await expect(page.getByTestId("condition")).toBeHidden();
    await expect.poll(() => now(page)).toBe("0:30.0"); // where it was
    await page.keyboard.press("Shift+ArrowRight");
    await expect.poll(() => now(page)).toBe("0:40.0");
  });
});
