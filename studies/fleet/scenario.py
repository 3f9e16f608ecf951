# SPDX-License-Identifier: BSD-3-Clause
"""Fleets for the benchmark: as many vehicles as asked, in a coastal sea, all of whom talk."""
import math

SEA = """[scenario]
name = "fleet{count}"
description = "{count} vehicles, {laying}, {model}"
seed = 1
duration_s = {duration_s}

[terrain]
kind = "slope"
size_north_m = {size_m}.0
size_east_m = {size_m}.0
spacing_m = 20.0
[terrain.slope]
depth_m = 150.0
slope = {slope}
azimuth_deg = 30.0
[terrain.relief]
rms_m = 5.0
longest_wavelength_m = 500.0
shortest_wavelength_m = 60.0
seed = 1

[environment]
profile = "water-table"
water_rows = [[0.0, 22.0, 38.0], [15.0, 22.0, 38.0], [30.0, 15.0, 38.0], [50.0, 13.0, 38.0], [200.0, 13.0, 38.0]]

[propagation]
model = "{model}"
{rays}

[modem] # carries 2 km: 9 of 10 packets are received there
profile = "micromodem-fsk"
source_level_db = {source_level_db}

[channel_server]
link_rate_hz = 1.0
{server}
"""

VEHICLE = """
[[vehicle]]
name = "auv-{number}"
id = {number}
start_ned_m = {start}
heading_deg = {heading}
speed_mps = 1.5
[vehicle.mission]
waypoints = [{corners}]
speed_mps = 1.5
at_end = "loop"
[vehicle.traffic]
period_s = 60
start_s = {talks_s}
destination = "all"
payload_bytes = 32
"""

# Along rays the bottom and the surface scatter.
SOURCE_LEVEL_DB = {"straight": 132.0, "rays": 145.0}
# Along rays: how deep the water is, which bounds how far sound gets; energy for paths, and for whole long links, that lie below the
# noise; packets and tables share searches, one a second for two vehicles. What a receiver would acquire once in 1000 packets is left out.
RAYS = """least_depth_m = 75.0
greatest_depth_m = 250.0
diffuse_below_noise_db = 0.0
weak_below_diffuse_db = 0.0
reuse_for_packets = true"""
SERVER = """reach_below_noise_db = 20.0
reach_acquired_once_in = 1000.0
table_range_m = {table_range_m}
max_searches_per_tick = {searches}"""
TABLE_RANGE_M = 4000.0
SEARCHES_PER_VEHICLE = 0.5
DENSE_SIDE_M = 2000
LINE_M = 300.0


def side_m(laying, count):
    """Of the square: 2 km, or as many square kilometres as vehicles."""
    return DENSE_SIDE_M if laying == "dense" else 1000 * math.sqrt(count)


def vehicle(number, count, side):
    """Runs a square of 300 m, and broadcasts once a minute, one vehicle after the other."""
    # Places and depths spread evenly: multiples of two irrational numbers (Kronecker's sequence).
    north, east = (side * ((number * ratio) % 1 - 0.5) for ratio in (0.7548776662, 0.5698402910))
    depth = 20 + (number * 17) % 70
    corners = [[north + a * LINE_M, east + b * LINE_M, depth] for a, b in ((1, 0), (1, 1), (0, 1), (0, 0))]
    point = lambda place: "[" + ", ".join(f"{value:.1f}" for value in place) + "]"
    return VEHICLE.format(number=number, start=point([north, east, depth]), heading=(number * 47) % 360,
                          corners=", ".join(map(point, corners)), talks_s=f"{60 * number / count:.3f}")


def fleet(count, laying, model, duration_s):
    """The scenario as TOML. `laying`: "dense" (a square of 2 km) or "spread" (a vehicle a square kilometre)."""
    side = side_m(laying, count)
    size = 20 * math.ceil((side + 4 * LINE_M) / 20)
    server = SERVER.format(table_range_m=TABLE_RANGE_M, searches=round(SEARCHES_PER_VEHICLE * count))
    head = SEA.format(count=count, laying=laying, model=model, duration_s=duration_s,
                      rays=RAYS if model == "rays" else "",
                      server=server if model == "rays" else "",
                      size_m=size, source_level_db=SOURCE_LEVEL_DB[model],
                      slope=f"{min(0.02, 60 / size):.5f}")
    return head + "".join(vehicle(number, count, side) for number in range(1, count + 1))
