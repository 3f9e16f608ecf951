// SPDX-License-Identifier: BSD-3-Clause
// The monitor's protocol, version 1: what ../../README.md states, as types, and the decoding of binary messages.

export const PROTOCOL_VERSION = 1;
export const SUBPROTOCOL = "halocline.monitor.v1";

export type OutcomeClass = "received" | "not_acquired" | "bit_errors" | "collided" | "half_duplex" | "no_path" | "pending";
export type Mark = "dot" | "ring" | "cross" | "bowtie" | "bar" | "dash";

export interface OutcomeKind {
  code: number;
  name: string;
  label: string;
  class: OutcomeClass;
  mark: Mark;
  colour: string;
}

export interface LinkColumn {
  key: string; // a field of link_t, or received_share
  label: string;
  unit: string;
  digits: number;
  scale: "diverging" | "sequential" | "category";
  center: number | null;
  low: number;
  high: number;
  better: "high" | "low" | "none";
  help: string;
  categories: { value: number; label: string; good: boolean }[];
}

export interface Hello {
  type: "hello";
  version: number;
  program: string;
  source: "bus" | "log";
  name: string;
  begin_s: number;
  end_s: number;
  may_command: boolean;
  limits: string[];
  outcomes: OutcomeKind[];
  link_columns: LinkColumn[];
}

export interface Plan {
  kind: string;
  at_end: string;
  radius_m: number | null;
  leg: number | null;
  waypoints: [number, number, number][];
}

export interface VehicleInfo {
  index: number;
  name: string;
  id: number;
  model: string;
  fixed: boolean;
  colour: number;
  modem: {
    family: string;
    source_level_db: number;
    center_frequency_hz: number;
    bandwidth_hz: number;
    bit_rate_bps: number | null;
    /** SINR at which half of its packets survive without fading. */
    threshold_db: number | null;
  } | null;
  plan: Plan | null;
}

export interface Profile {
  depth_m: number[];
  sound_speed_mps: number[];
}

export interface Mission {
  type: "mission";
  name: string;
  description: string;
  seed: number | null;
  origin: { latitude_deg: number; longitude_deg: number } | null;
  sea_surface_down_m: number;
  vehicles: VehicleInfo[];
  /** Of the modem of most vehicles. */
  threshold_db: number | null;
  terrain: {
    south_m: number;
    west_m: number;
    spacing_m: number;
    rows: number;
    columns: number;
    min_depth_m: number | null;
    max_depth_m: number | null;
    revision: number;
  } | null;
  water: (Profile & { wind_mps: number | null }) | null;
}

export interface NodeHealth {
  name: string;
  age_s: number;
  received: number;
  sent: number;
  refused: number;
  gaps: number;
  repaired: number;
  lost: number;
  duplicates: number;
  late: number;
  lateness_max_s: number;
  text: string;
}

export interface ServerState {
  type: "state";
  time_s: number;
  begin_s: number;
  end_s: number;
  live: boolean;
  playing: boolean;
  speed: number;
  bus: "live" | "silent" | "reconnecting" | "none";
  silent_s: number | null;
  has_states: boolean;
  bathymetry: boolean;
  channel_server: boolean;
  real_time_factor: number | null;
  vehicles: { index: number; activity: string | null; faults: string[] }[];
  nodes: NodeHealth[];
}

export interface Outcome {
  receiver: number;
  code: number;
  arrive_s: number;
  end_s: number;
  range_m: number;
  sinr_db: number | null;
}

export interface Packet {
  key: string;
  source: number;
  destination: number;
  kind: "data" | "ping" | "ping_reply" | "ack" | "mini_packet" | "janus" | "janus_cargo";
  bytes: number;
  depart_s: number;
  duration_s: number;
  result: string; // accepted, queued, refused_busy, ...; unknown without a receipt
  north_m: number | null;
  east_m: number | null;
  down_m: number | null;
  wave_speed_mps: number;
  outcomes: Outcome[];
}

