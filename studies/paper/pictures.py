# SPDX-License-Identifier: BSD-3-Clause
"""The figures as pictures, drawn by gnuplot."""
import hashlib
import math
import subprocess

from paper import delays, levels, ridge

COLOURS = ("#0072B2", "#009E73", "#E69F00", "#D55E00", "#CC79A7", "#56B4E9", "#444444")  # Okabe and Ito
EXPECTED = "with points pt 6 ps 1.2 lw 1.8 lc '#000000'"
SIZES = {"svg": "700,420", "png": "1050,630"}


def data(points):
    return [" ".join(f"{value:.6g}" for value in point) for point in points] + ["e"]


def curves(lines, marks, named="expected"):
    """`lines`: (title, points) each; `marks`: points as circles."""
    plots = [f"'-' with lines lw 1.8 lc '{COLOURS[i % len(COLOURS)]}' title '{title}'" for i, (title, _) in enumerate(lines)]
    if marks:
        plots.append(f"'-' {EXPECTED} title '{named}'")
    body = ["plot " + ", ".join(plots)]
    for _, points in lines:
        body += data(points)
    return body + (data(marks) if marks else [])


def columns(figure):
    """(x, y) of each column after the first."""
    return [[(row[0], row[i]) for row in figure.rows] for i in range(1, len(figure.columns))]


def figure4(figure):
    lines = [(name, [(y, x) for x, y in points]) for (_, name, _), points in zip(delays.WATERS, columns(figure))]
    return ["set xlabel 'delay over 1 km, s'", "set ylabel 'depth, m'", "set yrange [4550:-50]", "set key outside right",
            *curves(lines, figure.marks)]


def over_range(figure, label):
    lines = [(f"{level}", points) for level, points in zip(levels.LEVELS_DB, columns(figure))]
    return ["set xlabel 'range, m'", f"set ylabel '{label}'", "set xrange [0:185]",
            "set key outside right title 'source level, dB'", *curves(lines[::-1], figure.marks)]


def figure6(figure):
    return over_range(figure, "received level, dB re 1 uPa")


def figure7(figure):
    return ["set logscale y", "set format y '10^{%T}'", *over_range(figure, "capacity, bit/s")]


def bands(figure):
    bandwidth, capacity = ([(row[0], row[i] / 1000) for row in figure.rows] for i in (4, 6))
    return ["set logscale xy", "set xrange [0.4:60]", "set xlabel 'distance, km'", "set ylabel 'kHz or kbit/s'", "set key top right",
            *curves([("3 dB bandwidth, kHz", bandwidth), ("capacity at 20 dB, kbit/s", capacity)], figure.marks)]


def ridge_places(figure):
    bottom = [(north, ridge.bottom_m(north)) for north in range(-550, 551, 5)]
    likely, unlikely = ([row[:2] for row in figure.rows if row[2] == value] for value in (1, 0))
    return ["set xlabel 'north, m'", "set ylabel 'depth, m'", "set xrange [-550:550]", "set yrange [220:0]", "unset grid",
            "set key outside top center horizontal",
            "plot '-' with filledcurves x2 fc '#d9d2c5' notitle, '-' with points pt 7 ps 0.8 lc '#D55E00' title 'echo likely', "
            "'-' with points pt 6 ps 0.8 lc '#0072B2' title 'unlikely', '-' with points pt 9 ps 1.8 lc '#000000' title 'transmitter'",
            *data([*bottom, (550, 220), (-550, 220)]), *data(likely), *data(unlikely), *data([ridge.SENDER])]


BODIES = {"figure4": figure4, "figure6": figure6, "figure7": figure7, "bands": bands, "ridge": ridge_places}


def mark_of(figure):
    """Changes with the numbers, as far as a reader could see it."""
    numbers = [[f"{number:.4g}" if math.isfinite(number) else "" for number in row] for row in figure.rows + figure.marks]
    return f"<!-- {hashlib.sha256(repr(numbers).encode()).hexdigest()[:16]} of the numbers, by studies/reproduce_paper -->"


def draw(figure, path):
    """As SVG or PNG, by the end of the path's name."""
    kind = path.suffix[1:]
    terminal = {"svg": "svg", "png": "pngcairo"}[kind] + f" size {SIZES[kind]} font 'Helvetica,{12 if kind == 'svg' else 15}'"
    script = [f"set terminal {terminal} background '#ffffff'", f"set output '{path}'", "set border 3 lc '#444444'",
              "set tics nomirror out", "set grid lc '#dddddd' lt 1", *BODIES[figure.name](figure)]
    subprocess.run(["gnuplot", "--default-settings"], input="\n".join(script) + "\n", check=True, text=True)
    if kind == "svg":
        path.write_text(path.read_text().replace("<svg ", mark_of(figure) + "\n<svg ", 1))
