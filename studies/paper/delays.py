# SPDX-License-Identifier: BSD-3-Clause
"""Figure 4: the delay between two nodes 1 km apart, over their depth. Links and packets have to have it."""
from paper.comparison import Comparison, Figure, greatest_difference, reference
from paper.runs import traffic, vehicle

TABLE = "fig4_delay_vs_depth_1km.csv"
SEA = """
[scenario]
name = "figure4"
duration_s = 16
origin_latitude_deg = 45 # pressure at a depth depends on it; the reference values are for 45 degrees
[terrain.flat]
depth_m = 5000
[environment]
profile = "global-mean"
wind_mps = 0
absorption_model = "fisher-simmons" # the paper's
shipping = 0.5
[propagation]
model = "straight" # the paper's
fading = "none"
[modem]
source_level_db = 185
"""
WATERS = (  # column of the table, name, changes of the sea
    ("delay_woa98_s", "global mean", ()),
    ("delay_harris_s", "Harris and Zorzi", ('environment.profile="harris-zorzi"', 'environment.sound_speed_model="harris-zorzi"')),
    ("delay_munk_s", "Munk", ('environment.profile="munk"',)),
)
EXPECTED = {0.0: 0.660724, 950.0: 0.674539, 4500.0: 0.652978}  # m: s, of the global mean
# nsMIRACLE's delays by Harris and Zorzi's formula (uwm/underwater.cc, without the d / 1500 that it adds).
PUBLISHED = {0.0: 0.654954919977, 500.0: 0.660131910859, 1000.0: 0.674312871138, 4500.0: 0.651474948404}


def packet_delays(runs):
    """Of one packet at each depth of EXPECTED; the senders take turns, 4 s each, because every node hears all."""
    scenario = SEA
    for i, depth in enumerate(EXPECTED):
        scenario += vehicle(2 * i + 1, -500.0, depth) + traffic(4 * i + 1, 2 * i + 2) + vehicle(2 * i + 2, 500.0, depth)
    rows = runs.messages("figure4", scenario, r"RECEIVE\..*")["receive"]
    by_channel = {row["channel"]: float(row["travel_time_s"]) for row in rows}
    return {depth: by_channel[f"RECEIVE.at-{2 * i + 2}"] for i, depth in enumerate(EXPECTED)}


def figure_4(runs):
    table = reference(TABLE)
    depths = sorted({100.0 * i for i in range(46)} | {50.0, 950.0} | {row["depth_m"] for row in table})
    scenario = SEA + "".join(
        vehicle(2 * i + 1, -500.0, depth) + vehicle(2 * i + 2, 500.0, depth) for i, depth in enumerate(depths))
    delays = []
    for column, _, changes in WATERS:
        links = runs.links(column, scenario, changes)
        delays.append({depth: links[2 * i + 1, 2 * i + 2]["delay_s"] for i, depth in enumerate(depths)})
    mean, harris, _ = delays
    travel = packet_delays(runs)
    comparisons = [Comparison("4", f"delay at {depth:g} m, s", expected, mean[depth], 5e-7) for depth, expected in EXPECTED.items()]
    comparisons += [Comparison("4", f"travel time of a packet at {depth:g} m, s", expected, travel[depth], 5e-7)
                    for depth, expected in EXPECTED.items()]
    comparisons.append(Comparison("4", "depth of the greatest delay, m", 950, max(mean, key=mean.get), 0))
    comparisons += [Comparison("4", f"delay at {depth:g} m, Harris and Zorzi, s", expected, harris[depth], 6e-13, digits=12)
                    for depth, expected in PUBLISHED.items()]
    for (column, name, _), got in zip(WATERS, delays):
        comparisons.append(greatest_difference("4", f"delay, {name}", [(row[column], got[row["depth_m"]]) for row in table], 1e-12, True))
    return Figure("figure4", ("depth_m", *(column for column, _, _ in WATERS)),
                  [(depth, *(of_water[depth] for of_water in delays)) for depth in depths],
                  [(s, depth) for expected in (EXPECTED, PUBLISHED) for depth, s in expected.items()]
                  + [(row[column], row["depth_m"]) for column, _, _ in WATERS for row in table], comparisons)