export interface Series {
  time_s: number[];
  value: (number | null)[];
}

export interface Track {
  vehicle: number;
  time_s: number[];
  north_m: number[];
  east_m: number[];
  down_m: number[];
}

export interface Arrival {
  delay_s: number;
  level_db: number;
  phase_rad: number;
  surface_bounces: number;
  bottom_bounces: number;
  caustics: number;
  launch_rad: number;
  arrival_rad: number;
  weight: number;
  range_m: number[];
  depth_m: number[];
}

export interface BudgetRow {
  label: string;
  kind: "start" | "step" | "total";
  value: number | null;
  unit: string;
  limit: number | null;
  help: string;
}

export interface LinkReply {
  from: number;
  to: number;
  time_s: number;
  notice: string | null;
  range_m: number | null;
  from_depth_m: number | null;
  to_depth_m: number | null;
  seabed: { range_m: number[]; depth_m: (number | null)[] } | null;
  profile: Profile | null;
  paths: Arrival[];
  guard: { begin_s: number; end_s: number; taper_s: number } | null;
  budget: BudgetRow[] | null;
  fading: {
    label: string;
    unit: string;
    limit: number | null;
    expected: Series;
    packets: { key: string; time_s: number; value: number | null; code: number }[];
  } | null;
}

export interface PairReply extends Series {
  packets: { key: string; depart_s: number; code: number }[];
}

export interface LadderRow {
  step: string;
  quantity: string;
  value: number | null;
  unit: string;
  limit: number | null;
  compare: ">=" | ">" | "<" | null;
  passed: boolean | null;
  help: string;
}

export interface PacketReply {
  key: string;
  receiver: number;
  code: number;
  sentence: string;
  ladder: LadderRow[];
  colliders: { key: string; source: number }[];
}

export interface Panel {
  key: string;
  label: string;
  unit: string;
  downward: boolean;
  digits: number;
  series: (Series & {
    label: string;
    role: "actual" | "commanded" | "measured" | "estimate" | "seabed" | "limit";
    sigma?: (number | null)[];
  })[];
}

export interface VehicleReply {
  vehicle: number;
  panels: Panel[];
  estimate: {
    time_s: number[];
    north_m: number[];
    east_m: number[];
    north_variance_m2: number[];
    covariance_m2: number[];
    east_variance_m2: number[];
    error_m: (number | null)[];
  } | null;
  faults: { begin_s: number; end_s: number | null; label: string }[];
  activities: { begin_s: number; label: string }[];
  safe_state: { begin_s: number; end_s: number | null }[];
}

export interface Overview {
  sent: number[];
  received: number[];
  lost: number[];
}

// Requests by name: what goes with each and what the answer holds.
export interface Asks {
  watch: [{ columns: string[] }, object];
  play: [object, object];
  pause: [object, object];
  speed: [{ x: number }, object];
  seek: [{ time_s: number }, object];
  live: [object, object];
  terrain: [object | { south_m: number; west_m: number; spacing_m: number; rows: number; columns: number }, object];
  packets: [{ from_s: number; to_s: number }, { items: Packet[]; truncated: boolean }];
  overview: [{ from_s: number; to_s: number; bins: number }, Overview];
  tracks: [{ from_s: number; to_s: number; max_points: number }, { tracks: Track[] }];
  link: [{ from: number; to: number; time_s: number }, LinkReply];
  pair: [{ from: number; to: number; column: string; from_s: number; to_s: number }, PairReply];
  row: [{ from: number; to: number; time_s: number }, { values: (number | null)[] }];
  packet: [{ key: string; receiver: number }, PacketReply];
  vehicle: [{ vehicle: number; from_s: number; to_s: number; max_points: number }, VehicleReply];
  command: [{ vehicle: number; propeller_rpm: number; rudder_rad: number; stern_plane_rad: number; for_s: number }, object];
  send: [{ vehicle: number; destination: number; payload: string }, { key: string }];
}

