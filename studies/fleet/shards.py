# SPDX-License-Identifier: BSD-3-Clause
"""What channel servers that share the vehicles cost: a run in lockstep over udpm on a private bus, each program a process."""
import dataclasses
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "studies"))
sys.dont_write_bytecode = True
from fleet.measure import LONGEST_S, Refusal
from fleet.output import markdown, three_digits
from fleet.scenario import fleet

OTHERS = ("bathymetry", "vehicle-sim", "autopilot", "traffic", "localiser")
PROGRAMS = ["halocline", *(f"halocline-{name}" for name in (*OTHERS, "conductor", "channel-server"))]


@dataclasses.dataclass
class Run:
    costs: list  # of each channel server: seconds of CPU, user and system, or millions of instructions
    wall_s: float
    output: str  # hash of the simulation output


def run_all(bin_folder, scenario, duration_s, shards, counts_instructions, log):
    """Within a private bus: prints what each server cost and the wall time as JSON."""
    common = [scenario, "--log-level", "warning", "--set", f"scenario.duration_s={duration_s}"]
    servers = {f"channel-server-{i}": ["--shard", f"{i}/{shards}"] for i in range(shards)} if shards > 1 else {"channel-server": []}

    def start(program, *options, under=()):
        return subprocess.Popen([*under, f"{bin_folder}/halocline-{program}", *common, *options], stdout=sys.stderr)

    def counted(name):
        return ["valgrind", "-q", "--tool=callgrind", f"--callgrind-out-file={log}.{name}"] if counts_instructions else []

    begin = time.monotonic()
    conductor = start("conductor", "--lockstep", "--log", log, "--expect", ",".join([*OTHERS, *servers]))
    others = [start(name, "--time-source", "lockstep") for name in OTHERS]
    shares = {name: start("channel-server", "--time-source", "lockstep", *options, under=counted(name)) for name, options in servers.items()}
    code = conductor.wait()
    wall_s = time.monotonic() - begin
    costs = []
    for child in (*others, *shares.values()):  # they know that the run is over
        _, status, used = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
        code = code or child.returncode
        if child in shares.values():
            costs.append(used.ru_utime + used.ru_stime)
    if counts_instructions and code == 0:
        costs = [int(re.search(r"^totals: (\d+)", pathlib.Path(f"{log}.{name}").read_text(), re.M)[1]) / 1e6 for name in shares]
    print(json.dumps({"costs": costs, "wall_s": wall_s}))
    return code


def measure_run(bin_folder, scenario, duration_s, shards, counts_instructions, folder):
    log, output = f"{folder}/run.lcm", f"{folder}/output"
    done = subprocess.run([ROOT / "scripts/isolated", sys.executable, __file__, bin_folder, scenario, str(duration_s), str(shards),
                           "instructions" if counts_instructions else "cpu", log], capture_output=True, text=True)
    if done.returncode == 0:
        told = json.loads(done.stdout)
        done = subprocess.run([f"{bin_folder}/halocline", "log", "output", log, "--out", output, "--force"], capture_output=True, text=True)
    if done.returncode != 0:
        raise Refusal(f"{shards} channel servers: {done.stderr.strip()}")
    digest = subprocess.run(["sha256sum", output], capture_output=True, text=True, check=True).stdout[:8]
    return Run(told["costs"], told["wall_s"], digest)


def rows_of(fleet_of, runs):
    """`runs`: by number of servers, one of them alone. Of each the least of several runs."""
    busiest = {shards: min(max(run.costs) for run in some) for shards, some in runs.items()}
    wall_s = {shards: min(run.wall_s for run in some) for shards, some in runs.items()}
    return [(*fleet_of, shards, three_digits(busiest[shards]), three_digits(min(sum(run.costs) for run in some)),
             f"{busiest[1] / busiest[shards]:.2f}", f"{wall_s[1] / wall_s[shards]:.2f}") for shards, some in runs.items()]


def shards_table(bin_folder, fleets, servers, duration_s, repeats, counts_instructions=False):
    """`fleets`: of (vehicles, laying, model). With each number of servers in turns; the outputs have to be equal."""
    rows = []
    for fleet_of in fleets:
        with tempfile.TemporaryDirectory() as folder:
            scenario = f"{folder}/fleet.toml"
            pathlib.Path(scenario).write_text(fleet(*fleet_of, LONGEST_S))
            runs = {shards: [] for shards in servers}
            for _ in range(1 if counts_instructions else repeats):
                for shards in servers:
                    print(f"benchmark: {', '.join(map(str, fleet_of))}: {shards} channel servers", file=sys.stderr, flush=True)
                    runs[shards].append(measure_run(bin_folder, scenario, duration_s, shards, counts_instructions, folder))
            if len({run.output for some in runs.values() for run in some}) > 1:
                raise Refusal(f"{', '.join(map(str, fleet_of))}: the outputs differ with the number of servers")
            rows += rows_of(fleet_of, runs)
    cost = "instructions of the busiest, million" if counts_instructions else "CPU of the busiest, s"
    return markdown(("vehicles", "laid", "paths", "channel servers", cost, "of all", "one over the busiest", "one over these, wall time"),
                    rows)


if __name__ == "__main__":
    sys.exit(run_all(sys.argv[1], sys.argv[2], float(sys.argv[3]), int(sys.argv[4]), sys.argv[5] == "instructions",
                     sys.argv[6]))
