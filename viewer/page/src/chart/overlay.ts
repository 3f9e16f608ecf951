// SPDX-License-Identifier: BSD-3-Clause
// Everything on the chart but the seabed: wavefronts, trails, vehicles (motion.ts), links, plans, receptions with their outcomes, names,
// contour labels, scale bar, north. What is drawn can be pointed at: `things` holds where each lies.
import { distance, number, roundStep } from "../parts/format";
import { drawMark } from "../parts/marks";
import { colourOf, css } from "../parts/scales";
import type { Step } from "../parts/shedding";
import type { LinkColumn, LinkTable, Outcome, OutcomeKind, Packet, VehicleInfo } from "../protocol";
import type { Instant } from "../store/frame_clock";
import { drawTrails, drawVehicles, drawWaves } from "./motion";
import type { ChartScene, Place } from "./scene";
import type { Trails } from "./trails";

/** How long a mark stays after the last bit, seconds of simulation time. */
export const LINGER_S = 3;
/** Vehicles up to which all links, plans and depths are drawn; of more only those of the chosen one. */
const FEW = 8;
/** Marks side by side at one receiver. */
const MOST_STACKED = 4;
const MANY = 24;

export type Thing =
  | { x: number; y: number; kind: "vehicle"; vehicle: number }
  | { x: number; y: number; kind: "outcome"; packet: Packet; outcome: Outcome }
  | { x: number; y: number; kind: "link"; from: number; to: number; value: number };

export interface Drawing {
  scene: ChartScene;
  instant: Instant;
  vehicles: VehicleInfo[];
  now_s: number;
  width: number;
  height: number;
  ratio: number;
  step: Step;
  dark: boolean;
  chosen: number | null;
  packet: string | null;
  link: [number, number] | null;
  /** Packets under way, and those that are being received. */
  waves: Packet[];
  packets: Packet[];
  trails: Trails;
  kindOf(code: number): OutcomeKind;
  column: LinkColumn | undefined;
  table: LinkTable | undefined;
  showLinks: boolean;
  showPlans: boolean;
  accent: string;
}

interface Pen {
  ink: string;
  halo: string;
  quiet: string;
}
const PENS: Record<"light" | "dark", Pen> = {
  light: { ink: "#0c1a20", halo: "rgb(255 255 255 / 0.75)", quiet: "#33434b" },
  dark: { ink: "#f4f8fa", halo: "rgb(6 14 18 / 0.75)", quiet: "#bccad0" },
};

export class Overlay {
  things: Thing[] = [];
  /** Radii of the wavefronts that are drawn, m. */
  fronts: number[] = [];
  private boxes: [number, number, number, number][] = [];
  private context: CanvasRenderingContext2D;

  /** Without a graphics processor the canvas is painted by the processor directly, which is quicker than by emulating one. */
  constructor(
    private canvas: HTMLCanvasElement,
    software: boolean,
  ) {
    this.context = canvas.getContext("2d", { willReadFrequently: software })!;
  }

