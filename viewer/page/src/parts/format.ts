// SPDX-License-Identifier: BSD-3-Clause
// Numbers as they are shown.

/** With a true minus and narrow spaces between thousands; a dash for what does not exist. */
export function number(value: number | null | undefined, digits = 1): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  const text = Math.abs(value)
    .toFixed(digits)
    .replace(/\B(?=(\d{3})+(?!\d))(?<!\.\d*)/g, "\u202f");
  return value < 0 && Number(Math.abs(value).toFixed(digits)) !== 0 ? `\u2212${text}` : text;
}

/** 0:00.0, minutes and seconds; with hours from 1 h on. */
export function clock(time_s: number, digits = 1): string {
  const factor = 10 ** digits;
  const total = Math.round(Math.max(0, time_s) * factor) / factor;
  const hours = Math.floor(total / 3600);
  const minutes = Math.floor((total % 3600) / 60);
  const seconds = (total % 60).toFixed(digits).padStart(digits ? digits + 3 : 2, "0");
  return hours ? `${hours}:${String(minutes).padStart(2, "0")}:${seconds}` : `${minutes}:${seconds}`;
}

export const degrees = (angle_rad: number) => (angle_rad * 180) / Math.PI;
/** Whole degrees clockwise from north, 0 to 359. */
export const compass = (angle_deg: number) => ((Math.round(angle_deg) % 360) + 360) % 360;
export const bearing = (angle_rad: number) => compass(degrees(angle_rad));

/** A step of 1, 2 or 5 times a power of ten, at least `least`. */
export function roundStep(least: number): number {
  const power = 10 ** Math.floor(Math.log10(least));
  const step = [1, 2, 5, 10].find((factor) => factor * power >= least * 0.999_999) ?? 10;
  return step * power;
}

/** A unit as it is printed: the wire writes uPa. */
export const printed = (unit: string) => unit.replace("uPa", "\u00b5Pa");

export function distance(metres: number): string {
  return metres >= 1000 ? `${number(metres / 1000, metres % 1000 ? 1 : 0)} km` : `${number(metres, 0)} m`;
}

/** One line of CSV a row; text with commas or quotes is quoted. */
export function csv(rows: (string | number | null)[][]): string {
  const cell = (value: string | number | null) => {
    const text = value === null ? "" : String(value);
    return /[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
  };
  return rows.map((row) => row.map(cell).join(",")).join("\n") + "\n";
}
