// SPDX-License-Identifier: BSD-3-Clause
import { describe, expect, it } from "vitest";
import { squareAround } from "../src/chart/framing";
import { depthAt, depthRange, exaggeration } from "../src/chart/seabed";
import { bearing, clock, csv, distance, number, roundStep } from "../src/parts/format";
import { aroundMean, axis, centred, colourOf, digitsOf, inkOn, shareOf, ticks, timeTicks } from "../src/parts/scales";
import { STEPS, Shedding } from "../src/parts/shedding";
import { type LinkColumn, type Packet, type TerrainTile, type VehicleFrame, decodeBinary } from "../src/protocol";
import { type Address, readAddress, writeAddress } from "../src/store/address";
import { pauseBefore } from "../src/store/connection";
import { FrameClock, Instant, turn } from "../src/store/frame_clock";
import { PacketBook } from "../src/store/packet_book";

const snr: LinkColumn = {
  key: "snr_db",
  label: "SNR",
  unit: "dB",
  digits: 1,
  scale: "diverging",
  center: 10,
  low: -10,
  high: 40,
  better: "high",
  help: "",
  categories: [],
};

describe("binary messages", () => {
  it("hold vehicles at an instant, without padding", () => {
    const view = new DataView(new ArrayBuffer(12 + 36));
    view.setUint8(0, 1);
    view.setUint8(1, 1);
    view.setUint16(2, 1, true);
    view.setFloat64(4, 61.25, true);
    view.setUint16(12, 7, true);
    view.setUint16(14, 5, true);
    [100, -200, 30, 1, 0.5, -0.25, 2, NaN].forEach((value, i) => view.setFloat32(16 + 4 * i, value, true));
    const frame = decodeBinary(view.buffer) as VehicleFrame;
    expect(frame.time_s).toBe(61.25);
    expect([frame.vehicle[0], frame.flags[0]]).toEqual([7, 5]);
    expect([...frame.values]).toEqual([100, -200, 30, 1, 0.5, -0.25, 2, NaN]);
  });

  it("hold terrain row by row from the south-west, NaN without a seabed", () => {
    const view = new DataView(new ArrayBuffer(20 + 4 * 6));
    view.setUint8(0, 2);
    view.setUint8(1, 1);
    [2, 3, 9].forEach((value, i) => view.setUint16(2 + 2 * i, value, true));
    [-50, -100, 50, 1, 2, 3, 4, NaN, 6].forEach((value, i) => view.setFloat32(8 + 4 * i, value, true));
    expect(decodeBinary(view.buffer)).toMatchObject({
      kind: "terrain",
      rows: 2,
      columns: 3,
      id: 9,
      south_m: -50,
      west_m: -100,
      spacing_m: 50,
    });
    expect([...(decodeBinary(view.buffer) as TerrainTile).depth_m]).toEqual([1, 2, 3, 4, NaN, 6]);
  });

  it("hold a column of the link table", () => {
    const view = new DataView(new ArrayBuffer(16 + 8));
    view.setUint8(0, 3);
    view.setUint8(1, 1);
    view.setUint16(2, 4, true);
    view.setUint32(4, 1, true);
    view.setFloat64(8, 12, true);
    view.setUint16(16, 1, true);
    view.setUint16(18, 2, true);
    view.setFloat32(20, 8.5, true);
    const table = decodeBinary(view.buffer);
    expect(table).toMatchObject({ kind: "links", column: 4, time_s: 12 });
    expect(table?.kind === "links" && [table.from[0], table.to[0], table.value[0]]).toEqual([1, 2, 8.5]);
  });

  it("are refused when cut short, of another version or of no known kind", () => {
    const view = new DataView(new ArrayBuffer(12 + 36));
    view.setUint8(0, 1);
    view.setUint8(1, 1);
    view.setUint16(2, 2, true);
    expect(decodeBinary(view.buffer)).toBeNull();
    view.setUint16(2, 1, true);
    view.setUint8(1, 2);
    expect(decodeBinary(view.buffer)).toBeNull();
    view.setUint8(1, 1);
    view.setUint8(0, 9);
    expect(decodeBinary(view.buffer)).toBeNull();
    expect(decodeBinary(new ArrayBuffer(3))).toBeNull();
  });
});

