#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A first look at a run and its sea with the Python package: cells (# %%) for Jupyter, Spyder or VS Code, or a program.

   $ PYTHONPATH=build/release/python /usr/bin/python3 clients/examples/python/first_look.py [SCENARIO [LOG [PICTURE]]]

Where matplotlib is installed it draws PICTURE (first_look.png).
"""
# %% What to look at
import sys

import numpy as np

import halocline

scenario, log, picture = sys.argv[1:] + ["scenarios/harbour.toml", "results/harbour/harbour.lcm", "first_look.png"][len(sys.argv) - 1:]

# %% Where the vehicles went
tables = halocline.read_log(log, channels=r"STATE\..*|OUTCOME")
state = tables["state"]
tracks = {name: state["position_ned_m"][state["channel"] == name] for name in np.unique(state["channel"])}
for name, track in tracks.items():
    metres = np.linalg.norm(np.diff(track, axis=0), axis=1).sum()
    print(f"{name.removeprefix('STATE.'):12} went {metres:.0f} m")

# %% What became of the packets
names = halocline.names_of("outcome", "outcome")
if "outcome" in tables:
    outcome = tables["outcome"]
    for value, count in zip(*np.unique(outcome["outcome"], return_counts=True)):
        print(f"{names[value]:12} {count}")
    received = outcome["outcome"] == names.index("received")
    if received.any():
        print(f"SINR of what was received: {np.median(outcome['sinr_db'][received]):.1f} dB in the median")

# %% One link of it: budget and paths
vehicles = [name.removeprefix("STATE.") for name in tracks]
link = halocline.link(scenario, vehicles[0], vehicles[1])
print(f"{vehicles[0]} to {vehicles[1]}: {link.budget['delay_s']:.3f} s, {link.budget['snr_db']:.1f} dB SNR, "
      f"{len(link.arrivals)} paths")

# %% A picture
try:
    import matplotlib
except ImportError:
    sys.exit(0)
matplotlib.use("Agg")
from matplotlib import pyplot as plt

figure, (chart, response) = plt.subplots(1, 2, figsize=(11, 4.5), layout="constrained")
for name, track in tracks.items():
    chart.plot(track[:, 1], track[:, 0], label=name.removeprefix("STATE."))
chart.set(xlabel="east, m", ylabel="north, m", title="Tracks", aspect="equal")
chart.legend()
if len(link.arrivals):
    response.stem(1e3 * link.paths["delay_s"], link.paths["level_db"], basefmt=" ", bottom=link.paths["level_db"].min() - 3)
response.set(xlabel="delay, ms", ylabel="level, dB re 1 uPa", title=f"{vehicles[0]} to {vehicles[1]}")
figure.savefig(picture)
print(picture)
