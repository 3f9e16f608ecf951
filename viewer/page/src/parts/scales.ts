// SPDX-License-Identifier: BSD-3-Clause
// Colours for numbers. Depth: cmocean's "deep"; diverging: orange to blue through a neutral centre, told apart by colour-blind eyes.
import type { LinkColumn } from "../protocol";

export type Rgb = [number, number, number];

const hex = (colours: string): Rgb[] =>
  colours.split(" ").map((c) => [0, 2, 4].map((i) => parseInt(c.slice(i, i + 2), 16)) as Rgb);

const DEEP = hex("fdfecc ceecb3 9cdba5 6fc9a3 56b1a3 4c99a0 44829b 3e6c96 3e528f 403c73 362b4d 271a2c");
const DIVERGING = {
  light: hex("a3470b d9772c f0b884 ebe7df 9fcbe0 3d93bd 07577f"),
  dark: hex("ffa25c d9772c 8f5a37 434b50 3a7390 3f9fce 8fd8ff"),
};
const SEQUENTIAL = {
  light: hex("eceae4 c3d5d8 8fb9c1 5896a6 2c6f87 144a66"),
  dark: hex("2a3439 28505f 2c7186 4496ab 7cbdcb c4e6ea"),
};
const CATEGORY = { light: hex("3d93bd d9772c a3470b 7d6b8a 8c8c8c"), dark: hex("3f9fce d9772c ffa25c a892b8 8c8c8c") };

export const css = ([r, g, b]: Rgb) => `rgb(${Math.round(r)} ${Math.round(g)} ${Math.round(b)})`;

/** Piecewise linear over the stops; share 0..1, beyond takes the ends. */
export function ramp(stops: Rgb[], share: number): Rgb {
  const x = Math.min(1, Math.max(0, share)) * (stops.length - 1);
  const i = Math.min(stops.length - 2, Math.floor(x));
  return [0, 1, 2].map((k) => stops[i][k] + (x - i) * (stops[i + 1][k] - stops[i][k])) as Rgb;
}

/** Depth between the least and the greatest of the chart. */
export function deep(share: number): Rgb {
  return ramp(DEEP, share);
}

/** The same scale about what the modems need: of ratios of signal to noise, whose centre is their threshold. */
export function centred(column: LinkColumn, threshold_db: number | null): LinkColumn {
  const { key, center, low, high } = column;
  if (threshold_db === null || center === null || (key !== "snr_db" && key !== "sinr_db")) return column;
  return { ...column, center: threshold_db, low: low + threshold_db - center, high: high + threshold_db - center };
}

/** Where a value stands on its column's scale, 0..1; a diverging one has its centre at 0.5. */
export function shareOf(column: Pick<LinkColumn, "scale" | "center" | "low" | "high" | "better">, value: number): number {
  let share: number;
  if (column.scale === "diverging" && column.center !== null) {
    const { center, low, high } = column;
    share =
      value < center
        ? 0.5 * (1 - Math.min(1, (center - value) / (center - low)))
        : 0.5 * (1 + Math.min(1, (value - center) / (high - center)));
    if (column.better === "low") share = 1 - share;
  } else share = (value - column.low) / (column.high - column.low);
  return Math.min(1, Math.max(0, share));
}

/** The colour of a value; null where there is none. */
export function colourOf(column: LinkColumn, value: number | null | undefined, dark: boolean): Rgb | null {
  if (value === null || value === undefined || !Number.isFinite(value)) return null;
  const scheme = dark ? "dark" : "light";
  if (column.scale === "category") {
    const at = column.categories.findIndex((category) => category.value === value);
    return CATEGORY[scheme][Math.max(0, at) % CATEGORY[scheme].length];
  }
  return ramp(column.scale === "diverging" ? DIVERGING[scheme] : SEQUENTIAL[scheme], shareOf(column, value));
}

/** Black or white, whichever is read better on this colour. */
export function inkOn([r, g, b]: Rgb): string {
  return 0.299 * r + 0.587 * g + 0.114 * b > 140 ? "#14191c" : "#ffffff";
}

export interface Axis {
  /** From values to pixels. */
  (value: number): number;
  invert(pixel: number): number;
  ticks: number[];
}

/** A linear axis from [low, high] to [from, to] pixels with about `count` round ticks. */
export function axis(low: number, high: number, from: number, to: number, count = 5): Axis {
  const span = high - low || 1;
  const place = ((value: number) => from + ((value - low) / span) * (to - from)) as Axis;
  place.invert = (pixel) => low + ((pixel - from) / (to - from || 1)) * span;
  place.ticks = ticks(low, high, count);
  return place;
}

export function ticks(low: number, high: number, count: number): number[] {
  if (!(high > low)) return [low];
  const raw = (high - low) / count;
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = power * (raw / power > 5 ? 10 : raw / power > 2 ? 5 : raw / power > 1 ? 2 : 1);
  const out: number[] = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i) out.push(i * step + 0); // never -0
  return out;
}

/** Ticks at seconds, minutes and hours that people count in. */
export function timeTicks(low_s: number, high_s: number, count: number): number[] {
  const raw = (high_s - low_s) / count;
  const step =
    raw < 1
      ? 0
      : ([1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 900, 1800, 3600, 7200, 14400, 43200, 86400].find((each) => each >= raw) ?? 0);
  if (!step) return ticks(low_s, high_s, count);
  const out: number[] = [];
  for (let t = Math.ceil(low_s / step) * step; t <= high_s; t += step) out.push(t);
  return out;
}

/** A line through pixels, as the d of an SVG path. */
export function polyline(x: number[], y: number[]): string {
  return x.map((each, i) => `${i ? "L" : "M"}${each.toFixed(1)} ${y[i].toFixed(1)}`).join("");
}

/** Angles in degrees within half a circle of their mean direction, so that a course about north is one line. */
export function aroundMean(series: (number | null)[][]): (number | null)[][] {
  let [north, east] = [0, 0];
  for (const value of series.flat()) {
    if (value === null) continue;
    north += Math.cos((value * Math.PI) / 180);
    east += Math.sin((value * Math.PI) / 180);
  }
  const mean = (Math.atan2(east, north) * 180) / Math.PI;
  return series.map((values) => values.map((value) => (value === null ? null : mean + turned(value - mean))));
}
const turned = (angle_deg: number) => ((((angle_deg + 180) % 360) + 360) % 360) - 180;

/** Decimals that tell neighbouring ticks apart; of a single one, those that it has. */
export function digitsOf(values: number[]): number {
  if (values.length === 0) return 0;
  const has = (digits: number) => Math.abs(values[0] * 10 ** digits - Math.round(values[0] * 10 ** digits)) < 1e-6;
  if (values.length === 1) return [0, 1, 2].find(has) ?? 3;
  return Math.max(0, -Math.floor(Math.log10(Math.abs(values[1] - values[0])) + 1e-9));
}
