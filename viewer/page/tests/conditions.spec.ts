// SPDX-License-Identifier: BSD-3-Clause
// What the page says when something is missing. The server's words are made up here; only the page itself is fetched.
import type { Page, WebSocketRoute } from "@playwright/test";
import { expect, test } from "./fixtures";
import { hello, run, state } from "./made_up";

/** A server that sends these at once, and refuses every request. Resolves to its socket. */
async function serve(page: Page, ...messages: object[]): Promise<WebSocketRoute> {
  let opened: (socket: WebSocketRoute) => void;
  const socket = new Promise<WebSocketRoute>((resolve) => {
    opened = resolve;
  });
  await page.routeWebSocket(/\/ws/, (route) => {
    route.onMessage((text) =>
      route.send(JSON.stringify({ type: "reply", id: JSON.parse(String(text)).id, ok: false, error: "Not here." })),
    );
    for (const message of messages) route.send(JSON.stringify(message));
    opened(route);
  });
  await page.goto("/");
  return socket;
}
const condition = (page: Page) => page.getByTestId("condition");

test("no bus", async ({ page }) => {
  await serve(page, hello, { ...run, vehicles: [] }, { ...state, bus: "reconnecting", live: false });
  await expect(condition(page)).toContainText("No bus");
});

test("a silent bus without vehicles says how to start a run", async ({ page }) => {
  await serve(page, hello, { ...run, vehicles: [] }, { ...state, bus: "silent", silent_s: 4 });
  await expect(condition(page)).toContainText("The bus is silent");
  await expect(condition(page)).toContainText("./scripts/run --distributed");
});

test("no vehicles, until one comes", async ({ page }) => {
  const socket = await serve(page, hello, { ...run, vehicles: [] }, state);
  await expect(condition(page)).toContainText("No vehicles yet");
  socket.send(JSON.stringify(run));
  await expect(condition(page)).toBeHidden();
});

test("bathymetry unavailable, and back", async ({ page }) => {
  const socket = await serve(page, hello, run, { ...state, bathymetry: false });
  await expect(condition(page)).toContainText("The bathymetry service does not answer");
  socket.send(JSON.stringify(state));
  await expect(condition(page)).toBeHidden();
});

test("a bus whose scenario was not published yet says when it will be", async ({ page }) => {
  const socket = await serve(page, hello, run, state);
  await expect(page.getByLabel("Selection")).toContainText("publishes the scenario once a minute");
  socket.send(JSON.stringify({ ...run, name: "harbour" }));
  await expect(page.getByLabel("Selection")).toContainText("harbour");
  await expect(page.getByLabel("Selection")).not.toContainText("once a minute");
});

test("a bus that falls silent keeps what was seen", async ({ page }) => {
  await serve(page, hello, run, { ...state, bus: "silent", silent_s: 12 });
  await expect(condition(page)).toContainText("No message for 12 s");
  await expect(page.getByLabel("Selection")).toContainText("auv-1");
});

test("a log without states", async ({ page }) => {
  await serve(page, { ...hello, source: "log", name: "a.lcm" }, run, {
    ...state,
    bus: "none",
    live: false,
    has_states: false,
  });
  await expect(condition(page)).toContainText("recorded without the channels STATE");
});

test("another version", async ({ page }) => {
  await serve(page, { ...hello, version: 2 });
  await expect(condition(page)).toContainText("another version");
});

test("no monitor, tried again with growing pauses", async ({ page }) => {
  let attempts = 0;
  await page.routeWebSocket(/\/ws/, (socket) => {
    ++attempts;
    socket.close();
  });
  await page.goto("/");
  await expect(condition(page)).toContainText("The monitor does not answer");
  await expect.poll(() => attempts).toBeGreaterThan(2);
  await expect(page.getByRole("button", { name: "Now" })).toBeVisible();
});
