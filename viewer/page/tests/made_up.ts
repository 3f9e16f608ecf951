// SPDX-License-Identifier: BSD-3-Clause
// A server that is made up: its messages as the page gets them when all is well. Tests change what they are about.
import type { Hello, OutcomeKind, Run, ServerState, VehicleInfo } from "../src/protocol";

export const RECEIVED: OutcomeKind = {
  code: 0,
  name: "RECEIVED",
  label: "received",
  class: "received",
  mark: "dot",
  colour: "#009e73",
};
export const COLLIDED: OutcomeKind = {
  code: 6,
  name: "COLLIDED",
  label: "collided",
  class: "collided",
  mark: "bowtie",
  colour: "#cc79a7",
};

export const hello: Hello = {
  type: "hello",
  version: 1,
  program: "test",
  source: "bus",
  name: "udpm://239.255.76.67:7667",
  begin_s: 0,
  end_s: 10,
  may_command: false,
  limits: [],
  outcomes: [RECEIVED, COLLIDED],
  link_columns: [],
};

export const vehicle = (index: number): VehicleInfo => ({
  index,
  name: `auv-${index + 1}`,
  id: index + 1,
  model: "torpedo",
  fixed: false,
  colour: index,
  modem: null,
  plan: null,
});

export const run: Run = {
  type: "run",
  name: "",
  description: "",
  seed: null,
  origin: null,
  sea_surface_down_m: 0,
  vehicles: [vehicle(0)],
  threshold_db: null,
  terrain: null,
  water: null,
};

export const state: ServerState = {
  type: "state",
  time_s: 10,
  begin_s: 0,
  end_s: 10,
  live: true,
  playing: true,
  speed: 1,
  bus: "live",
  silent_s: 0,
  has_states: true,
  bathymetry: true,
  channel_server: true,
  real_time_factor: 1,
  vehicles: [],
  nodes: [],
};
