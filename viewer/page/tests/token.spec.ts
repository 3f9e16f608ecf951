// SPDX-License-Identifier: BSD-3-Clause
// A monitor at an address that others reach: without its token there is a page that says so, and nothing else. scripts/monitor_test
// gives the tests that address.
import { Programs, chart, expect, log, test, vehicles } from "./fixtures";

const ELSEWHERE = "192.0.2.7";
const TOKEN = "north-west-5";
const programs = new Programs();
let url: URL;

test.beforeAll(async () => {
  url = new URL(await programs.monitor("--address", ELSEWHERE, "--token", TOKEN, log()));
});
test.afterAll(() => programs.stop());

test.describe("without the token", () => {
  test.use({ expectedErrors: [/status of 401|Authentication failed/] });

  test("there is a form for it, and the page after the right answer", async ({ page }) => {
    expect(url.hostname).toBe(ELSEWHERE);
    const answer = await page.goto(url.origin);
    expect(answer?.status()).toBe(401);
    await expect(page.getByRole("heading", { name: "A token is needed" })).toBeVisible();
    await expect(page.getByRole("main")).toContainText("halocline-monitor printed");
    await page.getByLabel("Token").fill("south");
    await page.getByRole("button", { name: "Open" }).click();
    await expect(page.getByRole("alert")).toContainText("not the token");
    await expect(chart(page)).toHaveCount(0);
    await page.getByLabel("Token").fill(TOKEN);
    await page.keyboard.press("Enter");
    await expect(vehicles(page)).toHaveCount(5);
  });

  test("neither files nor the WebSocket are served", async ({ page }) => {
    await page.goto(url.origin);
    const answers = await page.evaluate(async () => {
      const socket = new WebSocket(`ws://${location.host}/ws`, "halocline.monitor.v1");
      const opened = await new Promise((resolve) => {
        socket.onopen = () => resolve(true);
        socket.onerror = () => resolve(false);
      });
      return { opened, file: (await fetch("/index.html")).status };
    });
    expect(answers).toEqual({ opened: false, file: 401 });
  });
});

test("the URL with the token opens the page", async ({ page }) => {
  await page.goto(url.href);
  await expect(vehicles(page)).toHaveCount(5);
  await expect(chart(page)).toHaveAttribute("data-seabed", /^[1-9]\d\d/);
});
