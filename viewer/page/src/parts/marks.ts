// SPDX-License-Identifier: BSD-3-Clause
// The marks of outcomes, alike in every view: as SVG paths in a box of -1..1, drawn on a canvas or in SVG.
import type { Mark } from "../protocol";

interface Shape {
  path: string;
  filled: boolean;
}

export const SHAPES: Record<Mark, Shape> = {
  dot: { path: "M-.8 0a.8 .8 0 1 0 1.6 0a.8 .8 0 1 0 -1.6 0Z", filled: true },
  ring: { path: "M-.75 0a.75 .75 0 1 0 1.5 0a.75 .75 0 1 0 -1.5 0Z", filled: false },
  cross: { path: "M-.75 -.75L.75 .75M-.75 .75L.75 -.75", filled: false },
  bowtie: { path: "M-.95 -.7L.95 .7L.95 -.7L-.95 .7Z", filled: true },
  bar: { path: "M-.3 -.9L.3 -.9L.3 .9L-.3 .9Z", filled: true },
  dash: { path: "M-.9 0L.9 0", filled: false },
};

const paths = new Map<Mark, Path2D>();

/** Draws a mark of this radius (pixels) at a place of a canvas. */
export function drawMark(
  context: CanvasRenderingContext2D,
  mark: Mark,
  x: number,
  y: number,
  radius: number,
  colour: string,
  halo?: string,
) {
  let path = paths.get(mark);
  if (!path) paths.set(mark, (path = new Path2D(SHAPES[mark].path)));
  context.save();
  context.translate(x, y);
  context.scale(radius, radius);
  context.lineCap = "round";
  context.lineJoin = "round";
  if (halo) {
    context.strokeStyle = halo;
    context.lineWidth = (SHAPES[mark].filled ? 2.5 : 5.5) / radius;
    context.stroke(path);
  }
  if (SHAPES[mark].filled) {
    context.fillStyle = colour;
    context.fill(path);
  } else {
    context.strokeStyle = colour;
    context.lineWidth = 2.2 / radius;
    context.stroke(path);
  }
  context.restore();
}
