// SPDX-License-Identifier: BSD-3-Clause
// Where each vehicle has been lately.
import type { Track } from "../protocol";
import type { Instant } from "../store/frame_clock";

/** Between two kept places, seconds. */
const STEP_S = 2;
const LONGEST_S = 300;

export interface Trail {
  time_s: number[];
  /** north, east, down: three numbers a place */
  places: number[];
}

export class Trails {
  private trails: Trail[] = [];

  clear() {
    this.trails = [];
  }
  of(vehicle: number): Trail | undefined {
    return this.trails[vehicle];
  }

  /** What was before the frames that came; of a track only what is earlier than the first of them counts. */
  addTracks(tracks: Track[]) {
    for (const { vehicle, time_s, north_m, east_m, down_m } of tracks) {
      const later = this.trails[vehicle] ?? { time_s: [], places: [] };
      const first = later.time_s[0] ?? Infinity;
      const trail: Trail = { time_s: [], places: [] };
      time_s.forEach((t, i) => {
        if (t >= first) return;
        trail.time_s.push(t);
        trail.places.push(north_m[i], east_m[i], down_m[i]);
      });
      trail.time_s.push(...later.time_s);
      trail.places.push(...later.places);
      this.trails[vehicle] = trail;
    }
  }

  add(instant: Instant, now_s: number, vehicles: number) {
    for (let index = 0; index < vehicles; ++index) {
      if (!instant.has(index)) continue;
      const trail = (this.trails[index] ??= { time_s: [], places: [] });
      const last = trail.time_s.at(-1);
      if (last !== undefined && now_s - last < STEP_S) continue;
      trail.time_s.push(now_s);
      trail.places.push(instant.north(index), instant.east(index), instant.down(index));
      let old = 0;
      while (now_s - trail.time_s[old] > LONGEST_S) ++old;
      if (old > 30) {
        trail.time_s.splice(0, old);
        trail.places.splice(0, 3 * old);
      }
    }
  }
}
