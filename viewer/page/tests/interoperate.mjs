// SPDX-License-Identifier: BSD-3-Clause
// Whether others understand the programs: node tests/interoperate.mjs BIN_FOLDER LOG
// halocline log export --format mcap is read back by @mcap/core; halocline-monitor is a server for @foxglove/ws-protocol.
import assert from "node:assert/strict";
import { execFileSync, spawn } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import foxglove from "@foxglove/ws-protocol";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import { WebSocket } from "ws";

const { FoxgloveClient } = foxglove;
const [bin, log] = process.argv.slice(2);
const folder = mkdtempSync(join(tmpdir(), "halocline-interoperate-"));

function readable(bytes) {
  return {
    size: async () => BigInt(bytes.length),
    read: async (offset, size) => new Uint8Array(bytes.buffer, bytes.byteOffset + Number(offset), Number(size)),
  };
}

async function checkMcap() {
  const file = join(folder, "run.mcap");
  execFileSync(join(bin, "halocline"), ["log", "export", log, "--format", "mcap", "--out", file, "--origin", "30,-28"]);
  const bytes = readFileSync(file);
  const reader = await McapIndexedReader.Initialize({ readable: readable(bytes) });
  const schemas = [...reader.schemasById.values()].map((schema) => schema.name).sort();
  assert.deepEqual(schemas, ["foxglove.LocationFix", "foxglove.Log", "foxglove.SceneUpdate"]);
  for (const schema of reader.schemasById.values()) JSON.parse(new TextDecoder().decode(schema.data));
  const counts = new Map();
  let last = 0n;
  for await (const message of reader.readMessages()) {
    assert.ok(message.logTime >= last, "messages are in order");
    last = message.logTime;
    const topic = reader.channelsById.get(message.channelId).topic;
    const data = JSON.parse(new TextDecoder().decode(message.data));
    counts.set(topic, (counts.get(topic) ?? 0) + 1);
    if (topic === "/scene") assert.ok(data.entities.length > 0);
  }
  assert.ok(counts.get("/scene") > 10 && counts.get("/log") > 0);
  assert.ok([...counts.keys()].some((topic) => topic.endsWith("/position")));
  const total = [...counts.values()].reduce((a, b) => a + b);
  assert.equal(BigInt(total), reader.statistics.messageCount);
  // The same by reading from the first byte to the last, with all checksums.
  const stream = new McapStreamReader({ validateCrcs: true });
  stream.append(bytes);
  let streamed = 0;
  for (let record; (record = stream.nextRecord()); ) streamed += record.type === "Message" ? 1 : 0;
  assert.ok(stream.done());
  assert.equal(streamed, total);
  console.log(`mcap: ${total} messages on ${counts.size} topics`);
}

async function checkFoxglove() {
  const program = spawn(join(bin, "halocline-monitor"), [log], { stdio: ["ignore", "pipe", "inherit"] });
  try {
    const url = await new Promise((resolve) => program.stdout.once("data", (text) => resolve(String(text).trim())));
    const socket = new WebSocket(`${url.replace("http", "ws")}ws`, [FoxgloveClient.SUPPORTED_SUBPROTOCOL]);
    const client = new FoxgloveClient({ ws: socket });
    const seen = new Map(), topics = new Map();
    await new Promise((resolve, reject) => {
      const timer = setTimeout(() => reject(new Error(`only ${[...seen.keys()]} came`)), 20000);
      client.on("error", reject);
      client.on("status", (status) => reject(new Error(status.message)));
      client.on("serverInfo", (info) => assert.ok(info.capabilities.includes("time")));
      client.on("advertise", (channels) => {
        for (const channel of channels) {
          JSON.parse(channel.schema);
          topics.set(client.subscribe(channel.id), channel.topic);
        }
      });
      client.on("message", ({ subscriptionId, timestamp, data }) => {
        assert.ok(timestamp >= 0n);
        seen.set(topics.get(subscriptionId), JSON.parse(new TextDecoder().decode(data)));
        if (seen.has("/scene") && seen.has("/log")) {
          clearTimeout(timer);
          resolve();
        }
      });
    });
    assert.ok(seen.get("/scene").entities.some((entity) => entity.id.startsWith("vehicle-")));
    assert.equal(typeof seen.get("/log").message, "string");
    client.close();
    console.log(`foxglove: ${topics.size} channels`);
  } finally {
    program.kill();
  }
}

try {
  await checkMcap();
  await checkFoxglove();
} finally {
  rmSync(folder, { recursive: true });
}
