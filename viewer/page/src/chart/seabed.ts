// SPDX-License-Identifier: BSD-3-Clause
// The seabed of a terrain tile as it is drawn: a mesh, its picture (depth colours under a hill-shade from the north-west), contours.
// Drawing space: x east, y up (depth times the exaggeration), z south, metres.
import { contours } from "d3-contour";
import {
  BufferAttribute,
  BufferGeometry,
  DataTexture,
  LinearFilter,
  LinearMipmapLinearFilter,
  RGBAFormat,
  SRGBColorSpace,
} from "three";
import { roundStep } from "../parts/format";
import { deep } from "../parts/scales";
import type { TerrainTile } from "../protocol";

export interface DepthRange {
  low: number;
  high: number;
}

export function depthRange(tile: TerrainTile): DepthRange | null {
  let low = Infinity;
  let high = -Infinity;
  for (const depth of tile.depth_m) {
    if (depth < low) low = depth;
    if (depth > high) high = depth;
  }
  return high >= low ? { low, high } : null;
}

/** Depth at a place, bilinear; NaN where no seabed is known. */
export function depthAt(tile: TerrainTile, north_m: number, east_m: number): number {
  const y = (north_m - tile.south_m) / tile.spacing_m;
  const x = (east_m - tile.west_m) / tile.spacing_m;
  if (!(x >= 0 && y >= 0 && x <= tile.columns - 1 && y <= tile.rows - 1)) return NaN;
  const i = Math.min(tile.rows - 2, Math.floor(y));
  const j = Math.min(tile.columns - 2, Math.floor(x));
  const at = (row: number, column: number) => tile.depth_m[row * tile.columns + column];
  const south = at(i, j) + (x - j) * (at(i, j + 1) - at(i, j));
  const north = at(i + 1, j) + (x - j) * (at(i + 1, j + 1) - at(i + 1, j));
  return south + (y - i) * (north - south);
}

/** How many times depth is stretched, so that the relief of a wide and shallow sea is seen. */
export function exaggeration(extent_m: number, deepest_m: number): number {
  const wanted = (0.13 * extent_m) / Math.max(1, deepest_m);
  return [20, 10, 5, 3, 2].find((factor) => wanted >= 0.8 * factor) ?? 1;
}

export function seabedGeometry(tile: TerrainTile, stretch: number): BufferGeometry {
  const { rows, columns, spacing_m, south_m, west_m, depth_m } = tile;
  const position = new Float32Array(3 * rows * columns);
  const uv = new Float32Array(2 * rows * columns);
  const index: number[] = [];
  for (let i = 0; i < rows; ++i) {
    for (let j = 0; j < columns; ++j) {
      const k = i * columns + j;
      const depth = depth_m[k];
      position[3 * k] = west_m + j * spacing_m;
      position[3 * k + 1] = Number.isNaN(depth) ? 0 : -depth * stretch;
      position[3 * k + 2] = -(south_m + i * spacing_m);
      uv[2 * k] = j / (columns - 1);
      uv[2 * k + 1] = i / (rows - 1);
      if (i + 1 === rows || j + 1 === columns) continue;
      const corners = [k, k + 1, k + columns + 1, k + columns];
      if (corners.some((corner) => Number.isNaN(depth_m[corner]))) continue;
      index.push(corners[0], corners[1], corners[2], corners[0], corners[2], corners[3]);
    }
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(position, 3));
  geometry.setAttribute("uv", new BufferAttribute(uv, 2));
  geometry.setIndex(index);
  return geometry;
}

/** Light from the north-west, 45 degrees high, on the stretched relief; 1 is a level seabed. */
function hillShade(north_slope: number, east_slope: number, stretch: number): number {
  // The seabed's height falls by depth: its upward normal is (east slope, north slope, 1) of depth.
  const nx = east_slope * stretch;
  const ny = north_slope * stretch;
  const light = Math.SQRT1_2 * (0.5 * Math.SQRT2 * (ny - nx) + 1);
  return light / Math.hypot(nx, ny, 1) / Math.SQRT1_2;
}