export type ServerText =
  | Hello
  | Mission
  | ServerState
  | { type: "packets"; items: Packet[] }
  | ({ type: "reply"; id: number; ok: boolean; error?: string } & Record<string, unknown>);

export const STALE = 1;
export const SAFE_STATE = 2;
export const ON_SEABED = 4;

/** Vehicles at an instant; element k of each array is of vehicle[k]. */
export interface VehicleFrame {
  kind: "vehicles";
  time_s: number;
  n: number;
  vehicle: Uint16Array;
  flags: Uint16Array;
  /** north, east, down (m), yaw, pitch, roll (rad), speed (m/s), seabed depth (m or NaN): 8 a vehicle */
  values: Float32Array;
}

export interface TerrainTile {
  kind: "terrain";
  id: number;
  south_m: number;
  west_m: number;
  spacing_m: number;
  rows: number;
  columns: number;
  /** Row by row from the south, each from the west; NaN is no ground known. */
  depth_m: Float32Array;
}

export interface LinkTable {
  kind: "links";
  time_s: number;
  column: number;
  from: Uint16Array;
  to: Uint16Array;
  value: Float32Array;
}

export type ServerBinary = VehicleFrame | TerrainTile | LinkTable;

function decodeVehicles(view: DataView): VehicleFrame | null {
  const n = view.getUint16(2, true);
  if (view.byteLength < 12 + 36 * n) return null;
  const frame: VehicleFrame = {
    kind: "vehicles",
    time_s: view.getFloat64(4, true),
    n,
    vehicle: new Uint16Array(n),
    flags: new Uint16Array(n),
    values: new Float32Array(8 * n),
  };
  for (let k = 0, at = 12; k < n; ++k, at += 36) {
    frame.vehicle[k] = view.getUint16(at, true);
    frame.flags[k] = view.getUint16(at + 2, true);
    for (let i = 0; i < 8; ++i) frame.values[8 * k + i] = view.getFloat32(at + 4 + 4 * i, true);
  }
  return frame;
}

function decodeTerrain(view: DataView): TerrainTile | null {
  if (view.byteLength < 20) return null;
  const rows = view.getUint16(2, true);
  const columns = view.getUint16(4, true);
  if (view.byteLength < 20 + 4 * rows * columns) return null;
  const depth_m = new Float32Array(rows * columns);
  for (let i = 0; i < depth_m.length; ++i) depth_m[i] = view.getFloat32(20 + 4 * i, true);
  return {
    kind: "terrain",
    id: view.getUint16(6, true),
    rows,
    columns,
    depth_m,
    south_m: view.getFloat32(8, true),
    west_m: view.getFloat32(12, true),
    spacing_m: view.getFloat32(16, true),
  };
}

function decodeLinks(view: DataView): LinkTable | null {
  if (view.byteLength < 16) return null;
  const n = view.getUint32(4, true);
  if (view.byteLength < 16 + 8 * n) return null;
  const table: LinkTable = {
    kind: "links",
    column: view.getUint16(2, true),
    time_s: view.getFloat64(8, true),
    from: new Uint16Array(n),
    to: new Uint16Array(n),
    value: new Float32Array(n),
  };
  for (let k = 0, at = 16; k < n; ++k, at += 8) {
    table.from[k] = view.getUint16(at, true);
    table.to[k] = view.getUint16(at + 2, true);
    table.value[k] = view.getFloat32(at + 4, true);
  }
  return table;
}

/** Null for a kind, a version or a length that is not of this protocol. */
export function decodeBinary(bytes: ArrayBuffer): ServerBinary | null {
  if (bytes.byteLength < 12) return null;
  const view = new DataView(bytes);
  if (view.getUint8(1) !== PROTOCOL_VERSION) return null;
  switch (view.getUint8(0)) {
    case 1:
      return decodeVehicles(view);
    case 2:
      return decodeTerrain(view);
    case 3:
      return decodeLinks(view);
    default:
      return null;
  }
}
