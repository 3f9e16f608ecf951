// SPDX-License-Identifier: BSD-3-Clause
// The one store: what was received, what is selected, what is shown. Views read it; only it speaks to the server.
import { SvelteMap } from "svelte/reactivity";
import {
  type Asks,
  type Hello,
  type LinkColumn,
  type LinkTable,
  type OutcomeKind,
  type Packet,
  PROTOCOL_VERSION,
  type Run,
  type ServerBinary,
  type ServerState,
  type ServerText,
  type TerrainTile,
  type VehicleFrame,
  type VehicleInfo,
} from "../protocol";
import { type View, readAddress, writeAddress } from "./address";
import { Connection } from "./connection";
import { FrameClock, Instant } from "./frame_clock";
import { PacketBook } from "./packet_book";
import { centred } from "../parts/scales";

export type Theme = "auto" | "light" | "dark";
/** Simulation seconds a step of the arrow keys moves, alone and with Shift. */
const STEP_S = 1;
const LONG_STEP_S = 10;
/** Packets are asked for in pieces of this length, seconds. */
const CHUNK_S = 120;
/** So far ahead or back the next packet is looked for. */
const MOST_CHUNKS = 64;
const UNKNOWN_OUTCOME: OutcomeKind = {
  code: -2,
  name: "UNKNOWN",
  label: "unknown",
  class: "no_path",
  mark: "dash",
  colour: "#8c8c8c",
};

export class Monitor {
  // --- what the server sent
  link_state = $state<"connecting" | "open" | "closed" | "incompatible">("connecting");
  /** Wall time of the next attempt to connect, milliseconds. */
  retry_at = $state(0);
  hello = $state.raw<Hello | null>(null);
  run = $state.raw<Run | null>(null);
  state = $state.raw<ServerState | null>(null);
  terrain = $state.raw<TerrainTile | null>(null);
  terrain_problem = $state<string | null>(null);
  /** By column. */
  links = new SvelteMap<string, LinkTable>();
  /** Grows whenever packets came. */
  packets_revision = $state(0);
  /** Grows at a jump in time. */
  jumps = $state(0);
  /** What is shown now, for texts: a few times a second. Drawing reads `instant`. */
  now_s = $state(0);
  /** Grows whenever `instant` changed, as often as texts. */
  revision = $state(0);
  problem = $state<string | null>(null);

  readonly packets = new PacketBook();
  readonly clock = new FrameClock();
  readonly instant = new Instant();
  shown_s = 0;

  // --- what is shown
  view = $state<View>("chart");
  vehicle = $state<number | null>(null);
  packet = $state<string | null>(null);
  receiver = $state<number | null>(null);
  link = $state.raw<[number, number] | null>(null);
  /** The panel of the link stands beside the view. */
  link_open = $state(false);
  column = $state("snr_db");
  theme = $state<Theme>((localStorage.getItem("theme") as Theme | null) ?? "auto");
  dark = $state(false);
  help = $state(false);
  /** The instant under the pointer of a plot: all plots mark it. */
  pointed_s = $state<number | null>(null);
  /** A quiet line: what is left out of the drawing, and why. */
  shed = $state<string | null>(null);

  private connection: Connection;
  private fetched = new Set<number>();
  private ticked: VehicleFrame | null = null;
  private wanted = readAddress(location.hash);
  private place_pending = true;
  /** Seeks without an answer; whether the first frame after the last of them is still to come. Until then frames are of before. */
  private seeking = 0;
  private landing = false;
  private written = "";
  private prefersDark = matchMedia("(prefers-color-scheme: dark)");

  vehicles = $derived<VehicleInfo[]>(this.run?.vehicles ?? []);
  outcome_kinds = $derived(new Map((this.hello?.outcomes ?? []).map((kind) => [kind.code, kind])));
  threshold_db = $derived(this.run?.threshold_db ?? null);
  columns = $derived<LinkColumn[]>((this.hello?.link_columns ?? []).map((column) => centred(column, this.threshold_db)));
  link_column = $derived<LinkColumn | undefined>(this.columns.find(({ key }) => key === this.column) ?? this.columns[0]);
  table = $derived<LinkTable | undefined>(this.link_column && this.links.get(this.link_column.key));
  begin_s = $derived(this.state?.begin_s ?? this.hello?.begin_s ?? 0);
  end_s = $derived(Math.max(this.state?.end_s ?? 0, this.hello?.end_s ?? 0));
  playing = $derived(Boolean(this.state?.playing || this.state?.live));
  /** The pair that section and history show: the one chosen, else one that the other selections suggest. */
  pair = $derived.by<[number, number] | null>(() => {
    const n = this.vehicles.length;
    if (this.link && this.link[0] < n && this.link[1] < n) return this.link;
    if (n < 2) return null;
    const from = this.vehicle ?? 0;
    return [from, from === 0 ? 1 : 0];
  });

