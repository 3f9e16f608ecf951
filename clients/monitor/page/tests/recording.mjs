// Plays the CSVs of a run as the monitor's server would: node tests/recording.mjs RUN_FOLDER|fleet:N [PORT]
// What needs a channel server (rays, budgets) is sketched. With fleet:N, N vehicles are made up.
import { execFile, execFileSync } from "node:child_process";
import { createServer } from "node:http";
import { existsSync, readFileSync, readdirSync } from "node:fs";
import { extname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { WebSocketServer } from "ws";

const root = fileURLToPath(new URL("../../../..", import.meta.url));
const bundle = join(root, "build/monitor/page");
const folder = process.argv[2];
const port = Number(process.argv[3] ?? 8600);
const fleet = folder.startsWith("fleet:") ? Number(folder.slice(6)) : 0;

const NAMES = ["RECEIVED", "BELOW_CUTOFF", "RECEIVER_GONE", "SHADOW", "BLOCKED", "OUT_OF_BAND", "COLLIDED", "HALF_DUPLEX", "DOPPLER",
  "BIT_ERRORS", "NOT_ACQUIRED", "FOREIGN", "TOO_WEAK", "TOO_STEEP"];
const CLASSES = { received: ["dot", "#009e73"], not_acquired: ["ring", "#e69f00"], bit_errors: ["cross", "#d55e00"], collided: ["bowtie", "#cc79a7"],
  half_duplex: ["bar", "#56b4e9"], no_path: ["dash", "#8c8c8c"], pending: ["ring", "#b0b0b0"] };
const outcome = (code, name) => {
  const kind = name.toLowerCase();
  const type = kind in CLASSES ? kind : code < 0 ? "pending" : "no_path";
  return { code, name, label: kind.replaceAll("_", " "), class: type, mark: CLASSES[type][0], colour: CLASSES[type][1] };
};
const outcomes = [outcome(-1, "PENDING"), ...NAMES.map((name, code) => outcome(code, name))];
outcomes[0].label = "not decided yet";

const column = (key, label, unit, low, high, more = {}) => ({ key, label, unit, digits: 1, scale: "sequential", center: null, low, high,
  better: "none", help: `${label} of the link table.`, categories: [], scale_factor: 1, ...more });
const link_columns = [
  column("snr_db", "SNR", "dB", -10, 40, { scale: "diverging", center: 10, better: "high", help: "Signal over noise at the receiver, in the sender's band." }),
  column("sinr_db", "SINR", "dB", -10, 20, { scale: "diverging", center: 2.5, better: "high", help: "Signal in the guard window over noise and the packet's own late echoes." }),
  column("delivery_probability", "Predicted delivery", "%", 0, 100, { scale: "diverging", center: 50, better: "high", digits: 0, scale_factor: 100, help: "Of a packet, mean over fading, no other packet under way." }),
  column("received_level_db", "Received level", "dB re 1 µPa", 80, 130, { scale: "diverging", center: 100, better: "high" }),
  column("transmission_loss_db", "Transmission loss", "dB", 30, 90, { better: "low" }),
  column("range_m", "Range", "m", 0, 5000, { digits: 0 }),
  column("delay_s", "Delay", "ms", 0, 3000, { digits: 1, scale_factor: 1000 }),
  column("rms_delay_spread_s", "Delay spread", "ms", 0, 60, { digits: 1, scale_factor: 1000, better: "low" }),
  column("doppler_spread_hz", "Doppler spread", "Hz", 0, 5, { digits: 2, better: "low" }),
  column("coherence_time_s", "Coherence time", "s", 0, 1, { digits: 2, better: "high" }),
  column("best_rate_bps", "Best rate", "bit/s", 0, 100, { digits: 0, better: "high" }),
  column("path_state", "Path", "", 0, 4, { scale: "category", digits: 0, categories: ["open", "shadow", "blocked", "too weak", "too steep"].map((label, value) => ({ value, label, good: value === 0 })) }),
  column("received_share", "Packets received", "%", 0, 100, { scale: "diverging", center: 50, better: "high", digits: 0, help: "Of this pair's packets of the last 300 s." }),
];

function csv(name) {
  const path = join(folder, "csv", `${name}.csv`);
  if (!existsSync(path)) return [];
  const [head, ...lines] = readFileSync(path, "utf8").trimEnd().split("\n");
  const keys = head.split(",");
  return lines.map((line) => Object.fromEntries(line.split(",").map((value, i) => [keys[i], value])));
}
const mean = (low, high, f) => low + (high - low) * f;

// --- the run
const states = [];   // by vehicle: {t, v: Float64Array rows of 8}
const packets = [];
const links = [];    // {t, from, to, row}
let vehicles = [], water = null, sensors = [], commands = [], nodes = [], end_s = 200, mission_name = fleet ? "fleet" : "", description = "", scenario = null;
let terrain = null;
const depthAt = (n, e) => {
  const r = (n - terrain.south_m) / terrain.spacing_m, c = (e - terrain.west_m) / terrain.spacing_m;
  const i = Math.floor(r), j = Math.floor(c);
  if (!(i >= 0 && j >= 0 && i < terrain.rows - 1 && j < terrain.columns - 1)) return NaN;
  const at = (a, b) => terrain.depth[a * terrain.columns + b];
  return mean(mean(at(i, j), at(i, j + 1), c - j), mean(at(i + 1, j), at(i + 1, j + 1), c - j), r - i);
};
function makeTerrain(size, f) {
  const rows = 97, columns = 97, spacing_m = size / 96;
  terrain = { south_m: -size / 2, west_m: -size / 2, spacing_m, rows, columns, depth: new Float32Array(rows * columns) };
  for (let i = 0; i < rows; ++i) for (let j = 0; j < columns; ++j) {
    let relief = 0;
    for (let k = 1; k <= 6; ++k) relief += Math.sin(k * (0.21 * i + 0.07 * j * (k % 2 ? 1 : -1)) + k * k) * Math.cos(k * (0.19 * j - 0.05 * i) - 1.3 * k) / k ** 1.3;
    terrain.depth[i * columns + j] = f(terrain.south_m + i * spacing_m, terrain.west_m + j * spacing_m, relief);
  }
}
const yawPitchRoll = (w, x, y, z) => [Math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)),
  Math.asin(Math.max(-1, Math.min(1, 2 * (w * y - z * x)))), Math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))];

