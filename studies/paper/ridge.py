# SPDX-License-Identifier: BSD-3-Clause
"""Whether an echo off the bottom is likely (the paper's query GETML) for receivers on both sides of a ridge.

Expected by an evaluation that shares no code with Halocline: straight legs to nine points of the bottom and on to the receiver, 15 log10
of the whole length and Thorp's absorption, compared with the cut-off; a leg is blocked when the bottom stands above it at one of 45 points,
in the middles of equal parts of the way.
"""
import math

from paper.comparison import Comparison, Figure
from paper.runs import vehicle

DEPTH_M, HEIGHT_M, HALF_WIDTH_M, SPACING_M = 200.0, 90.0, 80.0, 5.0
SENDER = (-500.0, 50.0)  # north, depth
SOURCE_LEVEL_DB, CUTOFF_LEVEL_DB = 149.0, 100.0
ECHOES, DEPTHS_PER_ECHO = 9, 5
CLOSE_DB, CLOSE_M = 0.02, 0.2  # what is closer is not compared: the bottom between posts 25 m apart is 0.07 m off at most
RECEIVERS_A_RUN = 60  # each has a link to each other
WATER = f"""
[scenario]
name = "ridge"
duration_s = 3
[terrain]
kind = "ridge"
size_north_m = 1200
size_east_m = 200
spacing_m = {SPACING_M}
[terrain.ridge]
depth_m = {DEPTH_M}
height_m = {HEIGHT_M}
half_width_m = {HALF_WIDTH_M}
azimuth_deg = 90
[environment]
profile = "isovelocity"
absorption_model = "thorp"
wind_mps = 0
spreading_exponent = 1.5
[propagation]
model = "straight"
fading = "none"
[modem]
center_frequency_hz = 25000
bandwidth_hz = 5000
source_level_db = {SOURCE_LEVEL_DB}
cutoff_level_db = {CUTOFF_LEVEL_DB}
"""
ABSORPTION_DB_PER_KM = 1.0936 * (0.1 * 625 / 626 + 40 * 625 / 4725)  # Thorp 1967 at 25 kHz


def post_m(i):
    """Depth of the bottom at north = i * SPACING_M."""
    return DEPTH_M - HEIGHT_M * math.exp(-0.5 * (i * SPACING_M / HALF_WIDTH_M) ** 2)


def bottom_m(north_m):
    """Straight between posts."""
    i = math.floor(north_m / SPACING_M)
    share = north_m / SPACING_M - i
    return (1 - share) * post_m(i) + share * post_m(i + 1)


def clearance_m(end, point, bottom):
    """Of the leg between an end and a point of the bottom, over the other points of the bottom between them."""
    first, last = sorted((end[0], point[0]))
    return min((depth - (end[1] + (point[1] - end[1]) * (north - end[0]) / (point[0] - end[0]))
                for north, depth in bottom if first < north < last), default=math.inf)


def expected(receiver):
    """1: likely, 0: unlikely, None: too close to tell."""
    count = ECHOES * DEPTHS_PER_ECHO
    norths = [SENDER[0] + (receiver[0] - SENDER[0]) * (i + 0.5) / count for i in range(count)]
    bottom = [(north, bottom_m(north)) for north in norths]
    likely = close = False
    for point in bottom[DEPTHS_PER_ECHO // 2::DEPTHS_PER_ECHO]:
        length_m = math.dist(SENDER, point) + math.dist(point, receiver)
        excess_db = SOURCE_LEVEL_DB - 15 * math.log10(length_m) - ABSORPTION_DB_PER_KM * length_m / 1000 - CUTOFF_LEVEL_DB
        free_m = min(clearance_m(end, point, bottom) for end in (SENDER, receiver))
        likely |= free_m > CLOSE_M and excess_db > CLOSE_DB
        close |= excess_db > -CLOSE_DB and free_m > -CLOSE_M
    return 1 if likely else None if close else 0


def likelihood_over_ridge(runs):
    places = [(float(north), float(depth)) for north in range(-475, 501, 25) for depth in range(10, 200, 10)
              if depth < bottom_m(north) - 2]
    got = []
    for first in range(0, len(places), RECEIVERS_A_RUN):
        part = places[first:first + RECEIVERS_A_RUN]
        scenario = WATER + vehicle(1, *SENDER) + "".join(vehicle(2 + i, *place) for i, place in enumerate(part))
        links = runs.links(f"ridge-{first}", scenario)
        got += [int(links[1, 2 + i]["multipath"]) for i in range(len(part))]
    wanted = [expected(place) for place in places]
    compared = [(want, have) for want, have in zip(wanted, got) if want is not None]
    comparisons = [
        Comparison("ridge", f"places that differ, of {len(compared)}", 0, sum(want != have for want, have in compared), 0),
        Comparison("ridge", "places where an echo is likely", sum(want for want, _ in compared), sum(have for _, have in compared), 0)]
    return Figure("ridge", ("north_m", "depth_m", "likely"), [(*place, have) for place, have in zip(places, got)], [], comparisons)
