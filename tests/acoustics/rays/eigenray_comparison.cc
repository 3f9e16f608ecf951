// SPDX-License-Identifier: BSD-3-Clause
#include "tests/acoustics/rays/eigenray_comparison.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdio>
#include <functional>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/units.h"
#include "tests/acoustics/rays/ray_reference.h"

namespace halocline::acoustics {
namespace {

using std::numbers::pi;

bool near(const BruteEigenray& a, const BruteEigenray& b, double degrees) {
  return a.surface == b.surface && a.bottom == b.bottom &&
         std::abs(a.launch_rad - b.launch_rad) <= to_radians(degrees);
}

std::complex<double> phasor(const BruteEigenray& a) {
  return std::polar(a.amplitude, a.phase_rad - 2 * pi * std::fmod(25'000 * a.delay_s, 1.0));
}

std::complex<double> sum_near(const std::vector<BruteEigenray>& all, const BruteEigenray& at) {
  std::complex<double> sum = 0;
  for (const BruteEigenray& one : all) {
    if (near(one, at, 0.02)) sum += phasor(one);
  }
  return sum;
}

int number_near(const std::vector<BruteEigenray>& all, const BruteEigenray& at) {
  return static_cast<int>(
      std::count_if(all.begin(), all.end(), [&](const BruteEigenray& one) { return near(one, at, 0.02); }));
}

std::string describe(const BruteEigenray& a) {
  char text[160];
  std::snprintf(text, sizeof text, "%.9f s %.2f dB phase %.2f launch %.6f arrival %.5f %d+%d caustics %d",
                a.delay_s, 20 * std::log10(a.amplitude), to_degrees(a.phase_rad), to_degrees(a.launch_rad),
                to_degrees(a.arrival_rad), a.surface, a.bottom, a.caustics);
  return text;
}

// Whether `all` has `wanted` alone within the tolerances, or a bundle launched within 0.02 degrees of it sums
// to the same level.
bool has(const std::vector<BruteEigenray>& all, const std::vector<BruteEigenray>& others,
         const BruteEigenray& wanted, ComparisonCount& count) {
  const BruteEigenray* best = nullptr;
  for (const BruteEigenray& one : all) {
    if (!near(one, wanted, 0.01) || std::abs(one.delay_s - wanted.delay_s) > 1e-6) continue;
    if (std::abs(20 * std::log10(one.amplitude / wanted.amplitude)) > 0.05) continue;
    if (best == nullptr ||
        std::abs(one.delay_s - wanted.delay_s) < std::abs(best->delay_s - wanted.delay_s)) {
      best = &one;
    }
  }
  if (best != nullptr) {
    const double phase = degrees_between(to_degrees(best->phase_rad), to_degrees(wanted.phase_rad));
    const double angle = to_degrees(std::abs(best->arrival_rad - wanted.arrival_rad));
    if (phase <= 1 && angle <= 0.01) {
      count.delay_s = std::max(count.delay_s, std::abs(best->delay_s - wanted.delay_s));
      count.level_db =
          std::max(count.level_db, std::abs(20 * std::log10(best->amplitude / wanted.amplitude)));
      count.phase_deg = std::max(count.phase_deg, phase);
      count.angle_deg = std::max(count.angle_deg, angle);
      ++count.matched;
      return true;
    }
  }
  if (number_near(all, wanted) == 0 || number_near(all, wanted) + number_near(others, wanted) < 3)
    return false;
  const double off = 20 * std::log10(std::abs(sum_near(all, wanted)) / std::abs(sum_near(others, wanted)));
  if (std::abs(off) > 0.05) return false;
  ++count.as_sum;
  return true;
}

double loudest(const std::vector<BruteEigenray>& all) {
  double most = 0;
  for (const BruteEigenray& one : all) most = std::max(most, one.amplitude);
  return most;
}

}  // namespace

BruteEigenray brute_of(const Eigenray& a) {
  return {a.delay_s,           a.amplitude,       a.phase_rad,      a.launch_angle_rad,
          a.arrival_angle_rad, a.surface_bounces, a.bottom_bounces, a.caustics};
}

void compare_eigenrays(const std::string& where, const std::vector<BruteEigenray>& found,
                       const std::vector<BruteEigenray>& expected,
                       const std::function<std::optional<BruteEigenray>(double)>& trace,
                       ComparisonCount& count) {
  const double threshold = loudest(expected) * std::pow(10, -30.0 / 20);
  ++count.links;
  for (const BruteEigenray& one : expected) {
    if (one.amplitude < threshold) continue;
    ++count.expected;
    if (has(found, expected, one, count)) continue;
    ++count.missing;
    ADD_FAILURE() << where << "\n  missing " << describe(one);
  }
  ComparisonCount ignored;
  for (const BruteEigenray& one : found) {
    if (one.amplitude < threshold * 1.01 || std::abs(one.launch_rad) > to_radians(79.99)) continue;
    if (one.launch_rad == 0 || has(expected, found, one, ignored)) continue;
    // What the fan has not resolved may be a ray all the same.
    const auto again = trace(one.launch_rad);
    if (again && has({*again}, found, one, ignored)) {
      ++count.confirmed;
      continue;
    }
    ++count.extra;
    ADD_FAILURE() << where << "\n  extra   " << describe(one);
  }
}

void print(const std::string& name, const ComparisonCount& count) {
  std::printf(
      "%s: %d links, %d eigenrays within 30 dB, %d matched, %d as a sum, %d missing, %d extra, %d not "
      "resolved by the fan but confirmed; largest errors "
      "%.2g s, %.2g dB, %.2g deg of phase, %.2g deg\n",
      name.c_str(), count.links, count.expected, count.matched, count.as_sum, count.missing, count.extra,
      count.confirmed, count.delay_s, count.level_db, count.phase_deg, count.angle_deg);
}

}  // namespace halocline::acoustics
