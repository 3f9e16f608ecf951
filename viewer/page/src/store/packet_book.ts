// SPDX-License-Identifier: BSD-3-Clause
// The packets that were received from the server, in the order of their departure.
import type { Packet } from "../protocol";

const MOST = 40_000;

export class PacketBook {
  private byKey = new Map<string, Packet>();
  private sorted: Packet[] = [];

  get size() {
    return this.sorted.length;
  }

  add(items: Packet[]) {
    for (const item of items) this.byKey.set(item.key, item);
    this.sorted = [...this.byKey.values()].sort((a, b) => a.depart_s - b.depart_s || (a.key < b.key ? -1 : 1));
    while (this.sorted.length > MOST) this.byKey.delete(this.sorted.shift()!.key);
  }

  clear() {
    this.byKey.clear();
    this.sorted = [];
  }

  get(key: string): Packet | undefined {
    return this.byKey.get(key);
  }

  /** Index of the first that departs at time_s or later. */
  firstFrom(time_s: number): number {
    let low = 0;
    let high = this.sorted.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.sorted[middle].depart_s < time_s) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  /** Those that depart in [from_s, to_s]. */
  between(from_s: number, to_s: number): Packet[] {
    const first = this.firstFrom(from_s);
    let end = first;
    while (end < this.sorted.length && this.sorted[end].depart_s <= to_s) ++end;
    return this.sorted.slice(first, end);
  }

  /** The neighbour of a packet, or of an instant, in the order of departure. */
  neighbour(key: string | null, time_s: number, step: 1 | -1): Packet | undefined {
    const at = key ? this.sorted.findIndex((packet) => packet.key === key) : -1;
    if (at >= 0) return this.sorted[at + step];
    const first = this.firstFrom(time_s);
    return this.sorted[step > 0 ? first : first - 1];
  }
}
