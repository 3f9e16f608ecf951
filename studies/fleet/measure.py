# SPDX-License-Identifier: BSD-3-Clause
"""Runs the program and tells what it cost."""
import dataclasses
import os
import subprocess
import tempfile
import time

from fleet.scenario import fleet


class Refusal(Exception):
    """Something that the user has to change."""


@dataclasses.dataclass
class Cost:
    wall_s: float
    cpu_s: float  # of all threads, user and system
    memory_mb: float  # greatest resident set
    log_bytes: int


def run(program, scenario, duration_s, log, *settings):
    """One run of `scenario` (a file) in one process, its log to `log`."""
    command = [program, "run", scenario, "--duration", str(duration_s), "--log", log, "--no-csv", "--no-report", "--quiet",
               "--force", *(word for setting in settings for word in ("--set", setting))]
    begin = time.monotonic()
    child = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    errors = child.stderr.read().decode()
    _, status, used = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode != 0:
        raise Refusal(f"halocline run {scenario}: {errors.strip()}")
    return Cost(time.monotonic() - begin, used.ru_utime + used.ru_stime, used.ru_maxrss / 1024, os.path.getsize(log))


@dataclasses.dataclass
class Row:
    count: int
    laying: str
    model: str
    duration_s: float
    start_s: float  # wall time of a run of no duration: start-up, the first instant and the first searches
    per_cpu_s: float  # simulated seconds a second of CPU, after the start
    per_wall_s: float
    memory_mb: float
    log_bytes_per_s: float  # a simulated second


SHORTEST_S, LONGEST_S, INSTANT_S = 2.0, 1200.0, 0.001


def measure(program, count, laying, model, cpu_s, *settings):
    """A row: the run is as long as `cpu_s` seconds of CPU, at least two simulated seconds."""
    with tempfile.TemporaryDirectory() as folder:
        scenario, log = os.path.join(folder, "fleet.toml"), os.path.join(folder, "run.lcm")
        with open(scenario, "w") as file:
            file.write(fleet(count, laying, model, LONGEST_S))
        start = run(program, scenario, INSTANT_S, log, *settings)
        duration = SHORTEST_S
        while True:
            cost = run(program, scenario, duration, log, *settings)
            cpu = max(cost.cpu_s - start.cpu_s, 0.01)
            if cpu > cpu_s / 2 or duration == LONGEST_S:
                break
            duration = min(LONGEST_S, round(duration * min(cpu_s / cpu, 30)))
        wall = max(cost.wall_s - start.wall_s, 0.01)
        return Row(count, laying, model, duration, start.wall_s, duration / cpu, duration / wall, cost.memory_mb,
                   (cost.log_bytes - start.log_bytes) / duration)