function readRun() {
  const toml = readdirSync(folder).find((name) => name.endsWith(".toml"));
  mission_name = toml.replace(".toml", "");
  scenario = join(root, "scenarios", toml);
  const text = readFileSync(join(folder, toml), "utf8");
  description = /description = "(.*)"/.exec(text)?.[1] ?? "";
  const kinds = { seamount: [8000, (n, e, r) => 150 + Math.min(160, (n * n + e * e) / 1.6e5 * 1.2) + 8 * r], harbour: [1600, (n, e, r) => 14 - 0.006 * (n * Math.cos(3.49) + e * Math.sin(3.49)) + 0.5 * r],
    shelf: [8000, () => 100] };
  makeTerrain(...(kinds[mission_name] ?? [8000, (n, e, r) => 150 + 5 * r]));
  const blocks = text.split("[[vehicle]]").slice(1);
  vehicles = blocks.map((block, index) => {
    const get = (key) => new RegExp(`^${key} = "?([^"\\n]*)"?`, "m").exec(block)?.[1];
    const points = JSON.parse(get("waypoints")?.replaceAll(/,\s*\]/g, "]") ?? "[]");
    return { index, name: get("name"), id: Number(get("id")), model: get("model") ?? "remus100", fixed: get("model") === "fixed", colour: index,
      modem: { family: get("family"), source_level_db: Number(get("source_level_db")), center_frequency_hz: Number(get("center_frequency_hz")), bandwidth_hz: Number(get("bandwidth_hz")), bit_rate_bps: Number(get("bit_rate_bps")) },
      plan: points.length ? { kind: "waypoints", at_end: get("at_end"), radius_m: 5, leg: 0, waypoints: points } : null };
  });
  const indexOf = new Map(vehicles.map((v) => [v.id, v.index]));
  const named = new Map(vehicles.map((v) => [v.name, v.index]));
  vehicles.forEach(() => { states.push([]); sensors.push([]); commands.push([]); });
  for (const r of csv("state")) {
    const v = indexOf.get(Number(r.vehicle_id));
    const [n, e, d] = [0, 1, 2].map((i) => Number(r[`position_ned_m_${i}`]));
    const [vn, ve] = [0, 1].map((i) => Number(r[`velocity_ned_mps_${i}`]));
    states[v].push([r.utime / 1e6, n, e, d, ...yawPitchRoll(...[0, 1, 2, 3].map((i) => Number(r[`orientation_wxyz_${i}`]))), Math.hypot(vn, ve), depthAt(n, e)]);
  }
  for (const r of csv("sensors")) sensors[named.get(r.channel.split(".")[1])]?.push(r);
  for (const r of csv("command")) commands[named.get(r.channel.split(".")[1])]?.push(r);
  for (const r of csv("links")) {
    if (r.utime === undefined || r["peers.transmitter_id"] === "") continue;
    links.push({ t: r.stamp_us / 1e6, from: indexOf.get(Number(r["peers.transmitter_id"])), to: indexOf.get(Number(r["peers.receiver_id"])),
      values: link_columns.map((c) => { const x = r[`peers.${c.key}`]; return x === undefined ? NaN : Number(x) * c.scale_factor; }), row: r });
  }
  const byKey = new Map();
  for (const r of csv("send")) {
    const source = indexOf.get(Number(r.source_id));
    byKey.set(`${r.source_id}.${r.session}.${r.packet_sequence}.${r.packet_kind}`, { key: `${r.source_id}.${r.packet_sequence}.${r.packet_kind}`, source,
      destination: Number(r.destination_id) ? indexOf.get(Number(r.destination_id)) : -1, kind: ["data", "ping", "ping_reply"][r.packet_kind], bytes: Number(r.payload_size),
      depart_s: r.utime / 1e6, duration_s: 0, result: "unknown", north_m: null, east_m: null, down_m: null, wave_speed_mps: 1520, outcomes: [], rows: [] });
  }
  for (const r of csv("receipt")) {
    const id = vehicles[named.get(r.channel.split(".")[1])].id;
    for (const kind of [0, 1]) {
      const p = byKey.get(`${id}.${r.send_session}.${r.packet_sequence}.${kind}`);
      if (p) { p.result = ["accepted", "refused_busy", "refused_too_large", "refused_unknown_vehicle"][r.receipt_result] ?? "queued"; if (r.start_utime > 0) p.depart_s = r.start_utime / 1e6; p.duration_s = Number(r.duration_s); }
    }
  }
  let last = null;
  for (const r of csv("outcome")) {
    if (r.utime === "" || r.outcome === "") { if (last) last.colliders.push(r); continue; }
    const p = byKey.get(`${r.source_id}.${r.send_session}.${r.packet_sequence}.${r.packet_kind}`);
    if (!p) continue;
    if (p.outcomes.some((o) => o.receiver === indexOf.get(Number(r.receiver_id)))) continue;
    const depart = r.departure_utime / 1e6;
    last = { ...r, colliders: r["colliders.source_id"] ? [r] : [] };
    p.rows.push(last);
    p.outcomes.push({ receiver: indexOf.get(Number(r.receiver_id)), code: Number(r.outcome), arrive_s: depart + Number(r.travel_time_s), end_s: depart + Number(r.travel_time_s) + Number(r.duration_s), range_m: Number(r.range_m), sinr_db: Number(r.sinr_db) || null });
  }
  packets.push(...byKey.values());
  const env = csv("environment").filter((r) => r.layer_depth_m !== "");
  const first = env[0]?.event;
  const layers = env.filter((r) => r.event === first);
  water = { depth_m: layers.map((r) => Number(r.layer_depth_m)), sound_speed_mps: layers.map((r) => Number(r.layer_sound_speed_mps)), wind_mps: Number(layers[0].wind_speed_mps) };
  nodes = Object.values(Object.fromEntries(csv("status").map((r) => [r.node_name, r])));
}
function makeFleet() {
  makeTerrain(8000, (n, e, r) => 150 + Math.min(160, (n * n + e * e) / 1.3e5) + 8 * r);
  description = `${fleet} vehicles, made up`;
  for (let i = 0; i < fleet; ++i) {
    vehicles.push({ index: i, name: `auv-${i + 1}`, id: i + 1, model: "remus100", fixed: false, colour: i, modem: null, plan: null });
    states.push([]); sensors.push([]); commands.push([]);
    const radius = 300 + 3200 * ((i * 0.618) % 1), phase = i * i * 1.7, depth = 20 + 100 * ((i * 0.377) % 1), rate = 2 / radius;
    for (let k = 0; k <= 6000; ++k) {
      const t = k / 10, a = phase + rate * t;
      states[i].push([t, radius * Math.cos(a), radius * Math.sin(a), depth, a + Math.PI / 2, 0, 0, 2, depthAt(radius * Math.cos(a), radius * Math.sin(a))]);
    }
  }
  end_s = 600;
  for (let k = 0; k < 300; ++k) {
    const source = (k * 37) % fleet, depart_s = 2 * k, at = states[source][Math.round(depart_s * 10)];
    packets.push({ key: `p${k}`, source, destination: -1, kind: "data", bytes: 32, depart_s, duration_s: 3, result: "accepted", north_m: at[1], east_m: at[2], down_m: at[3], wave_speed_mps: 1520, rows: [],
      outcomes: vehicles.filter((v) => v.index !== source).map((v) => { const b = states[v.index][Math.round(depart_s * 10)], range = Math.hypot(b[1] - at[1], b[2] - at[2], b[3] - at[3]);
        const code = range > 3400 ? 1 : (v.index * 7 + k) % 11 === 0 ? 6 : (v.index * 5 + k) % 13 === 0 ? 9 : 0;
        return { receiver: v.index, code, arrive_s: depart_s + range / 1520, end_s: depart_s + 3 + range / 1520, range_m: range, sinr_db: 8 }; }) });
  }
  for (let t = 0; t < 600; t += 10) for (let i = 0; i < fleet; ++i) for (let j = 0; j < fleet; ++j) if (i !== j) {
    const a = states[i][t * 10], b = states[j][t * 10], range = Math.hypot(b[1] - a[1], b[2] - a[2]);
    if (t === 0) links.push({ t, from: i, to: j, values: link_columns.map((c) => c.key === "range_m" ? range : c.key === "snr_db" ? 45 - range / 90 : 5), row: {} });
  }
}
if (fleet) makeFleet(); else readRun();
end_s = Math.max(...states.map((rows) => rows.at(-1)?.[0] ?? 0));
packets.sort((a, b) => a.depart_s - b.depart_s);
const stateAt = (v, t) => {
  const rows = states[v];
  if (!rows.length) return null;
  let low = 0, high = rows.length - 1;
  while (low < high) { const mid = (low + high + 1) >> 1; if (rows[mid][0] <= t) low = mid; else high = mid - 1; }
  return rows[low];
};
for (const p of packets) {
  const s = stateAt(p.source, p.depart_s);
  if (s && p.north_m === null) [p.north_m, p.east_m, p.down_m] = s.slice(1, 4);
}
const packetItem = ({ rows, ...p }) => p;
const linkRow = (from, to, t) => links.filter((r) => r.from === from && r.to === to && r.t <= t).at(-1);
const share = (from, to, t) => {
  const of = packets.filter((p) => p.source === from && p.depart_s <= t && p.depart_s > t - 300).flatMap((p) => p.outcomes.filter((o) => o.receiver === to && o.end_s <= t));
  return of.length ? 100 * of.filter((o) => o.code === 0).length / of.length : NaN;
};
const valueOf = (row, index, t) => link_columns[index].key === "received_share" ? share(row.from, row.to, t) : row.values[index];

