# SPDX-License-Identifier: BSD-3-Clause
"""Stojanovic's best band and its capacity over distance.

Link tables of modems 1 Hz wide give loss A and noise N over frequency. The band is where A N stays within 3 dB of its minimum, the
source level that of a flat spectrum for a mean SNR of 20 dB. Modems of this band and level are run then: their capacity is the result.
"""
import bisect
import math

from paper.comparison import Comparison, Figure, reference
from paper.runs import vehicle

TABLE = "stojanovic2006_k1p5_s0p5_w0_snr20.csv"
RANGES_KM = (0.5, 0.7, 1, 1.5, 2, 3, 5, 7, 10, 15, 20, 30, 50)
FREQUENCIES_HZ = tuple(400 * 1.04 ** i for i in range(130))  # to 63 kHz
SNR = 100
WATER = """
[scenario]
name = "bands"
duration_s = 3
[terrain]
size_north_m = 120000
spacing_m = 1000
[terrain.flat]
depth_m = 1000
[environment]
profile = "isovelocity"
absorption_model = "thorp-piecewise" # hers
wind_mps = 0
shipping = 0.5
spreading_exponent = 1.5
[propagation]
model = "straight"
fading = "none"
"""
RECEIVER = {"center_frequency_hz": 50000.0, "bandwidth_hz": 99900.0}


def ratio(db):
    return 10 ** (db / 10)


class Spectrum:
    """A level over frequency, dB: cubic in the logarithm of frequency through the four nearest values."""

    def __init__(self, levels_db):
        self._x, self._y = [math.log(f) for f in FREQUENCIES_HZ], levels_db

    def __call__(self, frequency_hz):
        x = math.log(frequency_hz)
        first = min(max(bisect.bisect(self._x, x) - 2, 0), len(self._x) - 4)
        near = range(first, first + 4)
        return sum(self._y[i] * math.prod((x - self._x[j]) / (self._x[i] - self._x[j]) for j in near if j != i) for i in near)


def where_it_turns(inside, outside, holds):
    """The place between a frequency where `holds` and one where it does not."""
    for _ in range(60):
        middle = math.sqrt(inside * outside)
        inside, outside = (middle, outside) if holds(middle) else (inside, middle)
    return inside


def mean_over(low_hz, high_hz, function):
    """By Simpson's rule."""
    n = 400
    weights = [1 if i in (0, n) else 4 if i % 2 else 2 for i in range(n + 1)]
    return sum(w * function(low_hz + (high_hz - low_hz) * i / n) for i, w in enumerate(weights)) / (3 * n)


def best_band(loss, noise):
    """Optimum frequency, edges, source level, dB."""
    def both(f):
        return loss(f) + noise(f)

    first, last = FREQUENCIES_HZ[0], FREQUENCIES_HZ[-1]
    step = 1 + 1e-5
    optimum = where_it_turns(first, last, lambda f: both(f * step) < both(f / step))
    level = both(optimum) + 10 * math.log10(2)
    low, high = (where_it_turns(optimum, edge, lambda f: both(f) <= level) for edge in (first, last))
    noise_mean = mean_over(low, high, lambda f: ratio(noise(f)))
    gain_mean = mean_over(low, high, lambda f: ratio(-loss(f)))
    return optimum, low, high, 10 * math.log10(SNR * noise_mean / gain_mean * (high - low))


def best_bands(runs):
    """By range, km."""
    scenario = WATER + "".join(vehicle(i + 1, 0.0, 100.0, center_frequency_hz=f, bandwidth_hz=1.0) for i, f in enumerate(FREQUENCIES_HZ))
    scenario += "".join(vehicle(1001 + i, 1000.0 * km, 100.0, **RECEIVER) for i, km in enumerate(RANGES_KM))
    links = runs.links("spectra", scenario)
    bands = {}
    for i, km in enumerate(RANGES_KM):
        rows = [links[j + 1, 1001 + i] for j in range(len(FREQUENCIES_HZ))]
        bands[km] = best_band(Spectrum([row["transmission_loss_db"] for row in rows]), Spectrum([row["noise_level_db"] for row in rows]))
    return bands


def capacities_bps(runs, bands):
    scenario = WATER
    for i, (km, (_, low, high, level)) in enumerate(bands.items()):
        scenario += vehicle(i + 1, 0.0, 100.0, center_frequency_hz=(low + high) / 2, bandwidth_hz=high - low, source_level_db=level)
        scenario += vehicle(1001 + i, 1000.0 * km, 100.0, **RECEIVER)
    links = runs.links("bands", scenario)
    return {km: links[i + 1, 1001 + i]["capacity_bps"] for i, km in enumerate(bands)}


def bands_over_distance(runs):
    bands = best_bands(runs)
    capacities = capacities_bps(runs, bands)
    comparisons, marks = [], []
    for row in reference(TABLE):
        km = row["range_km"]
        optimum, low, high, level = bands[km]
        at = f"at {km:g} km"
        comparisons += [
            Comparison("bands", f"best frequency {at}, kHz", row["f_opt_kHz"], optimum / 1000, 1e-4, True),
            Comparison("bands", f"3 dB band {at}, Hz", row["B3_Hz"], high - low, 1e-5, True),
            Comparison("bands", f"source level {at}, dB", row["P3_dB_re_1uPa"], level, 1e-4),
            Comparison("bands", f"capacity {at}, bit/s", row["C3_bit_per_s"], capacities[km], 1e-5, True)]
        marks += [(km, row["B3_Hz"] / 1000), (km, row["C3_bit_per_s"] / 1000)]
    return Figure("bands", ("range_km", "best_frequency_hz", "lower_edge_hz", "upper_edge_hz", "bandwidth_hz", "source_level_db",
                            "capacity_bps"),
                  [(km, optimum, low, high, high - low, level, capacities[km]) for km, (optimum, low, high, level) in bands.items()],
                  marks, comparisons)
