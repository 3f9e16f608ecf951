// SPDX-License-Identifier: BSD-3-Clause
// What moves on the chart: vehicles, their trails, wavefronts.
import type { Step } from "../parts/shedding";
import type { Packet, VehicleInfo } from "../protocol";
import type { Instant } from "../store/frame_clock";
import type { ChartScene, Clipped, Place } from "./scene";
import type { Trails } from "./trails";

const MOST_WAVES = 16;
const WAVE_POINTS = 96;
/** Trails fade in this many steps. */
const FADES = 4;
const MEDIUM = 9;
const SMALL = 6.5;
/** Vehicles from which on they are drawn smaller. */
const CROWD = 24;
/** Nose, tails and the notch between them: forward and starboard, in radii. */
const DART: [number, number][] = [
  [1.3, 0],
  [-1, 0.75],
  [-0.55, 0],
  [-1, -0.75],
];

/** The part of a closed polygon in front of the camera, on the screen. */
function inFront(scene: ChartScene, polygon: Clipped[]): Place[] {
  const { near } = scene.camera;
  const out: Place[] = [];
  polygon.forEach((a, i) => {
    const b = polygon[(i + 1) % polygon.length];
    if (a.w > near) out.push(scene.onScreen(a));
    if (a.w > near !== b.w > near) {
      const share = (near * 1.001 - a.w) / (b.w - a.w);
      out.push(scene.onScreen({ x: a.x + share * (b.x - a.x), y: a.y + share * (b.y - a.y), w: near * 1.001 }));
    }
  });
  return out;
}

function circle(scene: ChartScene, packet: Packet, radius_m: number): Place[] {
  const polygon: Clipped[] = [];
  for (let i = 0; i < WAVE_POINTS; ++i) {
    const angle = (2 * Math.PI * i) / WAVE_POINTS;
    polygon.push(
      scene.clip(packet.north_m! + radius_m * Math.cos(angle), packet.east_m! + radius_m * Math.sin(angle), packet.down_m!),
    );
  }
  return inFront(scene, polygon);
}

function trace(context: CanvasRenderingContext2D, points: Place[]) {
  points.forEach(({ x, y }, i) => (i ? context.lineTo(x, y) : context.moveTo(x, y)));
  context.closePath();
}

/** Packets under way: the front is a circle at the sender's depth, behind it lies the packet's length in the water. The radii of
 * those drawn, m. */
export function drawWaves(
  context: CanvasRenderingContext2D,
  scene: ChartScene,
  packets: Packet[],
  now_s: number,
  step: Step,
  dark: boolean,
): number[] {
  const radii: number[] = [];
  const colour = dark ? "235 250 255" : "8 36 48";
  for (const packet of packets.slice(-MOST_WAVES)) {
    if (packet.north_m === null || packet.east_m === null || packet.down_m === null) continue;
    const front = (now_s - packet.depart_s) * packet.wave_speed_mps;
    const inner = Math.max(0, front - packet.duration_s * packet.wave_speed_mps);
    const faint = Math.max(0.15, 1 - front / (1.6 * scene.extent_m));
    const points = circle(scene, packet, front);
    if (points.length < 3) continue;
    if (step.waves === "filled") {
      context.beginPath();
      trace(context, points);
      if (inner > 0) trace(context, circle(scene, packet, inner));
      context.fillStyle = `rgb(${colour} / ${(dark ? 0.1 : 0.12) * faint})`;
      context.fill("evenodd");
    }
    context.beginPath();
    trace(context, points);
    context.strokeStyle = `rgb(${colour} / ${0.9 * faint})`;
    context.lineWidth = 1.8;
    context.stroke();
    radii.push(front);
  }
  return radii;
}

export function drawTrails(
  context: CanvasRenderingContext2D,
  scene: ChartScene,
  trails: Trails,
  places: (Place | null)[],
  now_s: number,
  trail_s: number,
  dark: boolean,
) {
  context.lineWidth = 1.3;
  context.lineJoin = "bevel";
  for (let fade = 0; fade < FADES; ++fade) {
    context.strokeStyle = `rgb(${dark ? "255 255 255" : "6 20 28"} / ${0.8 * (1 - fade / FADES)})`;
    context.beginPath();
    const [newest, oldest] = [now_s - (fade * trail_s) / FADES, now_s - ((fade + 1) * trail_s) / FADES];
    places.forEach((place, vehicle) => {
      const trail = trails.of(vehicle);
      if (!place || !trail) return;
      let pen = false;
      if (fade === 0) {
        context.moveTo(place.x, place.y);
        pen = true;
      }
      for (let i = trail.time_s.length - 1; i >= 0; --i) {
        const t = trail.time_s[i];
        if (t > newest + (fade ? 2 : 0)) continue;
        const { x, y, behind } = scene.project(trail.places[3 * i], trail.places[3 * i + 1], trail.places[3 * i + 2]);
        if (behind) pen = false;
        else {
          if (pen) context.lineTo(x, y);
          else context.moveTo(x, y);
          pen = true;
        }
        if (t < oldest) break;
      }
    });
    context.stroke();
  }
}

/** Darts that point where the vehicle heads, diamonds for what stands still. */
export function drawVehicles(
  context: CanvasRenderingContext2D,
  scene: ChartScene,
  instant: Instant,
  vehicles: VehicleInfo[],
  places: (Place | null)[],
  chosen: number | null,
  accent: string,
) {
  const radius = vehicles.length > CROWD ? SMALL : MEDIUM;
  context.lineWidth = vehicles.length > CROWD ? 1.2 : 1.6;
  context.lineJoin = "round";
  context.strokeStyle = "#0c1215";
  for (const { index, fixed } of vehicles) {
    const place = places[index];
    if (!place) continue;
    const size = radius * (index === chosen ? 1.3 : 1);
    context.fillStyle = index === chosen ? accent : instant.flags[index] & 1 ? "#8d979c" : "#ffffff";
    context.beginPath();
    if (fixed) {
      context.rect(place.x - size * 0.62, place.y - size * 0.62, size * 1.24, size * 1.24);
    } else {
      // A flat dart in the water seen by the camera: forward and starboard as they appear on the screen.
      const [n, e, d] = [instant.north(index), instant.east(index), instant.down(index)];
      const step = size * scene.metresAPixel(e, -d * scene.stretch, -n);
      const [sin, cos] = [Math.sin(instant.yaw(index)), Math.cos(instant.yaw(index))];
      const ahead = scene.project(n + step * cos, e + step * sin, d);
      const beside = scene.project(n - step * sin, e + step * cos, d);
      DART.forEach(([forward, starboard], i) => {
        const x = place.x + forward * (ahead.x - place.x) + starboard * (beside.x - place.x);
        const y = place.y + forward * (ahead.y - place.y) + starboard * (beside.y - place.y);
        if (i) context.lineTo(x, y);
        else context.moveTo(x, y);
      });
    }
    context.closePath();
    context.stroke();
    context.fill();
  }
}