// --- messages
const hello = { type: "hello", version: 1, program: "recording", source: "log", name: fleet ? folder : `${folder}/${mission_name}.lcm`, begin_s: 0, end_s, may_command: false, limits: [], outcomes, link_columns };
const mission = { type: "mission", name: mission_name, description, seed: 1, origin: { latitude_deg: 29.9167, longitude_deg: -28.4167 }, sea_surface_down_m: 0, vehicles,
  terrain: { ...terrain, depth: undefined, min_depth_m: Math.min(...terrain.depth), max_depth_m: Math.max(...terrain.depth), revision: 1 }, water };

function frame(t) {
  const present = vehicles.map((v) => [v.index, stateAt(v.index, t)]).filter(([, s]) => s);
  const out = Buffer.alloc(12 + 36 * present.length);
  out.writeUInt8(1, 0); out.writeUInt8(1, 1); out.writeUInt16LE(present.length, 2); out.writeDoubleLE(t, 4);
  present.forEach(([index, s], k) => {
    const at = 12 + 36 * k;
    out.writeUInt16LE(index, at); out.writeUInt16LE(t - s[0] > 2 && !vehicles[index].fixed ? 1 : 0, at + 2);
    s.slice(1, 9).forEach((x, i) => out.writeFloatLE(x, at + 4 + 4 * i));
  });
  return out;
}
function terrainTile(id) {
  const out = Buffer.alloc(20 + 4 * terrain.depth.length);
  out.writeUInt8(2, 0); out.writeUInt8(1, 1); out.writeUInt16LE(terrain.rows, 2); out.writeUInt16LE(terrain.columns, 4); out.writeUInt16LE(id % 65536, 6);
  out.writeFloatLE(terrain.south_m, 8); out.writeFloatLE(terrain.west_m, 12); out.writeFloatLE(terrain.spacing_m, 16);
  terrain.depth.forEach((d, i) => out.writeFloatLE(d, 20 + 4 * i));
  return out;
}
function linkTable(columnIndex, t) {
  const rows = new Map();
  for (const r of links) if (r.t <= t && (fleet || r.t > t - 10)) rows.set(r.from * 1000 + r.to, r);
  const list = [...rows.values()];
  const out = Buffer.alloc(16 + 8 * list.length);
  out.writeUInt8(3, 0); out.writeUInt8(1, 1); out.writeUInt16LE(columnIndex, 2); out.writeUInt32LE(list.length, 4); out.writeDoubleLE(t, 8);
  list.forEach((r, k) => { out.writeUInt16LE(r.from, 16 + 8 * k); out.writeUInt16LE(r.to, 18 + 8 * k); out.writeFloatLE(valueOf(r, columnIndex, t), 20 + 8 * k); });
  return out;
}
const thin = (rows, max) => rows.filter((_, i) => i % Math.max(1, Math.ceil(rows.length / max)) === 0 || i === rows.length - 1);
function packetReply(key, receiver) {
  const p = packets.find((q) => q.key === key);
  const o = p?.outcomes.find((x) => x.receiver === receiver);
  const r = p?.rows.find((x) => vehicles[receiver].id === Number(x.receiver_id));
  if (!o || !r) return null;
  const n = (name) => Number(r[name]);
  const decided = n("sinr_db") !== 0;
  const row = (step, quantity, value, unit, limit = null, compare = null, passed = null, help = "") => ({ step, quantity, value, unit, limit, compare, passed, help });
  const ladder = [row("level", "Source level", n("received_level_db") + n("transmission_loss_db"), "dB re 1 µPa at 1 m"), row("level", "Transmission loss", n("transmission_loss_db"), "dB"),
    row("level", "Received level", n("received_level_db"), "dB re 1 µPa", n("cutoff_level_db"), ">=", n("received_level_db") >= n("cutoff_level_db"), "Below its cut-off level the modem does not react."),
    row("noise", "Noise level", n("noise_level_db"), "dB re 1 µPa"), row("noise", "SNR", n("snr_db"), "dB"),
    row("interference", "Late echoes and other packets", decided ? n("interference_level_db") : null, "dB re 1 µPa"), row("interference", "SINR", decided ? n("sinr_db") : null, "dB"),
    row("acquisition", "Random draw of the acquisition", decided ? n("acquisition_draw") : null, "", decided ? n("acquisition_probability") : null, "<", decided ? n("acquisition_draw") < n("acquisition_probability") : null, "Detected when below the probability."),
    row("decoding", "Random draw of the decoding", decided ? n("success_draw") : null, "", decided ? n("success_probability") : null, "<", decided ? n("success_draw") < n("success_probability") : null, "Right when below the probability.")];
  const name = vehicles[receiver].name;
  const sentence = o.code === 0 ? `Received at ${name}: SINR ${n("sinr_db").toFixed(1)} dB; ${(100 * n("success_probability")).toFixed(0)} % of such packets survive.`
    : o.code === 1 ? `Lost at ${name}: ${n("received_level_db").toFixed(1)} dB arrived, ${(n("cutoff_level_db") - n("received_level_db")).toFixed(1)} dB less than this modem reacts to.`
    : o.code === 7 ? `Lost at ${name}: it transmitted itself while the packet arrived.`
    : o.code === 6 ? `Lost at ${name}: another packet arrived at the same time; alone this one would have been received.`
    : `Lost at ${name}: late echoes left a SINR of ${n("sinr_db").toFixed(1)} dB; ${(100 * n("success_probability")).toFixed(0)} % of such packets survive, this one did not.`;
  return { key, receiver, code: o.code, sentence, ladder, colliders: r.colliders.map((c) => { const q = packets.find((x) => vehicles[x.source].id === Number(c["colliders.source_id"]) && x.key.split(".")[1] === c["colliders.packet_sequence"]); return q ? { key: q.key, source: q.source } : null; }).filter(Boolean) };
}
function linkReply(from, to, t) {
  const a = stateAt(from, t), b = stateAt(to, t), r = linkRow(from, to, t)?.row ?? {};
  const range = Math.hypot(b[1] - a[1], b[2] - a[2]);
  const seabed = { range_m: [], depth_m: [] };
  for (let k = 0; k <= 80; ++k) { seabed.range_m.push(range * k / 80); const d = depthAt(mean(a[1], b[1], k / 80), mean(a[2], b[2], k / 80)); seabed.depth_m.push(Number.isFinite(d) ? d : null); }
  const bottom = seabed.depth_m.reduce((s, d) => s + d, 0) / 81;
  const at = (s) => s.slice(1, 4).join(",");
  return new Promise((resolve) => {
    if (!scenario) return resolve(null);
    execFile(join(root, "build/release/bin/halocline"), ["link", scenario, "--from", at(a), "--to", at(b), "--arrivals", "--format", "json"], { maxBuffer: 1 << 24 }, (error, text) => {
      const answer = error ? { paths: [] } : JSON.parse(text)[0];
      const paths = answer.paths.map((p) => {
        const up = p.launch_angle_deg < 0, bounces = p.n_surface + p.n_bottom, polyline = { range_m: [0], depth_m: [a[3]] };
        let y = a[3], target = up ? 0 : bottom, unfolded = [];
        for (let k = 0; k < bounces; ++k) { unfolded.push(Math.abs(target - y)); y = target; target = target === 0 ? bottom : 0; }
        const total = unfolded.reduce((s, x) => s + x, 0) + Math.abs(b[3] - y);
        let done = 0, d = up ? 0 : bottom;
        for (const piece of unfolded) { done += piece; const x = range * done / total; polyline.range_m.push(x); polyline.depth_m.push(d === 0 ? 0 : seabed.depth_m[Math.round(80 * x / range)]); d = d === 0 ? bottom : 0; }
        polyline.range_m.push(range); polyline.depth_m.push(b[3]);
        return { delay_s: p.delay_s, level_db: 20 * Math.log10(p.amplitude), phase_rad: p.phase_deg * Math.PI / 180, surface_bounces: p.n_surface, bottom_bounces: p.n_bottom, caustics: p.n_caustic,
          launch_rad: p.launch_angle_deg * Math.PI / 180, arrival_rad: p.arrival_angle_deg * Math.PI / 180, weight: p.delay_s < answer.paths[0].delay_s + 0.03 ? 1 : 0, ...polyline };
      }).sort((x, y) => y.level_db - x.level_db);
      const n = (name) => Number(r[`peers.${name}`]);
      const tl = n("transmission_loss_db"), absorption = range / 1000 * 3.7;
      const history = links.filter((l) => l.from === from && l.to === to);
      resolve({ from, to, time_s: t, notice: null, range_m: Math.hypot(range, b[3] - a[3]), from_depth_m: a[3], to_depth_m: b[3], seabed, profile: water, paths,
        guard: paths.length ? { begin_s: answer.first_delay_s, end_s: answer.first_delay_s + 0.03, taper_s: 0.008 } : null,
        budget: [{ label: "Source level", kind: "start", value: n("received_level_db") + tl, unit: "dB re 1 µPa at 1 m", limit: null, help: "What the sender radiates." }, { label: "Spreading and bounces", kind: "step", value: -(tl - absorption), unit: "dB", limit: null, help: "" },
          { label: "Absorption", kind: "step", value: -absorption, unit: "dB", limit: null, help: "Heat, by the sea's salts." }, { label: "Received level", kind: "total", value: n("received_level_db"), unit: "dB re 1 µPa", limit: 100, help: "The modem's cut-off." },
          { label: "Noise", kind: "step", value: -n("noise_level_db"), unit: "dB re 1 µPa", limit: null, help: "Wind, ships and heat in the band." }, { label: "SNR", kind: "total", value: n("snr_db"), unit: "dB", limit: null, help: "" },
          { label: "Late echoes", kind: "step", value: n("sinr_db") - n("snr_db"), unit: "dB", limit: null, help: "Echoes outside of the guard time." }, { label: "SINR", kind: "total", value: n("sinr_db"), unit: "dB", limit: 2.5, help: "Half of the packets survive." }],
        fading: { label: "Received level", unit: "dB re 1 µPa", limit: 100, expected: { time_s: history.map((l) => l.t), value: history.map((l) => Number(l.row["peers.received_level_db"])) },
          packets: packets.filter((p) => p.source === from).flatMap((p) => p.rows.filter((x) => Number(x.receiver_id) === vehicles[to].id).map((x) => ({ key: p.key, time_s: p.depart_s, value: Number(x.received_level_db), code: Number(x.outcome) }))) } });
    });
  });
}
function vehicleReply(v, from, to, max) {
  const rows = thin(states[v].filter((s) => s[0] >= from && s[0] <= to), max), t = rows.map((s) => s[0]);
  const com = thin(commands[v].filter((c) => c.utime / 1e6 >= from && c.utime / 1e6 <= to), max), ct = com.map((c) => c.utime / 1e6);
  const sen = thin(sensors[v].filter((c) => c.utime / 1e6 >= from && c.utime / 1e6 <= to), max), st = sen.map((c) => c.utime / 1e6);
  const series = (label, role, time_s, value, sigma) => ({ label, role, time_s, value: value.map((x) => Number.isFinite(x) ? x : null), ...(sigma ? { sigma } : {}) });
  const depthWanted = (s) => vehicles[v].plan?.waypoints[Math.min(vehicles[v].plan.waypoints.length - 1, Math.floor(s / 200))]?.[2];
  return { vehicle: v, panels: [
    { key: "depth", label: "Depth", unit: "m", downward: true, digits: 1, series: [series("seabed", "seabed", t, rows.map((s) => s[8])), series("commanded", "commanded", t, t.map(depthWanted)), series("actual", "actual", t, rows.map((s) => s[3]))] },
    { key: "altitude", label: "Altitude", unit: "m", downward: false, digits: 1, series: [series("over the seabed", "actual", t, rows.map((s) => s[8] - s[3])), series("measured", "measured", st, sen.map((s) => s.altitude_status === "0" ? Number(s.altitude_m) : NaN))] },
    { key: "speed", label: "Speed", unit: "m/s", downward: false, digits: 2, series: [series("over ground", "actual", t, rows.map((s) => s[7])), series("through water", "measured", st, sen.map((s) => Number(s.water_speed_mps)))] },
    { key: "heading", label: "Heading", unit: "°", downward: false, digits: 0, series: [series("actual", "actual", t, rows.map((s) => (s[4] * 180 / Math.PI + 360) % 360))] },
    { key: "propeller", label: "Propeller", unit: "rpm", downward: false, digits: 0, series: [series("commanded", "commanded", ct, com.map((c) => Number(c.propeller_rpm))), series("actual", "actual", st, sen.map((s) => Number(s.shaft_rpm)))] },
    { key: "rudder", label: "Rudder", unit: "°", downward: false, digits: 1, series: [series("commanded", "commanded", ct, com.map((c) => c.rudder_rad * 57.2958)), series("actual", "actual", st, sen.map((s) => s.rudder_angle_rad * 57.2958))] },
    { key: "error", label: "Error of the estimate", unit: "m", downward: false, digits: 1, series: [series("error", "estimate", t, t.map((x) => 0.4 + 0.02 * (x % 60)), t.map((x) => 0.5 + 0.03 * (x % 60)))] },
  ], estimate: { time_s: t, north_m: rows.map((s) => s[1] + 0.01 * (s[0] % 60)), east_m: rows.map((s) => s[2] - 0.02 * (s[0] % 60)), north_variance_m2: t.map((x) => 0.3 + 0.05 * (x % 60)), covariance_m2: t.map(() => 0.1), east_variance_m2: t.map((x) => 0.3 + 0.1 * (x % 60)), error_m: t.map(() => 1) },
    faults: [{ begin_s: 120, end_s: 150, label: "rudder stuck at 5 degrees" }], activities: [{ begin_s: 0, label: "Dives to 60 m" }, { begin_s: 30, label: "Follows leg 1 of 4" }, { begin_s: 140, label: "Follows leg 2 of 4" }], safe_state: [] };
}

