// SPDX-License-Identifier: BSD-3-Clause
// What is left out of the chart so that it keeps moving on a slow computer: one step more whenever frames took too long for two
// seconds, one step back after six quick ones, later with more patience.

export interface Step {
  /** Device pixels a CSS pixel, at most. */
  pixel_ratio: number;
  trail_s: number;
  names: "all" | "chosen";
  waves: "filled" | "fronts";
  says: string | null;
}

export const STEPS: Step[] = [
  { pixel_ratio: 2, trail_s: 300, names: "all", waves: "filled", says: null },
  { pixel_ratio: 1, trail_s: 300, names: "all", waves: "filled", says: "drawn at one pixel a point" },
  { pixel_ratio: 1, trail_s: 120, names: "all", waves: "fronts", says: "shorter trails, wavefronts as lines" },
  { pixel_ratio: 0.75, trail_s: 60, names: "chosen", waves: "fronts", says: "short trails, few names, coarser picture" },
  { pixel_ratio: 0.5, trail_s: 30, names: "chosen", waves: "fronts", says: "short trails, few names, coarse picture" },
];

const SLOW_MS = 1000 / 30;
const QUICK_MS = 1000 / 50;
const WINDOW_MS = 1000;
const SLOW_WINDOWS = 2;
const QUICK_WINDOWS = 6;
/** A pause this long is a hidden page, not a slow one. */
const PAUSE_MS = 700;
/** A page that was just opened is slow for other reasons, milliseconds of drawing. */
const START_MS = 4000;

export class Shedding {
  level = 0;
  /** Mean of the last window, milliseconds a frame. */
  frame_ms = 0;
  private last_ms = 0;
  private elapsed_ms = 0;
  private frames = 0;
  private slow = 0;
  private quick = 0;
  private regretted = 0;
  private drawn_ms = 0;

  constructor(private device_pixel_ratio: number) {}

  get step(): Step {
    return STEPS[this.level];
  }

  /** Called at each drawn frame; true when the step changed. */
  frame(now_ms: number): boolean {
    const took = now_ms - this.last_ms;
    this.last_ms = now_ms;
    if (took > PAUSE_MS || took < 0) {
      this.elapsed_ms = this.frames = 0;
      return false;
    }
    this.drawn_ms += took;
    if (this.drawn_ms < START_MS) return false;
    this.elapsed_ms += took;
    ++this.frames;
    if (this.elapsed_ms < WINDOW_MS) return false;
    this.frame_ms = this.elapsed_ms / this.frames;
    this.elapsed_ms = this.frames = 0;
    this.slow = this.frame_ms > SLOW_MS ? this.slow + 1 : 0;
    this.quick = this.frame_ms < QUICK_MS ? this.quick + 1 : 0;
    if (this.slow >= SLOW_WINDOWS && this.level < STEPS.length - 1) {
      ++this.regretted;
      return this.change(1);
    }
    // Each return to a slower picture makes the next one rarer.
    if (this.quick >= QUICK_WINDOWS * this.regretted && this.level > 0) return this.change(-1);
    return false;
  }

  private change(by: 1 | -1): true {
    this.level += by;
    // Fewer pixels are no help where there are no more than one a point.
    if (this.level === 1 && this.device_pixel_ratio <= STEPS[1].pixel_ratio) this.level += by;
    this.slow = this.quick = 0;
    return true;
  }

  /** What a visitor reads; null when nothing is left out. */
  sentence(): string | null {
    const { says } = this.step;
    return says && `This computer draws slowly, so the chart is simpler: ${says}.`;
  }
}