export function seabedPicture(tile: TerrainTile, range: DepthRange, stretch: number, dark: boolean): DataTexture {
  const fine = Math.max(1, Math.min(8, Math.floor(768 / Math.max(tile.rows, tile.columns))));
  const height = (tile.rows - 1) * fine;
  const width = (tile.columns - 1) * fine;
  const pixels = new Uint8Array(4 * width * height);
  const step = tile.spacing_m;
  const span = range.high - range.low;
  const depth = (i: number, j: number) =>
    depthAt(
      tile,
      tile.south_m + (step * Math.min(Math.max(i, 0), height)) / fine,
      tile.west_m + (step * Math.min(Math.max(j, 0), width)) / fine,
    );
  const bright = dark ? 0.62 : 1;
  for (let i = 0; i < height; ++i) {
    for (let j = 0; j < width; ++j) {
      const here = depth(i + 0.5, j + 0.5);
      const reach = fine;
      const north = (depth(i + 0.5 + reach, j + 0.5) - depth(i + 0.5 - reach, j + 0.5)) / (2 * step);
      const east = (depth(i + 0.5, j + 0.5 + reach) - depth(i + 0.5, j + 0.5 - reach)) / (2 * step);
      const shade = hillShade(north || 0, east || 0, 2 * stretch);
      const colour = deep(span > 0.5 ? 0.06 + (0.84 * (here - range.low)) / span : 0.42);
      const k = 4 * (i * width + j);
      const light = bright * (0.42 + 0.58 * Math.min(1.5, Math.max(0, shade)));
      for (let c = 0; c < 3; ++c) pixels[k + c] = Math.min(255, colour[c] * light);
      pixels[k + 3] = 255;
    }
  }
  const texture = new DataTexture(pixels, width, height, RGBAFormat);
  texture.colorSpace = SRGBColorSpace;
  texture.magFilter = LinearFilter;
  texture.minFilter = LinearMipmapLinearFilter;
  texture.generateMipmaps = true;
  texture.needsUpdate = true;
  return texture;
}

export interface Contours {
  interval_m: number;
  /** Pairs of places, north, east, depth. */
  segments: Float32Array;
  labels: { north_m: number; east_m: number; depth_m: number }[];
}

export function contourLines(tile: TerrainTile, range: DepthRange): Contours {
  const interval_m = roundStep(Math.max(0.1, (range.high - range.low) / 9));
  const levels: number[] = [];
  for (let level = Math.ceil(range.low / interval_m) * interval_m; level < range.high; level += interval_m) levels.push(level);
  const segments: number[] = [];
  const labels: Contours["labels"] = [];
  const north = (y: number) => tile.south_m + (y - 0.5) * tile.spacing_m;
  const east = (x: number) => tile.west_m + (x - 0.5) * tile.spacing_m;
  const edge = (x: number, y: number) => x < 0.6 || y < 0.6 || x > tile.columns - 0.6 || y > tile.rows - 0.6;
  const shapes = contours().size([tile.columns, tile.rows]).thresholds(levels)(Array.from(tile.depth_m));
  for (const { value, coordinates } of shapes) {
    for (const ring of coordinates.flat()) {
      for (let i = 0; i + 1 < ring.length; ++i) {
        const [x0, y0] = ring[i];
        const [x1, y1] = ring[i + 1];
        if (edge(x0, y0) && edge(x1, y1)) continue; // the border of the tile is no contour
        segments.push(north(y0), east(x0), value, north(y1), east(x1), value);
      }
      const spacing = Math.max(40, Math.floor(ring.length / 3));
      for (let i = Math.floor(spacing / 2); i < ring.length && ring.length > 24; i += spacing) {
        const [x, y] = ring[i];
        if (!edge(x, y)) labels.push({ north_m: north(y), east_m: east(x), depth_m: value });
      }
    }
  }
  return { interval_m, segments: new Float32Array(segments), labels };
}