  constructor() {
    this.view = this.wanted.view;
    if (this.wanted.column) this.column = this.wanted.column;
    const url = new URL("ws", location.href);
    url.protocol = location.protocol === "https:" ? "wss:" : "ws:";
    url.hash = "";
    const token = new URLSearchParams(location.search).get("token");
    url.search = token ? `?token=${encodeURIComponent(token)}` : "";
    this.connection = new Connection(url.href, {
      opened: () => {
        this.link_state = "open";
      },
      closed: (pause_ms) => {
        this.link_state = "closed";
        this.retry_at = performance.now() + pause_ms;
      },
      text: (message) => this.receive(message),
      binary: (message) => this.receiveBinary(message),
    });
    addEventListener("hashchange", () => {
      if (location.hash === this.written) return;
      this.wanted = readAddress(location.hash);
      this.view = this.wanted.view;
      this.place_pending = true;
      this.goToWanted();
    });
    this.prefersDark.addEventListener("change", () => this.applyTheme());
    this.applyTheme();
  }

  // --- requests

  ask<Name extends keyof Asks>(name: Name, more: Asks[Name][0]): Promise<Asks[Name][1]> {
    return this.connection.ask(name, more);
  }
  /** A request of which only the refusal matters; whether it was accepted. */
  private async order<Name extends keyof Asks>(name: Name, more: Asks[Name][0]): Promise<boolean> {
    this.problem = null;
    try {
      await this.ask(name, more);
      return true;
    } catch (error) {
      this.problem = (error as Error).message;
      return false;
    }
  }
  retryNow() {
    this.connection.retryNow();
  }

  toggle() {
    this.order(this.state?.playing || this.state?.live ? "pause" : "play", {});
  }
  setSpeed(x: number) {
    this.order("speed", { x });
  }
  goLive() {
    this.order("live", {});
  }
  /** A connection begins at the beginning of a log: this one goes on where the last one was. */
  private resume() {
    const { playing, speed } = this.state ?? { playing: false, speed: 1 };
    this.seek(this.now_s);
    this.setSpeed(speed);
    if (playing) this.order("play", {});
  }
  async seek(time_s: number) {
    const within = Math.min(this.end_s, Math.max(this.begin_s, time_s));
    this.now_s = within;
    ++this.seeking;
    const accepted = await this.order("seek", { time_s: within });
    if (--this.seeking > 0) return;
    this.landing = accepted;
    if (!accepted) this.now_s = this.shown_s;
  }
  step(direction: 1 | -1, long: boolean) {
    this.seek(this.now_s + direction * (long ? LONG_STEP_S : STEP_S));
  }
  chooseColumn(key: string) {
    this.column = key;
    this.watch();
  }
  private watch() {
    if (this.link_column) this.ask("watch", { columns: [this.link_column.key] }).catch(() => {});
  }
  private fetchTerrain() {
    this.ask("terrain", {}).then(
      () => {
        this.terrain_problem = null;
      },
      (error: Error) => {
        this.terrain_problem = error.message;
      },
    );
  }

  // --- selection

  choosePacket(key: string | null, receiver: number | null = null) {
    this.packet = key;
    const packet = key ? this.packets.get(key) : undefined;
    this.receiver = packet ? (receiver ?? this.likelyReceiver(packet)) : null;
    if (packet && this.receiver !== null) this.link = [packet.source, this.receiver];
  }
  /** Whom a packet was for; of a broadcast the first that lost it, else the first. */
  private likelyReceiver(packet: Packet): number | null {
    const at = (receiver: number) => packet.outcomes.find((outcome) => outcome.receiver === receiver);
    if (packet.destination >= 0 && at(packet.destination)) return packet.destination;
    const lost = packet.outcomes.find(({ code }) => this.kindOf(code).class !== "received" && code >= 0);
    return (lost ?? packet.outcomes[0])?.receiver ?? null;
  }
  async nextPacket(step: 1 | -1) {
    const from_s = (this.packet ? this.packets.get(this.packet)?.depart_s : undefined) ?? this.now_s;
    let packet: Packet | undefined;
    for (let chunks = 1; chunks <= MOST_CHUNKS && !packet; chunks *= 4) {
      await this.needPackets(from_s - (step < 0 ? chunks * CHUNK_S : 0), from_s + (step > 0 ? chunks * CHUNK_S : 0));
      packet = this.packets.neighbour(this.packet, this.now_s, step);
    }
    if (!packet) return;
    this.choosePacket(packet.key);
    this.seek(packet.depart_s + Math.min(0.5, packet.duration_s));
  }
  chooseLink(from: number, to: number) {
    this.chooseVehicle(null);
    this.link = [from, to];
    this.link_open = true;
  }
  chooseVehicle(index: number | null) {
    this.vehicle = index;
    this.link_open = false;
    this.packet = null;
    this.receiver = null;
  }
  kindOf(code: number): OutcomeKind {
    return this.outcome_kinds.get(code) ?? UNKNOWN_OUTCOME;
  }
  nameOf(vehicle: number): string {
    return vehicle < 0 ? "all" : (this.vehicles[vehicle]?.name ?? `vehicle ${vehicle}`);
  }

