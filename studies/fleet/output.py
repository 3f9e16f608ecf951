# SPDX-License-Identifier: BSD-3-Clause
"""The rows as a table, as growth with the number of vehicles, and as a picture."""
import math
import subprocess

COLOURS = {"straight": "#0072B2", "rays": "#D55E00"}
POINTS = {"dense": 7, "spread": 6}


def markdown(head, rows):
    return "\n".join("| " + " | ".join(map(str, row)) + " |" for row in (head, ["---"] * len(head), *rows))


def three_digits(value):
    """12300, 1230, 123, 12.3, 1.23, 0.123."""
    return f"{value:.{max(0, 2 - math.floor(math.log10(value)))}f}" if 0 < value < 100 else f"{float(f'{value:.3g}'):.0f}"


def table(rows):
    head = ("vehicles", "laid", "paths", "simulated s a second of CPU", "of wall time", "memory, MB", "log, kB a simulated s", "start, s")
    return markdown(head, [(row.count, row.laying, row.model, three_digits(row.per_cpu_s), three_digits(row.per_wall_s),
                            f"{row.memory_mb:.0f}", three_digits(row.log_bytes_per_s / 1000), three_digits(row.start_s)) for row in rows])


def series(rows):
    """(laying, model) and its rows, by number of vehicles."""
    keys = dict.fromkeys((row.laying, row.model) for row in rows)
    return [(key, sorted((row for row in rows if (row.laying, row.model) == key), key=lambda row: row.count)) for key in keys]


def growth(rows):
    """The exponent of N by which the CPU of a simulated second grows: the least-squares slope from 30 vehicles on."""
    lines = []
    for (laying, model), members in series(rows):
        points = [(math.log(row.count), -math.log(row.per_cpu_s)) for row in members if row.count >= 30]
        if len(points) < 2:
            continue
        x0, y0 = (sum(values) / len(points) for values in zip(*points))
        slope = sum((x - x0) * (y - y0) for x, y in points) / sum((x - x0) ** 2 for x, _ in points)
        lines.append((laying, model, f"{members[-len(points)].count} to {members[-1].count}", f"{slope:.2f}"))
    return markdown(("laid", "paths", "vehicles", "CPU of a simulated second grows as N to the"), lines) if lines else ""


def draw(rows, path):
    """Simulated seconds a second of CPU against the number of vehicles, by gnuplot."""
    plots, data = [], []
    for (laying, model), members in series(rows):
        plots.append(f"'-' with linespoints lw 1.8 ps 1.1 pt {POINTS[laying]} lc '{COLOURS[model]}' title '{laying}, {model}'")
        data += [f"{row.count} {row.per_cpu_s:.5g}" for row in members] + ["e"]
    script = ["set terminal svg size 700,420 font 'Helvetica,12' background '#ffffff'", f"set output '{path}'", "set border 3 lc '#444444'",
              "set tics nomirror out", "set grid lc '#dddddd' lt 1", "set logscale xy", "set xlabel 'vehicles'",
              "set ylabel 'simulated seconds a second of CPU'", "set key top right",
              "plot 1 lc '#999999' dt 2 title 'real time on one core', " + ", ".join(plots), *data]
    subprocess.run(["gnuplot", "--default-settings"], input="\n".join(script) + "\n", check=True, text=True)
