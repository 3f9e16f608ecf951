// SPDX-License-Identifier: BSD-3-Clause
// The time line of packets on a canvas: a lane a vehicle, what it sends above, what arrives at it below. `hits` holds what lies where.
import type { Outcome, OutcomeKind, Packet, VehicleInfo } from "../protocol";
import { clock } from "./format";
import { drawMark } from "./marks";
import { type Axis, digitsOf } from "./scales";

/** Pixels left of the lanes, for names, and above them, for instants. */
export const NAMES = 84;
export const AXIS = 24;
/** Receptions at once in a lane that are drawn apart. */
const ROWS = 3;
/** Up to so many vehicles the travel of every packet is drawn, else of the chosen one. */
const FEW = 6;
const FONT = "12px system-ui, sans-serif";

export interface Hit {
  x0: number;
  x1: number;
  y0: number;
  y1: number;
  packet: Packet;
  /** Null: the packet as it is sent. */
  outcome: Outcome | null;
}

export interface Colours {
  ink: string;
  quiet: string;
  line: string;
  accent: string;
  sheet: string;
  paper: string;
}

export interface LanesDrawing {
  width: number;
  height: number;
  /** Height of a lane, pixels. */
  lane: number;
  x: Axis;
  ticks: number[];
  vehicles: VehicleInfo[];
  packets: Packet[];
  now_s: number;
  vehicle: number | null;
  packet: string | null;
  receiver: number | null;
  kindOf(code: number): OutcomeKind;
  colours: Colours;
}

export class Lanes {
  hits: Hit[] = [];
  private hatches = new Map<string, CanvasPattern | null>();
  /** By vehicle: up to which pixel each row of its receptions is taken. */
  private busy: number[][] = [];

  constructor(private context: CanvasRenderingContext2D) {}

  draw(drawing: LanesDrawing) {
    const { context } = this;
    const { width, height, vehicles, packets } = drawing;
    this.hits = [];
    this.busy = vehicles.map(() => []);
    context.clearRect(0, 0, width, height);
    context.font = FONT;
    context.textBaseline = "middle";
    this.rules(drawing);
    this.names(drawing);
    context.save();
    context.beginPath();
    context.rect(NAMES, 0, width - NAMES, height);
    context.clip();
    for (const packet of packets) if (vehicles.length <= FEW || packet.key === drawing.packet) this.travel(drawing, packet);
    for (const packet of packets) {
      this.sending(drawing, packet);
      for (const outcome of packet.outcomes) this.reception(drawing, packet, outcome);
    }
    this.now(drawing);
    context.restore();
  }

  at(x: number, y: number): Hit | null {
    return this.hits.findLast((hit) => x >= hit.x0 && x <= hit.x1 && y >= hit.y0 && y <= hit.y1) ?? null;
  }

  private rules({ ticks, x, height, colours }: LanesDrawing) {
    const { context } = this;
    const digits = digitsOf(ticks);
    context.strokeStyle = colours.line;
    context.lineWidth = 1;
    context.fillStyle = colours.quiet;
    context.textAlign = "center";
    for (const tick of ticks) {
      this.vertical(x(tick), AXIS - 4, height);
      context.fillText(clock(tick, digits), x(tick), 9);
    }
  }

  private names({ vehicles, lane, width, vehicle, colours }: LanesDrawing) {
    const { context } = this;
    context.textAlign = "right";
    for (const { name, index } of vehicles) {
      const top = AXIS + lane * index;
      if (index % 2) {
        context.fillStyle = colours.sheet;
        context.globalAlpha = 0.6;
        context.fillRect(0, top, width, lane);
        context.globalAlpha = 1;
      }
      context.fillStyle = index === vehicle ? colours.accent : colours.ink;
      context.fillText(name, NAMES - 8, top + lane / 2, NAMES - 10);
    }
  }

  /** From the departure to each arrival. */
  private travel({ x, lane, colours, packet: chosen }: LanesDrawing, packet: Packet) {
    const { context } = this;
    const ours = packet.key === chosen;
    const sent = this.sentHeight(lane);
    context.strokeStyle = ours ? colours.accent : colours.quiet;
    context.lineWidth = 1;
    context.globalAlpha = ours ? 0.9 : 0.16;
    for (const { receiver, arrive_s } of packet.outcomes) {
      const down = receiver > packet.source;
      context.beginPath();
      context.moveTo(x(packet.depart_s), AXIS + lane * packet.source + (down ? sent + 2 : 2));
      context.lineTo(x(arrive_s), AXIS + lane * receiver + (down ? sent + 4 : lane - 2));
      context.stroke();
    }
    context.globalAlpha = 1;
  }