// --- the server
const types = { ".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".svg": "image/svg+xml", ".woff2": "font/woff2" };
const http = createServer((request, response) => {
  const path = new URL(request.url, "http://x").pathname;
  const file = join(bundle, path === "/" ? "index.html" : path);
  if (!existsSync(file)) { response.writeHead(404).end(); return; }
  response.writeHead(200, { "content-type": types[extname(file)] ?? "application/octet-stream" }).end(readFileSync(file));
});
const sockets = new WebSocketServer({ server: http, path: "/ws", handleProtocols: (wanted) => (wanted.has("halocline.monitor.v1") ? "halocline.monitor.v1" : false) });
export const health = { bathymetry: true, bus: "none" };
sockets.on("connection", (socket) => {
  const my = { t: 0, playing: false, speed: 1, watch: [], told: 0 };
  const json = (value) => socket.send(JSON.stringify(value));
  const state = () => json({ type: "state", time_s: my.t, begin_s: 0, end_s, live: false, playing: my.playing, speed: my.speed, bus: health.bus, silent_s: null, has_states: true, bathymetry: health.bathymetry, channel_server: true, real_time_factor: null,
    vehicles: vehicles.map((v) => ({ index: v.index, activity: v.fixed ? null : v.plan ? "Follows leg 1 of 4" : null, faults: [] })),
    nodes: nodes.map((r) => ({ name: r.node_name, age_s: 0.4, received: +r.messages_received, sent: +r.messages_sent, refused: +r.messages_refused, gaps: +r.gaps, repaired: +r.repaired, lost: +r.lost, duplicates: +r.duplicates, late: +r.late, text: r.status_text })) });
  const show = (from) => { socket.send(frame(my.t)); const items = packets.filter((p) => p.depart_s > from && p.depart_s <= my.t).map(packetItem); if (items.length) json({ type: "packets", items }); };
  const tables = () => my.watch.forEach((c) => socket.send(linkTable(c, my.t)));
  json(hello); json(mission); state(); show(-1);
  let ticks = 0;
  const timer = setInterval(() => {
    ++ticks;
    if (my.playing) { const before = my.t; my.t = Math.min(end_s, my.t + 0.05 * my.speed); if (my.t >= end_s) my.playing = false; if (socket.bufferedAmount === 0) show(before); }
    if (ticks % 20 === 0) { state(); if (my.playing) tables(); }
  }, 50);
  socket.on("close", () => clearInterval(timer));
  socket.on("message", async (bytes) => {
    const q = JSON.parse(bytes.toString());
    const ok = (more = {}) => json({ type: "reply", id: q.id, ok: true, ...more });
    const no = (error) => json({ type: "reply", id: q.id, ok: false, error });
    switch (q.ask) {
      case "watch": my.watch = q.columns.map((key) => link_columns.findIndex((c) => c.key === key)).filter((i) => i >= 0); ok(); tables(); break;
      case "play": my.playing = true; if (my.t >= end_s) my.t = 0; ok(); state(); break;
      case "pause": my.playing = false; ok(); state(); break;
      case "speed": my.speed = q.x; ok(); state(); break;
      case "seek": my.t = Math.max(0, Math.min(end_s, q.time_s)); ok(); state(); show(my.t - 60); tables(); break;
      case "terrain": if (!health.bathymetry) { no("The bathymetry service does not answer."); break; } ok(); socket.send(terrainTile(q.id)); break;
      case "packets": ok({ items: packets.filter((p) => p.depart_s >= q.from_s && p.depart_s <= q.to_s).map(packetItem), truncated: false }); break;
      case "overview": { const bins = { sent: Array(q.bins).fill(0), received: Array(q.bins).fill(0), lost: Array(q.bins).fill(0) };
        for (const p of packets) { const b = Math.floor((p.depart_s - q.from_s) / (q.to_s - q.from_s) * q.bins); if (b < 0 || b >= q.bins) continue; ++bins.sent[b]; for (const o of p.outcomes) ++bins[o.code === 0 ? "received" : "lost"][b]; }
        ok(bins); break; }
      case "tracks": ok({ tracks: vehicles.map((v) => { const rows = thin(states[v.index].filter((s) => s[0] >= q.from_s && s[0] <= q.to_s), q.max_points); return { vehicle: v.index, time_s: rows.map((s) => s[0]), north_m: rows.map((s) => s[1]), east_m: rows.map((s) => s[2]), down_m: rows.map((s) => s[3]) }; }) }); break;
      case "link": { const reply = await linkReply(q.from, q.to, q.time_s); if (reply) ok(reply); else no("Rays need a channel server."); break; }
      case "pair": { const c = link_columns.findIndex((x) => x.key === q.column), rows = links.filter((r) => r.from === q.from && r.to === q.to && r.t >= q.from_s && r.t <= q.to_s);
        ok({ time_s: rows.map((r) => r.t), value: rows.map((r) => { const x = valueOf(r, c, r.t); return Number.isFinite(x) ? x : null; }), packets: packets.filter((p) => p.source === q.from).flatMap((p) => p.outcomes.filter((o) => o.receiver === q.to).map((o) => ({ key: p.key, depart_s: p.depart_s, code: o.code }))) }); break; }
      case "row": { const r = linkRow(q.from, q.to, q.time_s); ok({ values: link_columns.map((_, i) => { const x = r ? valueOf(r, i, q.time_s) : NaN; return Number.isFinite(x) ? x : null; }) }); break; }
      case "packet": { const reply = packetReply(q.key, q.receiver); if (reply) ok(reply); else no("This packet has no outcome there yet."); break; }
      case "vehicle": ok(vehicleReply(q.vehicle, q.from_s, q.to_s, q.max_points)); break;
      default: no(`Unknown request: ${q.ask}.`);
    }
  });
});
http.listen(port, "127.0.0.1", () => console.log(`http://127.0.0.1:${port}/`));
