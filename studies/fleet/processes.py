# SPDX-License-Identifier: BSD-3-Clause
"""A fleet as separate processes over udpm, in real time: what each process costs, and what the bus loses."""
import dataclasses
import os
import pathlib
import re
import struct
import subprocess
import sys
import tempfile
import time

from fleet import log_flows
from fleet.measure import Refusal
from fleet.output import markdown
from fleet.scenario import fleet

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "lcmtypes"))
from generate import read_messages

START_S = 15  # of the wall: processes start and links are heard of for the first time; not counted
END_S = 3  # before the end of the run, when the processes still exist
PERIOD_S = 1
TAIL_BYTES = 64 << 20  # of the log: more than its last second
SCALARS = {"int8_t": "b", "int16_t": "h", "int32_t": "i", "int64_t": "q", "float": "f", "double": "d"}


@dataclasses.dataclass
class Sample:
    at_s: float
    cpu_s: dict  # by (process id, program): user and system
    udp: dict  # counters of the network namespace


def descendants(pid):
    found = []
    try:
        for task in os.listdir(f"/proc/{pid}/task"):
            with open(f"/proc/{pid}/task/{task}/children") as file:
                for child in map(int, file.read().split()):
                    found += [child, *descendants(child)]
    except OSError:  # it has ended
        pass
    return found


def sample(pid):
    cpu_s = {}
    for child in descendants(pid):
        try:
            program = pathlib.Path(f"/proc/{child}/cmdline").read_text().split("\0")[0].split("/")[-1]
            fields = pathlib.Path(f"/proc/{child}/stat").read_text().rpartition(")")[2].split()
        except OSError:  # it has ended
            continue
        if program.startswith(("halocline-", "lcm-")):
            cpu_s[child, program.removeprefix("halocline-")] = sum(map(int, fields[11:13])) / os.sysconf("SC_CLK_TCK")
    lines = [line.split()[1:] for line in open(f"/proc/{pid}/net/snmp") if line.startswith("Udp:")]
    return Sample(time.monotonic(), cpu_s, dict(zip(lines[0], map(int, lines[1]))))


def decoded(message, data):
    """The fields of a message of scalars and strings."""
    values, at = {}, 8  # behind the fingerprint
    for field in message.fields:
        if field.kind == "string":
            size, = struct.unpack_from(">i", data, at)
            values[field.name] = data[at + 4:at + 3 + size].decode()
            at += 4 + size
        else:
            layout = ">" + SCALARS[field.kind]
            values[field.name], = struct.unpack_from(layout, data, at)
            at += struct.calcsize(layout)
    return values


def last_statuses(log):
    """The last STATUS of each node, by name."""
    message = read_messages(ROOT / "lcmtypes")["node_status_t"]
    with open(log, "rb") as file:
        file.seek(max(0, os.path.getsize(log) - TAIL_BYTES))
        tail = file.read()
    statuses = {}
    for found in re.finditer(rb"\xed\xa1\xda\x01.{16}(.{8})STATUS\.", tail, re.DOTALL):
        channel_size, size = struct.unpack(">ii", found[1])
        begin = found.end() - len(b"STATUS.") + channel_size
        if 0 < size <= len(tail) - begin:
            status = decoded(message, tail[begin:begin + size])
            statuses[status["node_name"]] = status
    return statuses


def processes(count, laying, model, duration_s, recorder):
    """Runs the fleet for `duration_s` of wall time after its start, and returns tables: CPU, losses, and what the
    log lacks."""
    (ROOT / "results").mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory(dir=ROOT / "results") as folder:
        scenario, log = os.path.join(folder, "fleet.toml"), os.path.join(folder, "run.lcmlog")
        pathlib.Path(scenario).write_text(fleet(count, laying, model, START_S + duration_s + END_S))
        run = subprocess.Popen([ROOT / "scripts/run_distributed", scenario, "--log", log, "--recorder", recorder],
                               env=dict(os.environ, HALOCLINE_BIN=str(ROOT / "build/release/bin")), stdout=subprocess.DEVNULL)
        try:
            time.sleep(START_S)
            first = last = sample(run.pid)
            load = []
            while last.at_s < first.at_s + duration_s:
                time.sleep(PERIOD_S)
                if run.poll() is not None:
                    raise Refusal("the run ended before its time")
                last = sample(run.pid)
                load.append(os.getloadavg()[0])
            run.wait()
        finally:
            run.terminate()
        return "\n\n".join((*tables(first, last, last_statuses(log)), log_table(log_flows.counts(log)),
                            f"Load of the machine: {min(load):.1f} to {max(load):.1f}."))


def log_table(counts):
    """What was published, of all flows and of each family that the log lacks messages of."""
    rows = [("log", *map(sum, zip(*counts.values())))]
    rows += [(f"of these {name}", *both) for name, both in sorted(counts.items()) if both[0] != both[1]]
    return markdown(("recording, from the first message on", "published", "in the log", "lacking"),
                    [(name, published, logged, published - logged) for name, published, logged in rows])


def tables(first, last, statuses):
    passed_s = last.at_s - first.at_s
    cpu = {key: (seconds - first.cpu_s.get(key, 0)) / passed_s for key, seconds in last.cpu_s.items()}
    rows = [(program, f"{share:.2f}") for (_, program), share in sorted(cpu.items(), key=lambda item: -item[1])]
    grown = {name: last.udp[name] - first.udp[name] for name in last.udp}
    losses = [(name, *(status[field] for field in ("gaps", "repaired", "lost", "late"))) for name, status in sorted(statuses.items())]
    return (
        markdown(("process", "CPU, s a second"), [*rows, ("all", f"{sum(cpu.values()):.2f}")]),
        markdown(("datagrams of the bus in", "delivered a second", "lost by full buffers"),
                 [(f"{passed_s:.0f} s", f"{grown['InDatagrams'] / passed_s:.0f}", grown["RcvbufErrors"])]),
        markdown(("node, from its start on", "messages missed", "repaired", "lost", "late"), losses))
