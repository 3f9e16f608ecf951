// SPDX-License-Identifier: BSD-3-Clause
// Pictures of the views for the documentation: node tests/draw_pictures.mjs SEAMOUNT_URL HARBOUR_URL FOLDER
import { join } from "node:path";
import { chromium } from "@playwright/test";

const [seamount, harbour, folder] = process.argv.slice(2);
const pictures = [
  ["monitor-chart", harbour, "#chart?t=52.3", "light"],
  ["monitor-chart-dark", seamount, "#chart?t=122.9&vehicle=auv-1", "dark"],
  ["monitor-section", seamount, "#section?t=122&link=auv-1~auv-2", "light"],
  ["monitor-matrix", harbour, "#matrix?t=103&column=sinr_db&link=scout-1~gate", "dark"],
  ["monitor-time-line", harbour, "#time-line?t=97", "light", "["],
  ["monitor-vehicle", seamount, "#vehicle?t=143&vehicle=auv-1", "light"],
];
const SETTLE_MS = 4000;

const browser = await chromium.launch({ executablePath: "/usr/bin/chromium", args: ["--no-sandbox", "--enable-unsafe-swiftshader"] });
for (const [name, url, hash, colorScheme, key] of pictures) {
  const page = await browser.newPage({ viewport: { width: 1280, height: 800 }, colorScheme });
  await page.goto(url + hash);
  await page.waitForTimeout(SETTLE_MS);
  if (key) {
    await page.keyboard.press(key);
    await page.waitForTimeout(SETTLE_MS / 2);
  }
  const photo = name.startsWith("monitor-chart");  // shaded relief is smaller as JPEG, everything else as PNG
  await page.screenshot(photo ? { path: join(folder, `${name}.jpg`), type: "jpeg", quality: 85 } : { path: join(folder, `${name}.png`) });
  await page.close();
}
await browser.close();