describe("the address", () => {
  it("comes back as it was written", () => {
    const address: Address = {
      view: "time-line",
      time_s: 61.2,
      vehicle: "auv-1",
      packet: "1.17.3.0",
      at: "auv 2~x&",
      link: ["auv-1", "auv-2"],
      column: "snr_db",
    };
    expect(readAddress(writeAddress(address))).toEqual(address);
  });
  it("is the chart when nothing, or nonsense, is given", () => {
    const nothing = { view: "chart", time_s: null, vehicle: null, packet: null, at: null, link: null, column: null };
    expect(readAddress("")).toEqual(nothing);
    expect(readAddress("#nowhere?t=soon&link=one")).toEqual(nothing);
  });
});

describe("numbers", () => {
  it("have a true minus, thousands apart, and a dash where there is none", () => {
    expect(number(-3.25, 1)).toBe("\u22123.3");
    expect(number(12345.678, 2)).toBe("12\u202f345.68");
    expect(number(0.00012345, 5)).toBe("0.00012");
    expect(number(-0.01, 1)).toBe("0.0");
    expect(number(NaN)).toBe("–");
  });
  it("of time are minutes and seconds, rounded as a whole", () => {
    expect(clock(59.96)).toBe("1:00.0");
    expect(clock(61.25, 2)).toBe("1:01.25");
    expect(clock(3725, 0)).toBe("1:02:05");
  });
  it("of distance change to kilometres", () =>
    expect([distance(950), distance(1500), distance(2000)]).toEqual(["950 m", "1.5 km", "2 km"]));
  it("of heading lie within 0 and 359", () =>
    expect([-Math.PI / 2, -0.001, 0.001, 7].map(bearing)).toEqual([270, 0, 0, 41]));
  it("are quoted in CSV only where they must be", () =>
    expect(
      csv([
        ["a,b", 1, null],
        ['"', "x", 2],
      ]),
    ).toBe('"a,b",1,\n"""",x,2\n'));
  it("have round steps", () => expect([roundStep(3), roundStep(0.11), roundStep(50), roundStep(70)]).toEqual([5, 0.2, 50, 100]));
});

describe("scales", () => {
  it("put a threshold in the middle whatever the ends are", () => {
    expect([-10, 10, 40, 99].map((value) => shareOf(snr, value))).toEqual([0, 0.5, 1, 1]);
    expect(shareOf({ ...snr, better: "low" }, 40)).toBe(0);
  });
  it("of ratios of signal to noise are centred at what the modems need", () => {
    expect(centred(snr, -4)).toEqual({ ...snr, center: -4, low: -24, high: 26 });
    expect(centred(snr, null)).toBe(snr);
    expect(centred({ ...snr, key: "delivery_probability" }, -4).center).toBe(10);
  });
  it("show nothing where there is no value", () => {
    expect(colourOf(snr, NaN, false)).toBeNull();
    expect(colourOf(snr, 20, false)).toHaveLength(3);
  });
  it("write dark on light and light on dark", () =>
    expect([inkOn([250, 250, 240]), inkOn([10, 20, 60])]).toEqual(["#14191c", "#ffffff"]));
  it("map there and back", () => {
    const x = axis(10, 20, 100, 300);
    expect(x(15)).toBe(200);
    expect(x.invert(200)).toBe(15);
  });
  it("draw courses about north as one line", () => {
    const [a, b] = aroundMean([[359, 1, null], [350]]);
    expect(a.map((value) => value && Math.round(value))).toEqual([-1, 1, null]);
    expect(b[0]).toBeCloseTo(-10);
  });
  it("have round ticks, of time in seconds and minutes that people count in", () => {
    expect(ticks(0, 1, 5)).toEqual([0, 0.2, 0.4, 0.6000000000000001, 0.8, 1]);
    expect([[0, 0.2], [1.8], [2], [0.25], []].map(digitsOf)).toEqual([1, 1, 0, 2, 0]);
    expect(timeTicks(0, 200, 4)).toEqual([0, 60, 120, 180]);
  });
});

describe("the clock of frames", () => {
  const frame = (time_s: number, north: number, yaw = 0): VehicleFrame => ({
    kind: "vehicles",
    time_s,
    n: 1,
    vehicle: new Uint16Array([0]),
    flags: new Uint16Array([0]),
    values: new Float32Array([north, 0, 0, yaw, 0, 0, 1, NaN]),
  });
  it("shows what lies between two frames, and the short way round of angles", () => {
    const frames = new FrameClock();
    frames.push(frame(10, 0, 3), 0);
    expect(frames.push(frame(10.1, 10, -3), 100)).toBe(false);
    const shown = frames.at(150)!;
    expect(shown.share).toBeGreaterThan(0.4);
    const instant = new Instant();
    instant.fill(shown, 2);
    expect(instant.north(0)).toBeCloseTo(10 * shown.share, 3);
    expect(Math.abs(instant.yaw(0))).toBeGreaterThan(3);
    expect(instant.seabed(0)).toBeNaN();
    expect(instant.has(1)).toBe(false);
  });
  it("takes a step back for a jump, without motion in between", () => {
    const frames = new FrameClock();
    frames.push(frame(50, 0), 0);
    expect(frames.push(frame(20, 9), 50)).toBe(true);
    expect(frames.at(51)!.time_s).toBe(20);
  });
  it("turns by less than half a circle", () => expect(turn(3, -3)).toBeCloseTo(2 * Math.PI - 6));
});

