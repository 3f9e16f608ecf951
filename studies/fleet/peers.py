# SPDX-License-Identifier: BSD-3-Clause
"""What other programs do in the same time, on the same machine: those of Debian's packages that are installed."""
import json
import pathlib
import subprocess
import tempfile

from fleet.output import markdown, three_digits

SIMULATED_S = {20: 12000, 100: 1200}


def of_ns3(root):
    """Outcomes a second of CPU of ns-3's underwater acoustic network, by number of nodes; empty without libns3-dev."""
    with tempfile.TemporaryDirectory() as folder:
        program = pathlib.Path(folder) / "ns3_uan"
        built = subprocess.run(["g++", "-O2", "-std=c++17", root / "bench/peers/ns3_uan.cc", "-o", program, "-lns3-uan", "-lns3-mobility",
                                "-lns3-network", "-lns3-core"], capture_output=True)
        if built.returncode != 0:
            return {}
        rates = {}
        for count, seconds in SIMULATED_S.items():
            outcomes, _, cpu_s = subprocess.run([program, str(count), str(seconds)], capture_output=True, check=True, text=True).stdout.split()
            rates[count] = float(outcomes) / float(cpu_s)
        return rates


def of_ours(root):
    """Outcomes a second of CPU of the packet medium alone, by number of vehicles; empty where the benchmark is not built."""
    program = root / "build/release/bin/channel_server_bench"
    if not program.exists():
        return {}
    report = subprocess.run([program, "--benchmark_filter=^packet/(20|100)$", "--benchmark_format=json"], capture_output=True, check=True,
                            text=True).stdout
    rates = {}
    for row in json.loads(report)["benchmarks"]:
        count = int(row["name"].split("/")[1])
        rates[count] = row["outcomes_per_second"]
    return rates


def peers_table(root):
    theirs, ours = of_ns3(root), of_ours(root)
    rows = [(f"packets among {count}, straight paths", f"{three_digits(ours[count])} outcomes/s",
             f"ns-3 UAN, Thorp, Aloha: {three_digits(theirs[count])} outcomes/s", three_digits(ours[count] / theirs[count]))
            for count in SIMULATED_S if count in ours and count in theirs]
    return markdown(("in the same run", "Halocline", "peer", "ratio"), rows) if rows else ""
