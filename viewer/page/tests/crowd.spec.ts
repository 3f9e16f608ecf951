// SPDX-License-Identifier: BSD-3-Clause
// 100 vehicles at 10 Hz with packets under way: 30 frames a second, or the page says what it leaves out. The server is made up.
import { chart, expect, test } from "./fixtures";
import { COLLIDED, RECEIVED, hello, run, state, vehicle } from "./made_up";

const VEHICLES = 100;
const POSTS = 97;
const EXTENT_M = 8000;
const SLOWEST_MS = 1000 / 30;

function frame(time_s: number): Buffer {
  const bytes = Buffer.alloc(12 + 36 * VEHICLES);
  bytes.writeUInt8(1, 0);
  bytes.writeUInt8(1, 1);
  bytes.writeUInt16LE(VEHICLES, 2);
  bytes.writeDoubleLE(time_s, 4);
  for (let k = 0; k < VEHICLES; ++k) {
    const at = 12 + 36 * k;
    const radius = 300 + 34 * k;
    const angle = 1.7 * k * k + (2 * time_s) / radius;
    bytes.writeUInt16LE(k, at);
    [radius * Math.cos(angle), radius * Math.sin(angle), 20 + k, angle + Math.PI / 2, 0, 0, 2, 200].forEach((value, i) =>
      bytes.writeFloatLE(value, at + 4 + 4 * i),
    );
  }
  return bytes;
}
function terrain(id: number): Buffer {
  const bytes = Buffer.alloc(20 + 4 * POSTS * POSTS);
  bytes.writeUInt8(2, 0);
  bytes.writeUInt8(1, 1);
  [POSTS, POSTS, id % 65536].forEach((value, i) => bytes.writeUInt16LE(value, 2 + 2 * i));
  [-EXTENT_M / 2, -EXTENT_M / 2, EXTENT_M / (POSTS - 1)].forEach((value, i) => bytes.writeFloatLE(value, 8 + 4 * i));
  for (let k = 0; k < POSTS * POSTS; ++k)
    bytes.writeFloatLE(200 + 50 * Math.sin(k / 300) * Math.cos((k % POSTS) / 9), 20 + 4 * k);
  return bytes;
}
function packet(n: number, depart_s: number) {
  const source = (37 * n) % VEHICLES;
  const outcomes = Array.from({ length: VEHICLES }, (_, receiver) => ({
    receiver,
    code: (receiver % 3 ? RECEIVED : COLLIDED).code,
    arrive_s: depart_s + 0.02 * receiver,
    end_s: depart_s + 0.02 * receiver + 2,
    range_m: 30 * receiver,
    sinr_db: 8,
  })).filter(({ receiver }) => receiver !== source);
  return {
    key: `p${n}`,
    source,
    destination: -1,
    kind: "data",
    bytes: 32,
    depart_s,
    duration_s: 2,
    result: "accepted",
    north_m: 0,
    east_m: 0,
    down_m: 50,
    wave_speed_mps: 1500,
    outcomes,
  };
}

test("100 vehicles at 10 Hz hold 30 frames a second, or the page says what it sheds", async ({ page }) => {
  const vehicles = Array.from({ length: VEHICLES }, (_, index) => vehicle(index));
  let timer: NodeJS.Timeout | undefined;
  await page.routeWebSocket(/\/ws/, (socket) => {
    const json = (message: object) => socket.send(JSON.stringify(message));
    socket.onMessage((text) => {
      const { ask, id } = JSON.parse(String(text)) as { ask: string; id: number };
      json({ type: "reply", id, ok: ask === "terrain", error: "Not here." });
      if (ask === "terrain") socket.send(terrain(id));
    });
    json({ ...hello, name: "crowd" });
    json({
      ...run,
      name: "crowd",
      vehicles,
      terrain: {
        south_m: -EXTENT_M / 2,
        west_m: -EXTENT_M / 2,
        spacing_m: EXTENT_M / (POSTS - 1),
        rows: POSTS,
        columns: POSTS,
        min_depth_m: 150,
        max_depth_m: 250,
        revision: 1,
      },
    });
    let ticks = 0;
    timer = setInterval(() => {
      const time_s = 10 + ++ticks / 10;
      socket.send(frame(time_s));
      if (ticks % 20 === 0) json({ type: "packets", items: [packet(ticks, time_s)] });
      if (ticks % 10 === 1) json({ ...state, time_s, end_s: time_s });
    }, 100);
  });
  await page.goto("/");
  await expect(chart(page)).toHaveAttribute("data-frame-ms", /[1-9]/, { timeout: 20_000 });
  await page.waitForTimeout(6000);
  let found = "";
  await expect
    .poll(async () => {
      const frame_ms = Number(await chart(page).getAttribute("data-frame-ms"));
      const sheds = (await page.getByTestId("shed").count()) > 0 && (await page.getByTestId("shed").textContent());
      found = `${frame_ms} ms a frame; ${sheds || "nothing is left out"}`;
      return frame_ms < SLOWEST_MS || sheds !== false;
    })
    .toBe(true);
  console.log(found);
  clearInterval(timer);
});