describe("packets", () => {
  const packet = (key: string, depart_s: number) => ({ key, depart_s, outcomes: [] }) as unknown as Packet;
  it("are kept in the order of departure, a later version replacing the earlier", () => {
    const book = new PacketBook();
    book.add([packet("b", 2), packet("a", 1)]);
    book.add([{ ...packet("a", 1), bytes: 9 }]);
    expect(book.between(0, 9).map(({ key }) => key)).toEqual(["a", "b"]);
    book.add([packet("c", 3)]);
    expect(book.size).toBe(3);
    expect(book.between(1, 2).map(({ key }) => key)).toEqual(["a", "b"]);
    expect(book.get("a")?.bytes).toBe(9);
  });
  it("have neighbours, of an instant as well", () => {
    const book = new PacketBook();
    book.add([packet("a", 1), packet("b", 2), packet("c", 3)]);
    expect(book.neighbour("b", 0, 1)?.key).toBe("c");
    expect(book.neighbour(null, 2.5, -1)?.key).toBe("b");
    expect(book.neighbour(null, 9, 1)).toBeUndefined();
  });
});

describe("the seabed", () => {
  const tile: TerrainTile = {
    kind: "terrain",
    id: 0,
    south_m: 0,
    west_m: 0,
    spacing_m: 10,
    rows: 2,
    columns: 2,
    depth_m: new Float32Array([10, 20, 30, 40]),
  };
  it("is bilinear between posts and unknown beyond them", () => {
    expect(depthAt(tile, 5, 5)).toBe(25);
    expect(depthAt(tile, 10, 0)).toBe(30);
    expect(depthAt(tile, 11, 0)).toBeNaN();
  });
  it("has a range only where something is known", () => {
    expect(depthRange(tile)).toEqual({ low: 10, high: 40 });
    expect(depthRange({ ...tile, depth_m: new Float32Array([NaN, NaN, NaN, NaN]) })).toBeNull();
  });
  it("is stretched in wide and shallow seas alone", () =>
    expect([exaggeration(8000, 313), exaggeration(1600, 18), exaggeration(1000, 900)]).toEqual([3, 10, 1]));
});

describe("the first view", () => {
  it("holds all places, within the terrain and not much smaller", () => {
    expect(squareAround([[-3000, 3000], [300, -1000]], 8000)).toEqual({ north_m: -1350, east_m: 1000, half_m: 2400 });
    expect(squareAround([[0, 0]], 8000)?.half_m).toBe(480);
    expect(squareAround([[-9000, 0], [9000, 0]], 8000)?.half_m).toBe(4000);
    expect(squareAround([[0, 0]], null)?.half_m).toBe(300);
    expect(squareAround([], 8000)).toBeNull();
  });
});

describe("shedding", () => {
  const run = (shedding: Shedding, from_ms: number, frame_ms: number, seconds: number) => {
    let now = from_ms;
    while (now < from_ms + 1000 * seconds) shedding.frame((now += frame_ms));
    return now;
  };
  it("leaves out more when frames are slow, and says so", () => {
    const shedding = new Shedding(2);
    expect(shedding.sentence()).toBeNull();
    run(shedding, 0, 60, 7);
    expect(shedding.level).toBe(1);
    expect(shedding.sentence()).toContain("draws slowly");
    run(shedding, 7000, 60, 30);
    expect(shedding.level).toBe(STEPS.length - 1);
  });
  it("does not start with pixels where there are none to spare", () => {
    const shedding = new Shedding(1);
    run(shedding, 0, 60, 7);
    expect(shedding.level).toBe(2);
  });
  it("takes it back when frames are quick", () => {
    const shedding = new Shedding(2);
    const now = run(shedding, 0, 60, 7);
    expect(shedding.level).toBe(1);
    run(shedding, now, 16, 10);
    expect(shedding.level).toBe(0);
  });
});

describe("the connection", () => {
  it("is tried again after growing pauses", () => expect([1, 2, 3, 10].map(pauseBefore)).toEqual([500, 1000, 2000, 10000]));
});
