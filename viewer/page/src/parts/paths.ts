// SPDX-License-Identifier: BSD-3-Clause
// Paths of sound as they are named and coloured: by the number of their bounces.
import type { Arrival } from "../protocol";
import { degrees, number } from "./format";

export const BOUNCE_KINDS = ["direct", "one bounce", "two bounces", "three or more"];

/** Index into BOUNCE_KINDS, and of the classes b0 to b3 of theme.css. */
export const bounces = (path: Arrival) => Math.min(3, path.surface_bounces + path.bottom_bounces);

/** One sentence; strongest_db is the level of the strongest path. */
export function describe(path: Arrival, strongest_db: number): string {
  const below = strongest_db - path.level_db;
  return (
    [
      bounces(path) === 0 ? "Direct" : `${path.surface_bounces} times off the surface, ${path.bottom_bounces} off the bottom`,
      `${number(path.delay_s * 1000, 1)} ms`,
      below < 0.05 ? "the strongest" : `${number(below, 1)} dB weaker than the strongest`,
      `launched ${number(degrees(path.launch_rad), 1)}\u00b0, arriving ${number(degrees(path.arrival_rad), 1)}\u00b0 downwards`,
      `weight ${number(path.weight, 2)} in the guard window`,
      ...(path.caustics ? [`${path.caustics} ${path.caustics === 1 ? "caustic" : "caustics"}`] : []),
    ].join(", ") + "."
  );
}
