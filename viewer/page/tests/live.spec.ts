// SPDX-License-Identifier: BSD-3-Clause
// The page beside a real run on a bus, whose services end and begin again. scripts/monitor_test gives the tests a network of their own.
import type { ChildProcess } from "node:child_process";
import type { Page } from "@playwright/test";
import { Programs, chart, expect, seconds, test, vehicle, vehicles } from "./fixtures";

const SCENARIO = "../../scenarios/harbour.toml";
const programs = new Programs();
const node = (name: string) => programs.start(`halocline-${name}`, SCENARIO, "--log-level", "warning");
let bathymetry: ChildProcess;
let channel_server: ChildProcess;
let url: string;

test.beforeAll(async () => {
  bathymetry = node("bathymetry");
  channel_server = node("channel-server");
  for (const name of ["vehicle-sim", "autopilot", "traffic", "conductor"]) node(name);
  url = await programs.monitor();
});
test.afterAll(() => programs.stop());

const condition = (page: Page) => page.getByTestId("condition");
const rays = (page: Page) => page.getByTestId("section").locator("path.ray");
const show = (page: Page, view: string) => page.getByRole("button", { name: view, exact: true }).click();

test("shows the vehicles of a run as they move", async ({ page }) => {
  await page.goto(url);
  await expect(vehicles(page)).toHaveCount(5);
  await expect(chart(page)).toHaveAttribute("data-vehicles", "5");
  await expect(condition(page)).toBeHidden();
  await expect(chart(page)).toHaveAttribute("data-seabed", /^[1-9]\d\d/);
  const [before, begin_s] = [await vehicle(page, "scout-1").textContent(), await seconds(page)];
  await expect.poll(() => vehicle(page, "scout-1").textContent()).not.toBe(before);
  await expect.poll(() => seconds(page)).toBeGreaterThan(begin_s + 2);
});

test("draws the wavefronts of a run, the marks of their outcomes and the ladder of a packet", async ({ page }) => {
  await page.goto(url);
  await expect(chart(page)).toHaveAttribute("data-fronts", /[1-9]/, { timeout: 30_000 });
  await expect(chart(page)).toHaveAttribute("data-marks", /[1-9]/, { timeout: 30_000 });
  await page.getByLabel("Latest packets").locator("button.mark").first().click();
  await expect(page.getByTestId("sentence")).toContainText(/^(Received|Lost) at /);
  expect(await page.getByTestId("ladder").locator("tbody tr").count()).toBeGreaterThan(2);
});

test("seeks back in a run, and returns to the present", async ({ page }) => {
  await page.goto(url);
  await expect.poll(() => seconds(page)).toBeGreaterThan(6);
  await page.getByLabel("Simulation time").fill("3");
  await expect.poll(() => seconds(page)).toBeLessThan(4);
  await page.getByRole("button", { name: "Live" }).click();
  await expect.poll(() => seconds(page)).toBeGreaterThan(6);
});

test("says that the bathymetry service ended, and recovers with it", async ({ page, context }) => {
  await page.goto(`${url}#section?link=quay~scout-1`);
  await expect.poll(() => rays(page).count()).toBeGreaterThan(3);
  await expect(condition(page)).toBeHidden();
  // The scenario has the modems: none of these vehicles publishes its own.
  await expect(page.locator("rect.guard")).toBeAttached();
  await expect(page.getByTestId("budget").locator("path.limit title")).toHaveCount(2);

  await programs.kill(bathymetry);
  await expect(condition(page)).toContainText("The bathymetry service does not answer");
  await show(page, "Chart");
  await expect(chart(page)).toHaveAttribute("data-seabed", /^[1-9]\d\d/); // what was received stays
  // A channel server that begins now knows no seabed, neither does a monitor.
  await programs.kill(channel_server);
  channel_server = node("channel-server");
  await show(page, "Section");
  await expect(page.locator(".section")).toContainText("straight paths, no seabed", { timeout: 30_000 });
  expect(await rays(page).count()).toBe(1);
  const later = await context.newPage();
  await later.goto(await programs.monitor());
  await expect(condition(later)).toContainText("The bathymetry service does not answer");
  await expect(chart(later)).toContainText("No seabed is drawn: the bathymetry service does not answer");
  await expect(chart(later)).toHaveAttribute("data-seabed", "0");

  bathymetry = node("bathymetry");
  await expect(condition(later)).toBeHidden();
  await expect(chart(later)).toHaveAttribute("data-seabed", /^[1-9]\d\d/);
  await expect(chart(later)).not.toContainText("No seabed is drawn");
  await expect(condition(page)).toBeHidden();
  await expect.poll(() => rays(page).count()).toBeGreaterThan(3);
  await expect(page.locator(".section")).not.toContainText("straight paths, no seabed");
});