  // --- what comes

  private receive(message: ServerText) {
    switch (message.type) {
      case "hello":
        if (message.version !== PROTOCOL_VERSION) {
          this.link_state = "incompatible";
          this.connection.end();
          return;
        }
        // It may be another run: its packets come again.
        this.packets.clear();
        this.fetched.clear();
        if (message.source === "log" && message.name === this.hello?.name) this.resume();
        this.hello = message;
        document.title = `${message.name.split("?")[0].split("/").pop()} · Halocline`;
        this.watch();
        return;
      case "run":
        if (message.terrain && message.terrain.revision !== this.run?.terrain?.revision) this.fetchTerrain();
        if (!message.terrain) this.terrain = null;
        this.run = message;
        this.goToWanted();
        return;
      case "state": {
        const back = message.bathymetry && this.state?.bathymetry === false;
        this.state = message;
        if (this.run?.terrain && (back || (!this.terrain && message.bathymetry))) this.fetchTerrain();
        return;
      }
      case "packets":
        this.addPackets(message.items);
        return;
      default:
    }
  }

  private receiveBinary(message: ServerBinary) {
    switch (message.kind) {
      case "vehicles":
        if (this.clock.push(message, performance.now(), this.landing)) ++this.jumps;
        this.landing = false;
        return;
      case "terrain":
        this.terrain = message;
        return;
      case "links": {
        const column = this.columns[message.column];
        if (column) this.links.set(column.key, message);
      }
    }
  }

  /** Sees to it that the packets of a window are here, also those that were not pushed. */
  async needPackets(from_s: number, to_s: number) {
    if (this.link_state !== "open") return;
    const answers: Promise<void>[] = [];
    const last = Math.floor(Math.min(to_s, this.end_s) / CHUNK_S);
    for (let chunk = Math.max(0, Math.floor(from_s / CHUNK_S)); chunk <= last; ++chunk) {
      if (this.fetched.has(chunk)) continue;
      this.fetched.add(chunk);
      answers.push(
        this.ask("packets", { from_s: chunk * CHUNK_S, to_s: (chunk + 1) * CHUNK_S }).then(
          ({ items }) => this.addPackets(items),
          () => {
            this.fetched.delete(chunk);
          },
        ),
      );
    }
    await Promise.all(answers);
  }

  private addPackets(items: Packet[]) {
    this.packets.add(items);
    ++this.packets_revision;
    if (this.packet && this.receiver === null && this.packets.get(this.packet)) this.choosePacket(this.packet);
  }

  /** Texts follow what is drawn. */
  tick() {
    const before = this.shown_s;
    const frame = this.clock.newest;
    this.advance(performance.now());
    if (!frame || this.seeking > 0 || this.landing || (frame === this.ticked && before === this.shown_s && this.now_s === before)) return;
    this.ticked = frame;
    this.now_s = this.shown_s;
    ++this.revision;
  }

  /** Brings `instant` to what is to be seen now. Called once a drawn frame. */
  advance(now_ms: number) {
    const shown = this.clock.at(now_ms);
    if (!shown) return;
    this.shown_s = shown.time_s;
    this.instant.fill(shown, this.vehicles.length);
  }

  // --- the URL

  private goToWanted() {
    if (!this.place_pending || !this.run) return;
    const index = (name: string | null) => {
      const at = this.vehicles.findIndex((vehicle) => vehicle.name === name);
      return at < 0 ? null : at;
    };
    const { time_s, vehicle, packet, at, link, column } = this.wanted;
    this.vehicle = index(vehicle);
    if (column) this.chooseColumn(column);
    if (link) {
      const [from, to] = link.map(index);
      if (from !== null && to !== null) {
        this.link = [from, to];
        this.link_open = true;
      }
    }
    this.place_pending = false;
    if (packet) {
      this.packet = packet;
      this.receiver = index(at);
    }
    if (time_s !== null) this.seek(time_s);
  }

  /** Keeps the URL as what is seen. */
  writeUrl() {
    if (this.place_pending) return;
    const [from, to] = (this.link_open || this.view === "section" || this.view === "matrix" ? this.link : null) ?? [null, null];
    this.written = writeAddress({
      view: this.view,
      time_s: this.state?.live ? null : this.now_s,
      vehicle: this.vehicle === null ? null : this.nameOf(this.vehicle),
      packet: this.packet,
      at: this.receiver === null ? null : this.nameOf(this.receiver),
      link: from === null || to === null ? null : [this.nameOf(from), this.nameOf(to)],
      column: this.column,
    });
    if (location.hash !== this.written) history.replaceState(null, "", this.written);
  }

  applyTheme(theme: Theme = this.theme) {
    this.theme = theme;
    localStorage.setItem("theme", theme);
    this.dark = theme === "dark" || (theme === "auto" && this.prefersDark.matches);
    document.documentElement.dataset.theme = this.dark ? "dark" : "light";
  }
}

export const monitor = new Monitor();
