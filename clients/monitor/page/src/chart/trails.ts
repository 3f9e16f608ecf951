// Where each vehicle has been lately, as segments that fade with age.
import type { Track } from "../protocol";
import type { Instant } from "../store/frame_clock";

/** Between two kept places, seconds. */
const STEP_S = 1;
const LONGEST_S = 300;

interface Trail { time_s: number[]; places: number[] }

export class Trails {
  private trails: Trail[] = [];
  private position = new Float32Array(0);
  private colour = new Float32Array(0);

  clear() { this.trails = []; }

  /** What was before the frames that came; tracks end at or before the first of them. */
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

  /** Pairs of vertices in drawing space, the colours with their opacity. The arrays are kept and reused. */
  segments(now_s: number, trail_s: number, stretch: number, dark: boolean) {
    let most = 0;
    for (const trail of this.trails) most += trail ? 2 * trail.time_s.length : 0;
    if (3 * most > this.position.length) {
      this.position = new Float32Array(3 * 2 * most);
      this.colour = new Float32Array(4 * 2 * most);
    }
    const shade = dark ? 1 : 0.02;
    let k = 0;
    for (const trail of this.trails) {
      if (!trail) continue;
      for (let i = 1; i < trail.time_s.length; ++i) {
        const age = now_s - trail.time_s[i];
        if (age > trail_s || age < -STEP_S) continue;
        for (const j of [i - 1, i]) {
          this.position[3 * k] = trail.places[3 * j + 1];
          this.position[3 * k + 1] = -trail.places[3 * j + 2] * stretch;
          this.position[3 * k + 2] = -trail.places[3 * j];
          this.colour.set([shade, shade, shade, 0.85 * (1 - Math.max(0, now_s - trail.time_s[j]) / (1.05 * trail_s))], 4 * k);
          ++k;
        }
      }
    }
    return { position: this.position, colour: this.colour, vertices: k };
  }
}
