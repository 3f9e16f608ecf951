// SPDX-License-Identifier: BSD-3-Clause
// What the chart shows at first: the square that holds all places given, not larger than the terrain and not much smaller.

export interface Square {
  north_m: number;
  east_m: number;
  half_m: number;
}

/** Around the square, as a share of it. */
const ROOM = 1.2;
const LEAST_SHARE_OF_TERRAIN = 0.06;
const LEAST_M = 300;

/** places: north and east. extent_m: side of the terrain, null without one. Null without a place. */
export function squareAround(places: [number, number][], extent_m: number | null): Square | null {
  if (!places.length) return null;
  const [north, east] = [0, 1].map((k) => {
    const values = places.map((place) => place[k]);
    const [low, high] = [Math.min(...values), Math.max(...values)];
    return { middle: (low + high) / 2, half: (high - low) / 2 };
  });
  const wanted = ROOM * Math.max(north.half, east.half);
  const half_m =
    extent_m === null ? Math.max(LEAST_M, wanted) : Math.min(extent_m / 2, Math.max(LEAST_SHARE_OF_TERRAIN * extent_m, wanted));
  return { north_m: north.middle, east_m: east.middle, half_m };
}
