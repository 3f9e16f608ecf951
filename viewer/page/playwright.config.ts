// SPDX-License-Identifier: BSD-3-Clause
// ../../scripts/monitor_test starts this with the server's URL in HALOCLINE_MONITOR_URL.
import { defineConfig } from "@playwright/test";

export default defineConfig({
  testDir: "tests",
  testMatch: "*.spec.ts",
  workers: 1,
  timeout: 60_000,
  expect: { timeout: 15_000 },
  outputDir: "../../build/monitor/e2e",
  reporter: "list",
  use: {
    baseURL: process.env.HALOCLINE_MONITOR_URL,
    viewport: { width: 1280, height: 800 },
    launchOptions: { executablePath: "/usr/bin/chromium", args: ["--no-sandbox", "--enable-unsafe-swiftshader"] },
  },
});
