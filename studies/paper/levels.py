# SPDX-License-Identifier: BSD-3-Clause
"""Figures 6 and 7: received level and capacity over range, 100 m deep, for source levels of 60 to 120 dB.

The paper states neither band nor noise nor water; 22.5 to 27.5 kHz, shipping 0.5, no wind, practical spreading and the global mean profile are
assumed.
"""
from paper.comparison import Comparison, Figure, greatest_difference, reference
from paper.runs import traffic, vehicle

TABLE = "fig6_fig7_100m_depth.csv"
LEVELS_DB = range(60, 121, 10)
RANGES_M = range(4, 181, 4)
LAST_DIGIT_DB = 5e-4
SEA = """
[scenario]
name = "figure6"
duration_s = 5
origin_latitude_deg = 45 # pressure at a depth depends on it; the reference values are for 45 degrees
[terrain.flat]
depth_m = 1000
[environment]
profile = "global-mean"
wind_mps = 0
absorption_model = "fisher-simmons" # the paper's
shipping = 0.5
spreading_exponent = 1.5
[propagation]
model = "straight" # the paper's
fading = "none"
[modem]
center_frequency_hz = 25000
bandwidth_hz = 5000
cutoff_level_db = 20
"""


def rows_by_level_and_range(runs, name, changes=(), ranges_m=RANGES_M):
    """Links by (source level, range)."""
    scenario = SEA + "".join(vehicle(level, 0.0, 100.0, source_level_db=float(level)) for level in LEVELS_DB)
    scenario += "".join(vehicle(1000 + range_m, float(range_m), 100.0) for range_m in ranges_m)
    links = runs.links(name, scenario, changes)
    return {(level, range_m): links[level, 1000 + range_m] for level in LEVELS_DB for range_m in ranges_m}


def comparisons_with_table(runs):
    """Every row of the table: three modems, with and without wind."""
    table, cases = reference(TABLE), {}
    for row in table:
        cases.setdefault((row["f_lo_kHz"], row["f_hi_kHz"], row["wind_m_per_s"]), []).append(row)
    losses, levels, capacities = [], [], []
    for number, ((low_khz, high_khz, wind_mps), rows) in enumerate(cases.items()):
        links = rows_by_level_and_range(runs, f"levels-{number}", (
            f"environment.wind_mps={wind_mps}", f"modem.center_frequency_hz={500 * (low_khz + high_khz)}",
            f"modem.bandwidth_hz={1000 * (high_khz - low_khz)}"), sorted({int(row["range_m"]) for row in rows}))
        for row in rows:
            link = links[int(row["Ptx_dB_re_1uPa_at_1m"]), int(row["range_m"])]
            losses.append((row["TL_fc_dB"], link["transmission_loss_db"]))
            levels.append((row["Prx_fc_dB_re_1uPa"], link["received_level_db"]))
            capacities.append((row["C_eq8_bit_per_s"], link["capacity_bps"]))
    return ([greatest_difference("6", "transmission loss, three modems, dB", losses, 1e-10),
             greatest_difference("6", "received level, three modems, dB", levels, 1e-10)],
            [greatest_difference("7", "capacity, three modems", capacities, 1e-9, True)])


def packet_level_db(runs):
    """Of a packet of 120 dB at 4 m."""
    scenario = SEA + vehicle(1, 0.0, 100.0, source_level_db=120.0) + traffic(1, 2) + vehicle(2, 4.0, 100.0)
    (outcome,) = runs.messages("figure6", scenario, "OUTCOME")["outcome"]
    return float(outcome["received_level_db"])


def figures_6_and_7(runs):
    links = rows_by_level_and_range(runs, "levels")
    near, far = links[120, 4], links[60, 180]
    level_rows, capacity_rows = comparisons_with_table(runs)
    levels = [Comparison("6", f"{what}, dB", expected, got, LAST_DIGIT_DB) for what, expected, got in (
        ("transmission loss at 4 m", 9.045, near["transmission_loss_db"]),
        ("transmission loss at 180 m", 34.459, far["transmission_loss_db"]),
        ("received level, 120 dB at 4 m", 110.955, near["received_level_db"]),
        ("the same, of a packet", 110.955, packet_level_db(runs)),
        ("received level, 60 dB at 180 m", 25.541, far["received_level_db"]))] + level_rows
    capacities = [Comparison("7", "capacity, 120 dB at 4 m, bit/s", 85770, near["capacity_bps"], 5),
                  Comparison("7", "capacity, 60 dB at 180 m, bit/s", 3.0, far["capacity_bps"], 0.05, digits=3)] + capacity_rows
    columns = ("range_m", *(f"source_level_{level}_db" for level in LEVELS_DB))

    def curves(column):
        return [(range_m, *(links[level, range_m][column] for level in LEVELS_DB)) for range_m in RANGES_M]

    def marks(column):
        return [(row["range_m"], row[column]) for row in reference(TABLE) if row["f_lo_kHz"] == 22.5 and row["wind_m_per_s"] == 0]

    return [Figure("figure6", columns, curves("received_level_db"), [(4, 110.955), (180, 25.541), *marks("Prx_fc_dB_re_1uPa")], levels),
            Figure("figure7", columns, curves("capacity_bps"), [(4, 85770), (180, 3.0), *marks("C_eq8_bit_per_s")], capacities)]
