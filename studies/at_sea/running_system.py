# SPDX-License-Identifier: BSD-3-Clause
"""Travel times by the running system: the track and the pings on the bus, through a channel server."""
import csv
import itertools
import math
import pathlib
import statistics
import struct
import sys

from at_sea.predictions import BELOW_TRANSPONDER_M, run, through_bottom

LCM_TYPES = pathlib.Path(__file__).resolve().parents[2] / "lcmtypes"
TURNAROUND_S = 0.1  # of every modem in Halocline (docs/packets.md)
MIN_PING_S = 0.01
MAX_ROWS = 1500  # of a profile on the bus, which may have 2000
MAX_PAUSE_S = 60.0  # between shots; longer pauses of a survey are shortened
LEAD_S = 2  # a state of the ship before each ping, so old that link tables know the place
SCENARIO = """[scenario]
name = "at_sea"
duration_s = {duration_s!r}
[terrain]
kind = "flat"
center_north_m = {north_m!r}
center_east_m = {east_m!r}
size_north_m = {size_m!r}
size_east_m = {size_m!r}
spacing_m = {spacing_m!r}
[terrain.flat]
depth_m = {bottom_m!r}
[environment]
profile = "speed-table"
speed_depths_m = {depths}
speeds_mps = {speeds}
[propagation]
max_bounces = 0
speed_tolerance_mps = 0.0
reuse_distance_m = 0.0
[modem]
source_level_db = 220.0
cutoff_level_db = -200.0
center_frequency_hz = 12000.0
packet_overhead_s = {ping_s!r}
error_model = "none"
[channel_server]
state_timeout_s = 3600.0
[[vehicle]]
name = "ship"
id = 1
model = "external"
[[vehicle]]
name = "transponder"
id = 2
model = "external"
"""


def without_overlaps(rows):
    """Of (shot, ...) those that end before the next begins: a modem has one ping under way."""
    kept, free_s = [], -math.inf
    for row in rows:
        shot = row[0]
        if shot.at_s >= free_s:
            kept.append(row)
            free_s = shot.at_s + shot.two_way_s + max(shot.waited_s, TURNAROUND_S + MIN_PING_S) + LEAD_S + 1
    return kept


class Log:
    """An LCM log: what the two vehicles publish, each message at its utime."""

    def __init__(self, types):
        self.types, self.events = types, []

    def publish(self, channel, message):
        self.events.append((message.utime, channel, message.encode()))

    def state(self, name, vehicle, utime, place, velocity):
        state = self.types.vehicle_state_t()
        state.utime, state.vehicle_id = utime, vehicle
        state.position_ned_m, state.velocity_ned_mps = place, velocity
        state.orientation_wxyz = [1.0, 0.0, 0.0, 0.0]
        self.publish("STATE." + name, state)

    def ping(self, utime, number):
        send = self.types.modem_send_t()
        send.utime, send.session, send.packet_sequence = utime, 1, number
        send.source_id, send.destination_id, send.packet_kind, send.payload = 1, 2, send.PING, b""
        self.publish("SEND.ship", send)

    def write(self, path):
        with open(path, "wb") as file:
            for number, (utime, channel, data) in enumerate(sorted(self.events, key=lambda event: event[0])):
                name = channel.encode()
                file.write(struct.pack(">Iqqii", 0xEDA1DA01, number, utime, len(name), len(data)) + name + data)


def write_track(path, types, survey, shots, place, ping_s):
    """One state a shot, from which the ship goes on steadily: it is where it transmitted and where it received at those instants.
    The answer leaves when the ping's duration and the turnaround have passed; the ping is made to last as long as the survey's
    transponder waits, so far as that is possible. Returns the end, s."""
    log = Log(types)
    ned = lambda p: [p[1], p[0], survey.depth(p)]
    gaps = [min(b.at_s - a.at_s, MAX_PAUSE_S) for a, b in zip(shots, shots[1:])]
    instants = [round((MAX_PAUSE_S + gone) * 1e6) for gone in itertools.accumulate(gaps, initial=0.0)]
    for number, (shot, utime) in enumerate(zip(shots, instants)):
        away_s = shot.two_way_s + ping_s + TURNAROUND_S
        velocity = [(b - a) / away_s for a, b in zip(ned(shot.sent), ned(shot.received))]
        before = [a - v * LEAD_S for a, v in zip(ned(shot.sent), velocity)]
        log.state("ship", 1, utime - LEAD_S * 1_000_000, before, velocity)
        log.state("transponder", 2, utime - LEAD_S * 1_000_000, ned(place), [0.0] * 3)
        log.ping(utime, number)
    end = instants[-1] + round(MAX_PAUSE_S * 1e6)
    log.state("transponder", 2, end, ned(place), [0.0] * 3)  # the recording ends here
    log.write(path)
    return end * 1e-6


def system_times(halocline, folder, survey, shots, place, types):
    """Two-way times that the ship's modem measured; None where no answer came."""
    ping_s = max(statistics.median(shot.waited_s for shot in shots) - TURNAROUND_S, MIN_PING_S)
    log, scenario, out = folder / "track.lcm", folder / "at_sea.toml", folder / "answers.lcm"
    duration_s = write_track(log, types, survey, shots, place, ping_s)
    bottom_m = survey.depth(place) + BELOW_TRANSPONDER_M
    water = through_bottom(survey.profile, bottom_m)
    water = water[:-1:math.ceil(len(water) / MAX_ROWS)] + water[-1:]
    reach_m = max(math.dist(place[:2], ship[:2]) for shot in shots for ship in (shot.sent, shot.received))
    size_m = 1000.0 * math.ceil(2 * reach_m / 1000 + 2)
    scenario.write_text(SCENARIO.format(
        duration_s=duration_s, north_m=place[1], east_m=place[0], size_m=size_m, spacing_m=size_m / 100, bottom_m=bottom_m,
        depths=[depth for depth, _ in water], speeds=[speed for _, speed in water], ping_s=ping_s))
    run(halocline, "replay", log, "--scenario", scenario, "--log", out, "--no-comparison", "--quiet", "--force")
    run(halocline, "log", "export", out, "--out", folder / "csv", "--channel", r"RECEIVE\.ship", "--force")
    with open(folder / "csv" / "receive.csv") as file:
        answers = {int(row["packet_sequence"]): float(row["two_way_travel_time_s"]) for row in csv.DictReader(file)}
    return [answers.get(number) for number in range(len(shots))]


def message_types(folder):
    run("lcm-gen", "--python", "--ppath", folder, *sorted(LCM_TYPES.glob("*.lcm")))
    sys.path.insert(0, str(folder))
    import halocline as types
    return types
