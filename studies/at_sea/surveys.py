# SPDX-License-Identifier: BSD-3-Clause
"""Surveys at sea as files hold them. Places are east, north, up, in metres."""
import collections
import dataclasses
import math
import pathlib
import statistics
import sys

MIN_SHOTS = 8  # of a transponder: three numbers are fitted to half of them


class Refusal(Exception):
    """What is wrong with a file or an option, and what is allowed."""


@dataclasses.dataclass
class Shot:
    transponder: str
    at_s: float
    two_way_s: float
    waited_s: float  # by the transponder, before it answered
    sent: tuple
    received: tuple


@dataclasses.dataclass
class Survey:
    name: str
    shots: list
    profile: list = None  # (depth m, speed m/s), rising; None: unknown
    guesses: dict = dataclasses.field(default_factory=dict)  # of places, where the survey has them
    speed_given: float = 0  # m/s, of every depth; 0: none
    surface_up_m: float = 0
    places: dict = dataclasses.field(default_factory=dict)  # by transponder

    def depth(self, place):
        return self.surface_up_m - place[2]

    def of(self, transponder):
        return [shot for shot in self.shots if shot.transponder == transponder]


def rows_of(path, allowed):
    """(line number, cells) of a table of numbers, checked: `allowed` says how many columns there may be."""
    try:
        lines = path.read_text().splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise Refusal(f"{path}: cannot be read: {error}") from None
    rows, of_columns = [], " or ".join(map(str, allowed))
    for number, line in enumerate(lines, 1):
        cells = line.split("#")[0].replace(",", " ").split()
        if not cells:
            continue
        if len(cells) not in allowed:
            raise Refusal(f"{path}:{number}: {len(cells)} columns; allowed: {of_columns}")
        rows.append((number, cells))
    if not rows:
        raise Refusal(f"{path}: no rows; allowed: one or more of {of_columns} columns")
    return rows


def numbers(path, line, cells):
    try:
        values = [float(cell) for cell in cells]
    except ValueError as error:
        raise Refusal(f"{path}:{line}: {error}; allowed: numbers") from None
    for value in values:
        if not math.isfinite(value):
            raise Refusal(f"{path}:{line}: {value}; allowed: finite numbers")
    return values


def shot_of(path, line, transponder, sent_s, received_s, two_way_s, sent, received):
    waited_s = received_s - sent_s - two_way_s
    if not 0 < two_way_s <= 20:
        raise Refusal(f"{path}:{line}: a two-way time of {two_way_s} s; allowed: above 0, up to 20")
    if not -1e-3 <= waited_s <= 60:
        raise Refusal(f"{path}:{line}: received {received_s - sent_s:.6f} s after transmission, with a two-way time of {two_way_s} s; "
                      "allowed: the two-way time and up to 60 s of the transponder's delay")
    return Shot(transponder, sent_s, two_way_s, max(waited_s, 0), tuple(sent), tuple(received))


def from_antenna(antenna, attitude_deg, lever):
    """Place of the transducer. `lever`: right, forward, up in the ship. Heading is clockwise from north; pitch lifts the bow, roll
    the port side: right-handed turns about right and forward, roll first."""
    heading, pitch, roll = map(math.radians, attitude_deg)
    right, forward, up = lever
    right, up = right * math.cos(roll) + up * math.sin(roll), up * math.cos(roll) - right * math.sin(roll)
    forward, up = forward * math.cos(pitch) - up * math.sin(pitch), forward * math.sin(pitch) + up * math.cos(pitch)
    return (antenna[0] + right * math.cos(heading) + forward * math.sin(heading),
            antenna[1] - right * math.sin(heading) + forward * math.cos(heading), antenna[2] + up)


def read_profile(path):
    profile = []
    for line, cells in rows_of(path, (2,)):
        depth, speed = numbers(path, line, cells)
        if profile and depth <= profile[-1][0]:
            raise Refusal(f"{path}:{line}: a depth of {depth} m after {profile[-1][0]} m; allowed: rising depths")
        if not 1300 <= speed <= 1700:
            raise Refusal(f"{path}:{line}: {speed} m/s; allowed: 1300 to 1700")
        profile.append((depth, speed))
    return profile


def read_seagap(path):
    folder = path.parent
    profiles = [folder / name for name in ("ss_prof.inp", "ss_prof.zv") if (folder / name).exists()]
    if not profiles or not (folder / "tr-ant.inp").exists():
        raise Refusal(f"{folder}: obsdata.inp alone; needed beside it: tr-ant.inp, and ss_prof.inp or ss_prof.zv")
    line, cells = rows_of(folder / "tr-ant.inp", (3,))[0]
    lever = numbers(folder / "tr-ant.inp", line, cells)
    shots = []
    for line, cells in rows_of(path, (16, 17, 18)):
        v = numbers(path, line, cells[1:])
        if len(cells) == 18 and v[16] == 0:
            continue
        shots.append(shot_of(path, line, cells[0], v[1], v[8], v[0], from_antenna(v[2:5], v[5:8], lever),
                             from_antenna(v[9:12], v[12:15], lever)))
    guesses = {}
    for path in [folder / name for name in ("pxp-ini.inp", "pxp-ini.xyh") if (folder / name).exists()][:1]:
        for number, (line, cells) in enumerate(rows_of(path, range(3, 10)), 1):
            guesses[str(number)] = tuple(numbers(path, line, cells[:3]))
    return Survey(folder.resolve().name, shots, read_profile(profiles[0]), guesses)


def read_one_transponder(path):
    shots = []
    for line, cells in rows_of(path, (15,)):
        v = numbers(path, line, cells)
        shots.append(shot_of(path, line, "1", v[0], v[7], v[14], (v[2], v[1], v[3]), (v[9], v[8], v[10])))
    return Survey(path.stem, shots)


def is_one_transponder(path):
    with open(path, errors="replace") as file:
        return file.readline().startswith("# time0_transmit")


def read_surveys(places):
    surveys = []
    for place in map(pathlib.Path, places):
        if not place.exists():
            raise Refusal(f"{place}: no such folder")
        files = sorted(place.rglob("*")) if place.is_dir() else [place]
        found = [read_seagap(path) for path in files if path.name == "obsdata.inp"]
        found += [read_one_transponder(path) for path in files if path.suffix == ".txt" and is_one_transponder(path)]
        if not found:
            raise Refusal(f"{place}: no survey; allowed: obsdata.inp with tr-ant.inp and ss_prof.inp, or a .txt that begins with "
                          "'# time0_transmit'")
        surveys += found
    return surveys


def prepare(survey, transducer_depth_m):
    """Sorts the shots, leaves out transponders with too few, and puts the surface above every transducer."""
    counts = collections.Counter(shot.transponder for shot in survey.shots)
    for transponder in sorted(name for name, count in counts.items() if count < MIN_SHOTS):
        print(f"{survey.name}: transponder {transponder} left out: {counts[transponder]} shots, needed are {MIN_SHOTS}",
              file=sys.stderr)
    survey.shots = sorted((shot for shot in survey.shots if counts[shot.transponder] >= MIN_SHOTS), key=lambda shot: shot.at_s)
    if not survey.shots:
        raise Refusal(f"{survey.name}: no transponder with {MIN_SHOTS} sound shots")
    heights = [place[2] for shot in survey.shots for place in (shot.sent, shot.received)]
    survey.surface_up_m = max(statistics.fmean(heights) + transducer_depth_m, max(heights) + 0.1)
