# SPDX-License-Identifier: BSD-3-Clause
"""A model, on paper, of a fleet over many hosts: what each needs, from what every part of the work costs here."""
import collections
import dataclasses
import math
import os
import re
import struct
import subprocess
import tempfile

from fleet.measure import Refusal, run
from fleet.output import markdown, three_digits
from fleet.scenario import fleet

MEASURED, DURATION_S = 300, 20  # vehicles, spread along straight paths; simulated
TABLES_OFF, STATES_ONCE = "channel_server.link_rate_hz=0.0166667", "vehicle_sim.state_rate_hz=1"
TILE_KM, RECKONED_HZ = 12.5, 1
DATAGRAM_BYTES = 28 + 8  # headers of IP and UDP, and of LCM
PEERS_AT = 48  # num_peers in a LINKS message


@dataclasses.dataclass
class Traffic:
    """What a log holds."""
    messages: collections.Counter  # by channel family
    message_bytes: collections.Counter
    rows: int = 0  # of link tables


def traffic(log):
    counted = Traffic(collections.Counter(), collections.Counter())
    with open(log, "rb") as file:
        while header := file.read(28):
            _, _, _, channel_size, size = struct.unpack(">Iqqii", header)
            channel, data = file.read(channel_size), file.read(size)
            family = channel.partition(b".")[0].decode()
            counted.messages[family] += 1
            counted.message_bytes[family] += size + channel_size + DATAGRAM_BYTES
            if family == "LINKS":
                counted.rows += struct.unpack_from(">i", data, PEERS_AT)[0]
    return counted


@dataclasses.dataclass
class Terms:
    """CPU of one of each, in microseconds, and how many and how large they are."""
    vehicle_us: float  # moved, piloted and measured for a second
    state_us: float  # a STATE, published and received over udpm
    row_us: float  # of a link table, with its echoes
    outcome_us: float
    rows: float  # of a vehicle's table
    outcomes: float  # a vehicle and second
    state_bytes: float
    row_bytes: float
    outcome_bytes: float


def cost(program, text, *settings):
    """CPU of the run after its start, s, and what it logged."""
    with tempfile.TemporaryDirectory() as folder:
        scenario, log = os.path.join(folder, "fleet.toml"), os.path.join(folder, "run.lcm")
        with open(scenario, "w") as file:
            file.write(text)
        start = run(program, scenario, 0.001, log, *settings)
        whole = run(program, scenario, DURATION_S, log, *settings)
        return whole.cpu_s - start.cpu_s, traffic(log)


def state_over_udpm_us(bench):
    """Published and received over udpm, 100 at a time."""
    printed = subprocess.run([bench, "--benchmark_filter=^messages_through_udpm/100", "--benchmark_format=csv"],
                             capture_output=True, check=True, text=True).stdout
    rate = re.search(r'^"messages_through_udpm/100/real_time".*,([0-9.e+]+)$', printed, re.MULTILINE)
    if not rate:
        raise Refusal(f"{bench} measured nothing: {printed}")
    return 1e6 / float(rate[1])


def measured(program, bench):
    talking = fleet(MEASURED, "spread", "straight", DURATION_S)
    silent = re.sub(r"\[vehicle\.traffic\](\n[^\[\n]+)+", "", talking)
    all_s, all_log = cost(program, talking)
    untabled_s, untabled_log = cost(program, talking, TABLES_OFF)
    unheard_s, _ = cost(program, silent, TABLES_OFF)
    few_s, _ = cost(program, silent, TABLES_OFF, STATES_ONCE)
    vehicle_seconds = MEASURED * DURATION_S
    tables = all_log.messages["LINKS"] - untabled_log.messages["LINKS"]
    rows = all_log.rows - untabled_log.rows
    outcomes = untabled_log.messages["OUTCOME"]
    return Terms(vehicle_us=1e6 * few_s / vehicle_seconds, state_us=state_over_udpm_us(bench),
                 row_us=1e6 * (all_s - untabled_s) / rows, outcome_us=1e6 * (untabled_s - unheard_s) / outcomes,
                 rows=rows / tables, outcomes=outcomes / vehicle_seconds,
                 state_bytes=all_log.message_bytes["STATE"] / all_log.messages["STATE"],
                 row_bytes=all_log.message_bytes["LINKS"] / all_log.rows, outcome_bytes=untabled_log.message_bytes["OUTCOME"] / outcomes)


def in_tiles(own):
    """Vehicles in the tiles that a host joins whose own fill a square, one a square kilometre: a row of places of that length touches one tile
    more than it is long."""
    return (math.sqrt(own) + TILE_KM) ** 2


def hosts_tables(program, bench, vehicles, hosts):
    terms = measured(program, bench)
    own = vehicles / hosts
    costs = markdown(("what", "CPU of one, us", "how many", "bytes of one"), [
        ("a vehicle moved, piloted and measured for a second", three_digits(terms.vehicle_us), "", ""),
        ("a STATE over udpm, published and received", three_digits(terms.state_us), "10 a second, or 1 by dead reckoning", f"{terms.state_bytes:.0f}"),
        ("a row of a link table", three_digits(terms.row_us), f"{terms.rows:.0f} a table, 1 table a second", f"{terms.row_bytes:.0f}"),
        ("an outcome of a packet", three_digits(terms.outcome_us), f"{terms.outcomes:.2f} a vehicle and second", f"{terms.outcome_bytes:.0f}")])
    near = min(in_tiles(own), vehicles)
    rows = []
    for name, rate, tables in (("states 10 times a second", 10, vehicles), ("by dead reckoning", RECKONED_HZ, vehicles),
                              (f"by dead reckoning, tiles of {TILE_KM} km", RECKONED_HZ, near)):
        states = vehicles * rate
        cpu = [own * terms.vehicle_us, states * terms.state_us, own * terms.rows * terms.row_us, own * terms.outcomes * terms.outcome_us]
        without_tables = states * terms.state_bytes + vehicles * terms.outcomes * terms.outcome_bytes
        received = without_tables + tables * terms.rows * terms.row_bytes
        rows.append((name, *(three_digits(1e-6 * part) for part in (*cpu, sum(cpu))), three_digits(8e-6 * received),
                     three_digits(8e-6 * without_tables)))
    model = markdown((f"a host of {hosts}, {own:.0f} of {vehicles} vehicles", "vehicles, s a second", "STATE", "link tables", "outcomes", "CPU, all",
                      "received, Mbit/s", "but for LINKS"), rows)
    return f"{costs}\n\n{model}"
