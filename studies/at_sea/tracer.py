# SPDX-License-Identifier: BSD-3-Clause
"""Snell's law through thin layers, and the transponders' places fitted with it. Shares no code with Halocline."""
import bisect
import math
import statistics

from at_sea.surveys import Refusal

OUTLIER_DEVIATIONS = 20


class Water:
    """Layers of one speed each, at most 10 m thick, of a profile that is linear between its rows and constant beyond."""

    def __init__(self, profile):
        profile = [(0.0, profile[0][1])] * (profile[0][0] > 0) + profile + [(12e3, profile[-1][1])] * (profile[-1][0] < 12e3)
        self.tops, self.speeds, self.gradients, self.layers = [], [], [], []  # layers: (thickness m, slowness s/m)
        for (top, above), (bottom, below) in zip(profile, profile[1:]):
            gradient = (below - above) / (bottom - top)
            parts = 1 if gradient == 0 else math.ceil((bottom - top) / 10)
            for part in range(parts):
                self.tops.append(top + (bottom - top) * part / parts)
                self.speeds.append(above + (below - above) * part / parts)
                self.gradients.append(gradient)
                self.layers.append(self.part(-1, self.tops[-1], top + (bottom - top) * (part + 1) / parts))

    def part(self, layer, top, bottom):
        """What lies of a layer between two depths: thickness, and slowness in its middle."""
        return bottom - top, 1 / (self.speeds[layer] + self.gradients[layer] * ((top + bottom) / 2 - self.tops[layer]))

    def between(self, top, bottom):
        first, last = bisect.bisect_right(self.tops, top) - 1, bisect.bisect_left(self.tops, bottom) - 1
        if first == last:
            return [self.part(first, top, bottom)]
        return [self.part(first, top, self.tops[first + 1]), *self.layers[first + 1:last], self.part(last, self.tops[last], bottom)]

    def leg(self, top, bottom, range_m):
        """Time of the ray, and its derivatives by range and by depth of the lower end.

        With q = sqrt(s^2 - p^2) the time is the greatest p X + sum(h q) over p (Fermat); two steps of Newton towards it, from
        the straight line, and the parabola at its top."""
        layers = self.between(top, bottom)
        p = sum(h * s for h, s in layers) / (bottom - top) * range_m / math.hypot(range_m, bottom - top)
        p = min(p, 0.9999 * min(s for _, s in layers))
        for _ in range(2):
            p2, tau, reached, spread = p * p, 0.0, 0.0, 0.0
            for h, s in layers:
                s2 = s * s
                q2 = s2 - p2
                w = h / math.sqrt(q2)
                tau += w * q2
                reached += w
                spread += w * s2 / q2
            miss = range_m - p * reached
            time = p * range_m + tau + 0.5 * miss * miss / spread
            p += miss / spread
        return time, p, math.sqrt(max(layers[-1][1] ** 2 - p * p, 0.0))


def two_way(water, survey, shot, place):
    """Time and its gradient by the transponder's place."""
    total, gradient = 0.0, [0.0, 0.0, 0.0]
    for ship in (shot.sent, shot.received):
        east, north = place[0] - ship[0], place[1] - ship[1]
        range_m = math.hypot(east, north)
        time, along, down = water.leg(survey.depth(ship), survey.depth(place), range_m)
        total += time
        gradient[0] += along * east / max(range_m, 1e-9)
        gradient[1] += along * north / max(range_m, 1e-9)
        gradient[2] -= down
    return total, gradient


def is_sound(residuals):
    middle = statistics.median(residuals)
    bound = OUTLIER_DEVIATIONS * max(1.4826 * statistics.median(abs(r - middle) for r in residuals), 1e-6)
    return [abs(r - middle) <= bound for r in residuals]


def solve(matrix, right):
    rows = [row + [value] for row, value in zip(matrix, right)]
    for i in range(len(rows)):
        pivot = max(range(i, len(rows)), key=lambda r: abs(rows[r][i]))
        rows[i], rows[pivot] = rows[pivot], rows[i]
        for r in range(len(rows)):
            if r != i:
                factor = rows[r][i] / rows[i][i]
                rows[r] = [a - factor * b for a, b in zip(rows[r], rows[i])]
    return [row[-1] / row[i] for i, row in enumerate(rows)]


def steps_to_fit(water, survey, shots, used, place):
    """Least squares over the shots `used`, by Gauss and Newton from `place`: the place, and the residuals of all shots."""
    for _ in range(30):
        computed = [two_way(water, survey, shot, place) for shot in shots]
        residuals = [shot.two_way_s - time for shot, (time, _) in zip(shots, computed)]
        rows = [(r, g) for r, (_, g), use in zip(residuals, computed, used) if use]
        normal = [[sum(g[i] * g[j] for _, g in rows) for j in range(3)] for i in range(3)]
        try:
            step = solve(normal, [sum(g[i] * r for r, g in rows) for i in range(3)])
        except ZeroDivisionError:
            break
        if math.hypot(*step) < 1e-5:
            return place, residuals
        shorten = min(1, 0.3 * survey.depth(place) / math.hypot(*step))
        place = tuple(a + shorten * b for a, b in zip(place, step))
        place = place[:2] + (min(place[2], min(min(s.sent[2], s.received[2]) for s in shots) - 1),)
    raise Refusal(f"{survey.name}: the {len(shots)} shots to transponder {shots[0].transponder} do not fix its place; allowed: a track "
                  "round or across it")


def fit(water, survey, shots, place):
    """The transponder's place, and the mean of the squares left. Shots count that are sound by it."""
    residuals = [shot.two_way_s - two_way(water, survey, shot, place)[0] for shot in shots]
    for _ in range(5):
        used = is_sound(residuals)
        place, residuals = steps_to_fit(water, survey, shots, used, place)
        if is_sound(residuals) == used:
            break
    return place, statistics.fmean(r * r for r, use in zip(residuals, used) if use)


def first_guess(survey, shots):
    nearest = sorted(shots, key=lambda shot: shot.two_way_s)[:max(1, len(shots) // 10)]
    middle = [statistics.fmean(shot.sent[i] for shot in nearest) for i in range(3)]
    return middle[0], middle[1], middle[2] - 0.4 * 1500 * nearest[0].two_way_s


def fit_all(survey, profile, chosen):
    """Places by transponder, and the sum of their mean squares; `chosen` picks the shots to fit from those of one transponder."""
    water, places, squares = Water(profile), {}, 0.0
    for transponder in sorted({shot.transponder for shot in survey.shots}):
        shots = chosen(survey.of(transponder))
        near = survey.places.get(transponder) or survey.guesses.get(transponder)
        if near is None:
            near = first_guess(survey, shots)
            above = [speed for depth, speed in profile if depth <= survey.depth(near)] or [profile[0][1]]
            near = fit(Water([(0.0, statistics.fmean(above))]), survey, shots, near)[0]
        places[transponder], left = fit(water, survey, shots, near)
        squares += left
    return places, squares


def best_speed(survey, chosen):
    """The mean speed that leaves least, by golden section in 1400 to 1600 m/s."""
    low, high, ratio = 1400.0, 1600.0, (math.sqrt(5) - 1) / 2
    left_of = lambda speed: fit_all(survey, [(0.0, speed)], chosen)[1]
    while high - low > 0.01:
        lower, upper = high - ratio * (high - low), low + ratio * (high - low)
        low, high = (low, upper) if left_of(lower) < left_of(upper) else (lower, high)
    return (low + high) / 2
