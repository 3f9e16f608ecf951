// SPDX-License-Identifier: BSD-3-Clause
#include "core/tide.h"

#include <cmath>
#include <numbers>

#include "core/elementary.h"

namespace halocline {
namespace {

using std::numbers::pi;

// Phase of a constituent at a time, reduced to one turn before it is multiplied, so that it stays exact over
// years.
double angle_rad(const TideConstituent& one, double time_s) {
  return 2 * pi * std::fmod(time_s / one.period_s, 1.0) - one.phase_rad;
}

}  // namespace

double Tide::height_m(double time_s) const {
  double height = 0;
  for (const TideConstituent& one : constituents)
    height += one.amplitude_m * elementary::cos(angle_rad(one, time_s));
  return height;
}

double Tide::rate_mps(double time_s) const {
  double rate = 0;
  for (const TideConstituent& one : constituents)
    rate -= one.amplitude_m * 2 * pi / one.period_s * elementary::sin(angle_rad(one, time_s));
  return rate;
}

double Tide::max_rate_mps() const {
  double rate = 0;
  for (const TideConstituent& one : constituents) rate += one.amplitude_m * 2 * pi / one.period_s;
  return rate;
}

}  // namespace halocline