  draw(drawing: Drawing) {
    const { width, height, ratio } = drawing;
    const [w, h] = [Math.round(width * ratio), Math.round(height * ratio)];
    if (this.canvas.width !== w || this.canvas.height !== h) [this.canvas.width, this.canvas.height] = [w, h];
    const { context } = this;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, width, height);
    this.things = [];
    this.boxes = [];
    const pen = PENS[drawing.dark ? "dark" : "light"];
    const places = drawing.vehicles.map(({ index }) => {
      const { instant, scene } = drawing;
      if (!instant.has(index)) return null;
      const place = scene.project(instant.north(index), instant.east(index), instant.down(index));
      return place.behind ? null : place;
    });
    this.contourLabels(drawing, places, pen);
    this.fronts = drawWaves(context, drawing.scene, drawing.waves, drawing.now_s, drawing.step, drawing.dark);
    drawTrails(context, drawing.scene, drawing.trails, places, drawing.now_s, drawing.step.trail_s, drawing.dark);
    if (drawing.showPlans) this.plans(drawing, pen);
    if (drawing.showLinks) this.links(drawing, places);
    this.dropLines(drawing, places, pen);
    this.receptions(drawing, places, pen);
    drawVehicles(context, drawing.scene, drawing.instant, drawing.vehicles, places, drawing.chosen, drawing.accent);
    this.names(drawing, places, pen);
    this.scaleBar(drawing, pen);
    this.north(drawing, pen);
  }

  /** The nearest thing within reach of a pixel: vehicles and outcomes before links. */
  at(x: number, y: number, reach = 16): Thing | null {
    let best: Thing | null = null;
    let least = reach;
    for (const thing of this.things) {
      const away = Math.hypot(thing.x - x, thing.y - y) + (thing.kind === "link" ? 6 : 0);
      if (away < least) [best, least] = [thing, away];
    }
    return best;
  }

  private free(x: number, y: number, width: number, height: number): boolean {
    const box: [number, number, number, number] = [x, y, x + width, y + height];
    if (this.boxes.some(([a, b, c, d]) => box[0] < c && box[2] > a && box[1] < d && box[3] > b)) return false;
    this.boxes.push(box);
    return true;
  }

  private text(text: string, x: number, y: number, colour: string, halo: string, font: string) {
    const { context } = this;
    context.font = font;
    context.lineJoin = "round";
    context.lineWidth = 3;
    context.strokeStyle = halo;
    context.strokeText(text, x, y);
    context.fillStyle = colour;
    context.fillText(text, x, y);
  }

  private line(points: Place[], colour: string, width: number, dash: number[] = []) {
    if (points.some((point) => point.behind)) return;
    const { context } = this;
    context.beginPath();
    points.forEach(({ x, y }, i) => (i ? context.lineTo(x, y) : context.moveTo(x, y)));
    context.setLineDash(dash);
    context.strokeStyle = colour;
    context.lineWidth = width;
    context.stroke();
    context.setLineDash([]);
  }

  private contourLabels({ scene, width, height }: Drawing, places: (Place | null)[], pen: Pen) {
    this.context.textAlign = "center";
    this.context.textBaseline = "middle";
    const kept: Place[] = [];
    for (const { north_m, east_m, depth_m } of scene.contours?.labels ?? []) {
      const place = scene.project(north_m, east_m, depth_m);
      if (place.behind || place.x < 20 || place.y < 20 || place.x > width - 20 || place.y > height - 20) continue;
      if (kept.some(({ x, y }) => Math.hypot(x - place.x, y - place.y) < 110)) continue;
      // A name stands to the right of its vehicle.
      if (places.some((vehicle) => vehicle && Math.abs(vehicle.x + 40 - place.x) < 75 && Math.abs(vehicle.y - place.y) < 16))
        continue;
      kept.push(place);
      this.text(
        `${number(depth_m, depth_m % 1 ? 1 : 0)} m`,
        place.x,
        place.y,
        pen.quiet,
        pen.halo.replace("0.75", "0.35"),
        "11px system-ui, sans-serif",
      );
    }
  }

  private plans({ scene, vehicles, chosen, accent }: Drawing, pen: Pen) {
    for (const { index, plan } of vehicles) {
      if (!plan || (vehicles.length > FEW && index !== chosen)) continue;
      const places = plan.waypoints.map(([n, e, d]) => scene.project(n, e, d));
      if (plan.at_end === "loop" && places.length > 2) places.push(places[0]);
      const colour = index === chosen ? accent : pen.quiet;
      this.line(places, colour, 1.2, [2, 5]);
      plan.waypoints.forEach((_, i) => {
        const { x, y, behind } = places[i];
        if (behind) return;
        this.context.strokeStyle = colour;
        this.context.lineWidth = i === plan.leg ? 2.5 : 1.2;
        this.context.strokeRect(x - 3, y - 3, 6, 6);
      });
    }
  }

  /** Each half of a link has the colour of what the vehicle beside it receives. */
  private links({ vehicles, table, column, chosen, link, dark }: Drawing, places: (Place | null)[]) {
    if (!table || !column) return;
    for (let k = 0; k < table.value.length; ++k) {
      const [from, to, value] = [table.from[k], table.to[k], table.value[k]];
      const mine = from === chosen || to === chosen;
      const ours = link !== null && from === link[0] && to === link[1];
      if (vehicles.length > FEW && !mine && !ours) continue;
      const a = places[from];
      const b = places[to];
      const colour = colourOf(column, value, dark);
      if (!a || !b || !colour) continue;
      const middle = { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2, behind: false };
      const wide = ours ? 4.5 : mine || chosen === null ? 2.4 : 1.2;
      this.line([middle, b], dark ? "rgb(6 14 18 / 0.5)" : "rgb(255 255 255 / 0.8)", wide + 1.8);
      this.line([middle, b], css(colour), wide);
      this.things.push({ kind: "link", from, to, value, x: 0.3 * a.x + 0.7 * b.x, y: 0.3 * a.y + 0.7 * b.y });
    }
  }

  /** From each vehicle down to the seabed below it. */
  private dropLines({ scene, instant, vehicles, chosen }: Drawing, places: (Place | null)[], pen: Pen) {
    if (vehicles.length > MANY && chosen === null) return;
    for (const { index } of vehicles) {
      const top = places[index];
      if (!top || (vehicles.length > MANY && index !== chosen)) continue;
      const seabed = instant.seabed(index);
      if (Number.isNaN(seabed)) continue;
      const foot = scene.project(instant.north(index), instant.east(index), seabed);
      this.line([top, foot], pen.quiet, 1);
      this.context.fillStyle = pen.quiet;
      this.context.fillRect(foot.x - 2, foot.y - 1, 4, 2);
    }
  }

  /** Where a packet arrives: a line from its sender while its bits come in, and the mark of its outcome. */
  private receptions(drawing: Drawing, places: (Place | null)[], pen: Pen) {
    const { packets, now_s, scene, vehicles, kindOf } = drawing;
    const radius = vehicles.length > MANY ? 5 : 7.5;
    const stacked = new Map<number, number>();
    for (const packet of packets) {
      if (packet.north_m === null || packet.east_m === null || packet.down_m === null) continue;
      const origin = scene.project(packet.north_m, packet.east_m, packet.down_m);
      for (const outcome of packet.outcomes) {
        if (now_s < outcome.arrive_s || now_s > outcome.end_s + LINGER_S) continue;
        const place = places[outcome.receiver];
        if (!place || origin.behind) continue;
        const kind = kindOf(outcome.code);
        if (vehicles.length > MANY && kind.class === "no_path" && packet.key !== drawing.packet) continue;
        const fading = Math.max(0, now_s - outcome.end_s) / LINGER_S;
        const ours = packet.key === drawing.packet;
        this.context.globalAlpha = 1 - 0.85 * fading;
        if (now_s <= outcome.end_s && (vehicles.length <= MANY || ours))
          this.line([origin, place], kind.colour, ours ? 2.5 : 1.5, kind.class === "received" ? [] : [6, 5]);
        const above = stacked.get(outcome.receiver) ?? 0;
        if (above < MOST_STACKED) {
          stacked.set(outcome.receiver, above + 1);
          const [x, y] = [place.x + 2.4 * radius * above, place.y - 14 - radius];
          drawMark(this.context, kind.mark, x, y, radius * (ours ? 1.35 : 1), kind.colour, pen.halo);
          this.things.push({ kind: "outcome", x, y, packet, outcome });
        }
        this.context.globalAlpha = 1;
      }
    }
  }

  /** To the right of each vehicle; where that is beyond the edge, to its left. */
  private names({ vehicles, instant, chosen, step, width: edge }: Drawing, places: (Place | null)[], pen: Pen) {
    this.context.textAlign = "left";
    this.context.textBaseline = "middle";
    const order = [...vehicles].sort((a, b) => Number(b.index === chosen) - Number(a.index === chosen));
    for (const { index, name } of order) {
      const place = places[index];
      if (!place) continue;
      this.things.push({ kind: "vehicle", vehicle: index, x: place.x, y: place.y });
      if (step.names === "chosen" && index !== chosen && vehicles.length > FEW) continue;
      const few = vehicles.length <= MANY || index === chosen;
      const depth = few ? ` ${number(instant.down(index), 0)} m` : "";
      const font = `${index === chosen ? 600 : 500} 13px system-ui, sans-serif`;
      this.context.font = font;
      const width = this.context.measureText(name).width;
      const whole = width + (few ? 40 : 0);
      const x = place.x + 15 + whole > edge ? place.x - 15 - whole : place.x + 15;
      const y = place.y + 1;
      if (!this.free(x, y - 8, whole, 16) && index !== chosen) continue;
      this.text(name, x, y, pen.ink, pen.halo, font);
      if (depth) this.text(depth, x + width, y, pen.quiet, pen.halo, "12px system-ui, sans-serif");
    }
  }

  private scaleBar({ scene, height }: Drawing, pen: Pen) {
    const { x, y, z } = scene.controls.target;
    const pixel = scene.metresAPixel(x, y, z);
    const length = roundStep(70 * pixel);
    const [left, base] = [18, height - 20];
    const { context } = this;
    context.strokeStyle = pen.halo;
    context.lineWidth = 4;
    const path = new Path2D(`M${left} ${base - 5}V${base}H${left + length / pixel}V${base - 5}`);
    context.stroke(path);
    context.strokeStyle = pen.ink;
    context.lineWidth = 1.5;
    context.stroke(path);
    context.textAlign = "left";
    context.textBaseline = "alphabetic";
    const stretched = scene.stretch > 1 ? `, depth \u00d7 ${scene.stretch}` : "";
    this.text(`${distance(length)}${stretched}`, left + 5, base - 6, pen.ink, pen.halo, "12px system-ui, sans-serif");
  }

  private north({ scene, width }: Drawing, pen: Pen) {
    const { context } = this;
    const angle = scene.controls.getAzimuthalAngle();
    const [x, y] = [width - 30, 34];
    context.save();
    context.translate(x, y);
    context.rotate(angle);
    const path = new Path2D("M0 -16L6 12L0 7L-6 12Z");
    context.strokeStyle = pen.halo;
    context.lineWidth = 3;
    context.stroke(path);
    context.fillStyle = pen.ink;
    context.fill(path);
    context.textAlign = "center";
    context.textBaseline = "alphabetic";
    this.text("N", 0, -19, pen.ink, pen.halo, "600 12px system-ui, sans-serif");
    context.restore();
  }
}
