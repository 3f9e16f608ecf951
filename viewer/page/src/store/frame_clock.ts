// SPDX-License-Identifier: BSD-3-Clause
// Frames come at most 20 a second and unevenly; this is where everything is at any instant between two of them. What is shown lags
// by one frame.
import type { VehicleFrame } from "../protocol";

const SHORTEST_PERIOD_MS = 30;
const LONGEST_PERIOD_MS = 1200;
/** Greatest step of simulation time between frames that is drawn as motion; a greater one is a jump. */
const LONGEST_STEP_S = 30;

export interface Shown {
  time_s: number;
  before: VehicleFrame;
  after: VehicleFrame;
  /** 0 at `before`, 1 at `after`. */
  share: number;
}

export class FrameClock {
  private before: VehicleFrame | null = null;
  private after: VehicleFrame | null = null;
  private arrived_ms = 0;
  private period_ms = 100;

  /** True when this frame is a jump: the first after a seek (`sought`), a new log, a restart. */
  push(frame: VehicleFrame, now_ms: number, sought = false): boolean {
    const last = this.after;
    const step = last ? frame.time_s - last.time_s : 0;
    const jump = sought || !last || step < 0 || step > LONGEST_STEP_S;
    const pause = Math.min(LONGEST_PERIOD_MS, Math.max(SHORTEST_PERIOD_MS, now_ms - this.arrived_ms));
    this.period_ms += 0.2 * (pause - this.period_ms);
    this.before = jump ? frame : last;
    this.after = frame;
    this.arrived_ms = now_ms;
    return jump;
  }

  get newest(): VehicleFrame | null {
    return this.after;
  }

  at(now_ms: number): Shown | null {
    if (!this.before || !this.after) return null;
    const share = Math.min(1, Math.max(0, (now_ms - this.arrived_ms) / this.period_ms));
    const time_s = this.before.time_s + share * (this.after.time_s - this.before.time_s);
    return { time_s, before: this.before, after: this.after, share };
  }
}

/** Difference of two angles, -pi..pi. */
export function turn(from: number, to: number): number {
  const difference = (to - from) % (2 * Math.PI);
  if (difference > Math.PI) return difference - 2 * Math.PI;
  return difference < -Math.PI ? difference + 2 * Math.PI : difference;
}

/** Positions and angles of the instant: 8 numbers a vehicle as in VehicleFrame, by vehicle index; flags -1 where a vehicle is missing. */
export class Instant {
  values = new Float32Array(0);
  flags = new Int16Array(0);

  fill(shown: Shown, vehicles: number) {
    if (this.flags.length < vehicles) {
      this.values = new Float32Array(8 * vehicles);
      this.flags = new Int16Array(vehicles);
    }
    this.flags.fill(-1);
    const { before, after, share } = shown;
    const same = before.n === after.n;
    for (let k = 0; k < after.n; ++k) {
      const index = after.vehicle[k];
      if (index >= this.flags.length) continue;
      this.flags[index] = after.flags[k];
      const smooth = same && before.vehicle[k] === index;
      for (let i = 0; i < 8; ++i) {
        const to = after.values[8 * k + i];
        const from = smooth ? before.values[8 * k + i] : to;
        const step = i >= 3 && i < 6 ? turn(from, to) : to - from;
        this.values[8 * index + i] = Number.isNaN(step) ? to : from + share * step;
      }
    }
  }

  has(vehicle: number): boolean {
    return vehicle < this.flags.length && this.flags[vehicle] >= 0;
  }
  north(vehicle: number) {
    return this.values[8 * vehicle];
  }
  east(vehicle: number) {
    return this.values[8 * vehicle + 1];
  }
  down(vehicle: number) {
    return this.values[8 * vehicle + 2];
  }
  yaw(vehicle: number) {
    return this.values[8 * vehicle + 3];
  }
  pitch(vehicle: number) {
    return this.values[8 * vehicle + 4];
  }
  speed(vehicle: number) {
    return this.values[8 * vehicle + 6];
  }
  seabed(vehicle: number) {
    return this.values[8 * vehicle + 7];
  }
}
