# SPDX-License-Identifier: BSD-3-Clause
"""Travel times by `halocline arrivals`."""
import csv
import io
import math
import subprocess

from at_sea.surveys import Refusal

BELOW_TRANSPONDER_M = 2  # of the bottom that halocline is given


def run(*command, given=""):
    """What a program prints; `given` is its standard input."""
    try:
        done = subprocess.run([str(part) for part in command], input=given, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    except FileNotFoundError:
        raise Refusal(f"{command[0]} is not installed; ./scripts/setup installs what Halocline needs") from None
    if done.returncode != 0:
        raise Refusal(f"{' '.join(map(str, command))} failed ({done.returncode}): {done.stderr.strip() or done.stdout.strip()}")
    return done.stdout


def bottom_depth(survey, places):
    deepest = max(survey.depth(place) for place in places.values())
    if len(survey.profile) > 1 and survey.profile[-1][0] < 0.95 * deepest:
        raise Refusal(f"{survey.name}: the profile ends at {survey.profile[-1][0]:g} m, a transponder lies at {deepest:.1f} m; "
                      "allowed: a profile to 0.95 of that or more")
    return deepest + BELOW_TRANSPONDER_M


def through_bottom(profile, bottom_m):
    """Rows from the surface to below the bottom."""
    above = [row for row in profile if 0 < row[0] < bottom_m]
    speed_at = lambda depth: next((a[1] + (b[1] - a[1]) * (depth - a[0]) / (b[0] - a[0]) for a, b in zip(profile, profile[1:])
                                   if a[0] <= depth <= b[0]), profile[0][1] if depth < profile[0][0] else profile[-1][1])
    return [(0.0, speed_at(0.0))] + above + [(bottom_m, speed_at(bottom_m))]


def travel_times(halocline, folder, profile, bottom_m, links):
    """One-way times by `halocline arrivals`: the direct path of each link (source depth, receiver depth, range)."""
    for name, header, rows in (("water.csv", "depth_m,sound_speed_mps", through_bottom(profile, bottom_m)),
                               ("links.csv", "src_depth_m,rcv_depth_m,rcv_range_m", links)):
        (folder / name).write_text("\n".join([header] + [",".join(map(repr, row)) for row in rows]) + "\n")
    text = run(halocline, "arrivals", "--water", folder / "water.csv", "--bottom-depth-m", repr(bottom_m), "--links", folder / "links.csv",
               "--format", "csv", "--steep-direct", "--max-bounces", 0)
    found = {}
    for row in csv.DictReader(io.StringIO(text)):
        found.setdefault((float(row["src_depth_m"]), float(row["rcv_depth_m"]), float(row["rcv_range_m"])), float(row["delay_s"]))
    for link in links:
        if link not in found:
            raise Refusal(f"no path from {link[0]} m to {link[1]} m deep, {link[2]} m away; allowed: links with a direct path")
    return [found[link] for link in links]


def predict(halocline, folder, survey, profile, places, shots):
    """Two-way times of the shots: of the moving ship, and of one that stays where it transmitted."""
    links = []
    for shot in shots:
        place = places[shot.transponder]
        deep = survey.depth(place)
        down, up = (math.dist(place[:2], ship[:2]) for ship in (shot.sent, shot.received))
        links += [(survey.depth(shot.sent), deep, down), (deep, survey.depth(shot.received), up), (deep, survey.depth(shot.sent), down)]
    times = travel_times(halocline, folder, profile, bottom_depth(survey, places), links)
    return [a + b for a, b in zip(times[::3], times[1::3])], [a + b for a, b in zip(times[::3], times[2::3])]
