# SPDX-License-Identifier: BSD-3-Clause
"""Instructions of short runs, counted by callgrind: the same on a busy machine as on an idle one."""
import csv
import os
import pathlib
import re
import subprocess
import tempfile

from fleet.measure import Refusal
from fleet.output import markdown, three_digits
from fleet.scenario import fleet

BASELINE = pathlib.Path(__file__).resolve().parent.parent.parent / "bench/instructions.csv"  # of the last release
ROWS = {  # by name: vehicles, laying, model, simulated seconds
    "3-straight": (3, "dense", "straight", 30),
    "20-straight": (20, "dense", "straight", 5),
    "3-rays": (3, "dense", "rays", 1),
}
LOSS = 0.2  # of the speed: a row of 1 / (1 - LOSS) times the instructions of the baseline fails


def counted(program, name):
    count, laying, model, seconds = ROWS[name]
    with tempfile.TemporaryDirectory() as folder:
        scenario = os.path.join(folder, "fleet.toml")
        pathlib.Path(scenario).write_text(fleet(count, laying, model, seconds))
        done = subprocess.run(["valgrind", "--tool=callgrind", f"--callgrind-out-file={folder}/out", program, "run", scenario, "--log",
                               f"{folder}/run.lcm", "--no-csv", "--no-report", "--quiet"], capture_output=True, text=True)
    found = re.search(r"Collected : (\d+)", done.stderr)
    if done.returncode != 0 or not found:
        raise Refusal(f"{name} under callgrind: {done.stderr.strip().splitlines()[-1]}")
    return int(found[1])


def baseline():
    with open(BASELINE, newline="") as file:
        return {row["row"]: int(row["instructions"]) for row in csv.DictReader(file)}


def write(program):
    with open(BASELINE, "w", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([("row", "instructions"), *((name, counted(program, name)) for name in ROWS)])


def check(program, count=counted):
    """A table of ratios, and the rows that lost more than LOSS twice in a row."""
    before, rows, lost = baseline(), [], []
    for name in ROWS:
        speeds = []
        while len(speeds) < 2 and (not speeds or speeds[-1] < 1 - LOSS):
            speeds.append(before[name] / count(program, name))
        rows.append((name, three_digits(before[name] / 1e6), three_digits(before[name] / 1e6 / speeds[-1]), f"{speeds[-1]:.2f}"))
        if speeds[-1] < 1 - LOSS:
            lost.append(name)
    return markdown(("run", "instructions of the last release, million", "now", "speed"), rows), lost