  private sending({ x, lane, colours, packet: chosen }: LanesDrawing, packet: Packet) {
    const { context } = this;
    const ours = packet.key === chosen;
    const height = this.sentHeight(lane);
    const top = AXIS + lane * packet.source + 2;
    const left = x(packet.depart_s);
    const right = Math.max(left + 2, x(packet.depart_s + packet.duration_s));
    if (packet.duration_s > 0) {
      context.fillStyle = ours ? colours.accent : colours.ink;
      context.globalAlpha = ours ? 1 : 0.78;
      context.beginPath();
      context.roundRect(left, top, right - left, height, 2);
      context.fill();
      context.globalAlpha = 1;
    } else drawMark(context, "cross", left, top + height / 2, 4, colours.quiet);
    this.hits.push({ x0: left - 3, x1: right + 3, y0: top - 2, y1: top + height + 2, packet, outcome: null });
  }

  private reception(drawing: LanesDrawing, packet: Packet, outcome: Outcome) {
    const { context } = this;
    const { x, lane, width, colours } = drawing;
    const left = x(outcome.arrive_s);
    const right = Math.max(left + 3, x(outcome.end_s));
    if (right < NAMES || left > width) return;
    const kind = drawing.kindOf(outcome.code);
    const ours = packet.key === drawing.packet;
    const sent = this.sentHeight(lane);
    const room = Math.max(3, (lane - sent - 5) / ROWS);
    const height = Math.max(2, room - 1.5);
    const top = AXIS + lane * outcome.receiver + sent + 4 + this.freeRow(outcome.receiver, left, right) * room;
    const hatch = kind.class === "collided" && height > 3 ? this.hatching(kind.colour) : null;
    context.globalAlpha = ours ? 1 : kind.class === "received" ? 0.55 : 0.85;
    if (hatch || kind.class === "received") {
      context.fillStyle = hatch ?? kind.colour;
      context.fillRect(left, top, right - left, height);
    }
    if (kind.class !== "received") this.frame(left + 0.5, top + 0.5, right - left - 1, Math.max(1, height - 1), kind.colour, 1);
    context.globalAlpha = 1;
    if (ours) {
      const chosen = outcome.receiver === drawing.receiver;
      this.frame(left - 1, top - 1, right - left + 2, height + 2, chosen ? colours.accent : colours.ink, chosen ? 2.5 : 1);
    }
    const radius = Math.min(6, height * 0.55 + 1);
    if (height >= 4) drawMark(context, kind.mark, Math.max(left, NAMES) + 1, top + height / 2, radius, kind.colour, colours.paper);
    this.hits.push({ x0: left - 5, x1: right + 2, y0: top - 1, y1: top + height + 1, packet, outcome });
  }

  private now({ x, now_s, height, colours }: LanesDrawing) {
    this.context.strokeStyle = colours.accent;
    this.context.lineWidth = 1.5;
    this.vertical(x(now_s), AXIS - 8, height);
  }

  private sentHeight(lane: number): number {
    return Math.max(5, lane * 0.3);
  }

  private freeRow(receiver: number, left: number, right: number): number {
    const rows = (this.busy[receiver] ??= []);
    let row = rows.findIndex((until) => until <= left);
    if (row < 0) row = rows.length < ROWS ? rows.length : rows.indexOf(Math.min(...rows));
    rows[row] = right + 2;
    return row;
  }

  private frame(x: number, y: number, width: number, height: number, colour: string, thick: number) {
    this.context.strokeStyle = colour;
    this.context.lineWidth = thick;
    this.context.strokeRect(x, y, width, height);
  }

  private vertical(x: number, top: number, bottom: number) {
    this.context.beginPath();
    this.context.moveTo(x, top);
    this.context.lineTo(x, bottom);
    this.context.stroke();
  }

  private hatching(colour: string): CanvasPattern | null {
    let pattern = this.hatches.get(colour);
    if (pattern === undefined) {
      const tile = document.createElement("canvas");
      tile.width = tile.height = 6;
      const pen = tile.getContext("2d")!;
      pen.strokeStyle = colour;
      pen.lineWidth = 1.6;
      pen.stroke(new Path2D("M-1 7L7 -1M-4 4L4 -4M2 10L10 2"));
      this.hatches.set(colour, (pattern = this.context.createPattern(tile, "repeat")));
    }
    return pattern;
  }
}
