# SPDX-License-Identifier: BSD-3-Clause
"""What was found: statistics, the table, the picture."""
import bisect
import csv
import dataclasses
import math
import statistics

from at_sea.predictions import run
from at_sea.surveys import Refusal, Survey

RMS = "measured less predicted: rms, us"
MAX_POINTS = 500  # of a panel
SLOW_S = 600  # what the shots within this of each other have in common is the sea's
TABLE_BEGIN, TABLE_END = "<!-- table of studies/validate_at_sea -->", "<!-- end of table -->"


@dataclasses.dataclass
class Result:
    survey: Survey
    rows: list  # (shot, measured less predicted, s) without outliers
    lines: dict = dataclasses.field(default_factory=dict)  # of the table, as text


def rms(residuals):
    return math.sqrt(statistics.fmean(r * r for r in residuals))


def quantile(values, share):
    values = sorted(values)
    return values[min(len(values) - 1, int(share * len(values)))]


def without_slow_part(rows):
    """The residuals less the mean of all within SLOW_S."""
    rows = sorted(rows, key=lambda row: row[0].at_s)
    times, sums = [shot.at_s for shot, _ in rows], [0.0]
    for _, residual in rows:
        sums.append(sums[-1] + residual)
    rest = []
    for shot, residual in rows:
        first, last = bisect.bisect_left(times, shot.at_s - SLOW_S), bisect.bisect_right(times, shot.at_s + SLOW_S)
        rest.append(residual - (sums[last] - sums[first]) / (last - first))
    return rest


def microseconds(value_s):
    us = 1e6 * value_s
    return f"{us:.2f}" if us < 1 else f"{us:.1f}" if us < 100 else f"{us:.0f}"


def table(results):
    """A column a survey."""
    lines = ["| | " + " | ".join(result.survey.name for result in results) + " |", "| --- |" + " --- |" * len(results)]
    return "\n".join(lines + [f"| {row} | " + " | ".join(result.lines[row] for result in results) + " |" for row in results[0].lines])


def write_residuals(results, path):
    with open(path, "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["survey", "transponder", "time_s", "two_way_time_s", "residual_us"])
        for result in results:
            for shot, residual in result.rows:
                writer.writerow([result.survey.name, shot.transponder, shot.at_s, shot.two_way_s, f"{1e6 * residual:.3f}"])


def draw(results, path):
    """A panel a survey: measured less predicted, over time, a colour for each transponder; of many shots every n-th."""
    rows = math.ceil(len(results) / 2)
    script = [f"set terminal svg size 900,{60 + 240 * rows} font 'Helvetica,11'", f"set output '{path}'",
              f"set multiplot layout {rows},{min(2, len(results))}", "set key off", "set xzeroaxis lt -1 lc '#888888'",
              "set xlabel 'hours since the first shot'", "set ylabel 'measured less predicted, us'"]
    colours = ("#1f77b4", "#d62728", "#2ca02c", "#ff7f0e", "#9467bd", "#8c564b")
    for result in results:
        first_s = result.survey.shots[0].at_s
        bound = 1.1e6 * max(abs(residual) for _, residual in result.rows)
        script += [f"set title '{result.survey.name}: rms {result.lines[RMS]} us' noenhanced", f"set yrange [{-bound}:{bound}]"]
        names, data = sorted(result.survey.places), []
        every = math.ceil(len(result.rows) / MAX_POINTS)
        for name in names:
            data += [f"{(shot.at_s - first_s) / 3600:.4f} {1e6 * residual:.1f}" for shot, residual in result.rows
                     if shot.transponder == name][::every] + ["e"]
        plots = (f"'-' with points pt 7 ps 0.25 lc rgb '{colours[i % len(colours)]}'" for i in range(len(names)))
        script += ["plot " + ", ".join(plots)] + data
    run("gnuplot", "--default-settings", given="\n".join(script) + "\n")


def write_into(page, text):
    before, begin, rest = page.read_text().partition(TABLE_BEGIN)
    _, end, after = rest.partition(TABLE_END)
    if not begin or not end:
        raise Refusal(f"{page}: no table to replace; allowed: lines '{TABLE_BEGIN}' and '{TABLE_END}'")
    page.write_text(f"{before}{TABLE_BEGIN}\n{text}\n{TABLE_END}{after}")
