// SPDX-License-Identifier: BSD-3-Clause
// The part of the URL after #: view, instant and selection, so that a link shows what its sender saw.
//
//   #time-line?t=61.2&vehicle=auv-1&packet=1.17.3.0&at=auv-2&link=auv-1~auv-2&column=snr_db

export const VIEWS = ["chart", "section", "matrix", "time-line", "vehicle"] as const;
export type View = (typeof VIEWS)[number];

export interface Address {
  view: View;
  /** Simulation time, seconds; null: wherever the source is. */
  time_s: number | null;
  /** Vehicles by name. */
  vehicle: string | null;
  packet: string | null;
  /** The receiver whose reception of the packet is shown. */
  at: string | null;
  link: [string, string] | null;
  column: string | null;
}

export function readAddress(hash: string): Address {
  const [name, query = ""] = hash.replace(/^#/, "").split("?");
  const values = new URLSearchParams(query);
  const ends = values.get("link")?.split("~");
  const time = values.get("t");
  return {
    view: VIEWS.find((view) => view === name) ?? "chart",
    time_s: time !== null && time !== "" && Number.isFinite(Number(time)) ? Number(time) : null,
    vehicle: values.get("vehicle"),
    packet: values.get("packet"),
    at: values.get("at"),
    link: ends && ends.length === 2 && ends[0] && ends[1] ? [ends[0], ends[1]] : null,
    column: values.get("column"),
  };
}

export function writeAddress(address: Address): string {
  const values = new URLSearchParams();
  if (address.time_s !== null) values.set("t", String(Math.round(address.time_s * 10) / 10));
  if (address.vehicle) values.set("vehicle", address.vehicle);
  if (address.packet) values.set("packet", address.packet);
  if (address.packet && address.at) values.set("at", address.at);
  if (address.link) values.set("link", address.link.join("~"));
  if (address.column) values.set("column", address.column);
  const query = values.toString();
  return `#${address.view}${query ? `?${query}` : ""}`;
}
