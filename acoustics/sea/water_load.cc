// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/sea/water_load.h"

#include <cmath>
#include <numbers>

namespace halocline::acoustics {
namespace {

constexpr double kQuartzKgM3 = 2650, kQuartzRatio = 2.65;  // density; over the water's (s)
constexpr double kViscosityM2S = 1.3e-6, kSpeedMps = 1500;

// Urick 1948: nepers of power a metre, for a share of the volume of 1.
double nepers_per_m(double frequency_hz, double radius_m) {
  const double omega = 2 * std::numbers::pi * frequency_hz, k = omega / kSpeedMps;
  const double ba = std::sqrt(omega / (2 * kViscosityM2S)) * radius_m;
  const double q = 9 / (4 * ba) * (1 + 1 / ba), inertia = kQuartzRatio + 0.5 + 9 / (4 * ba);
  const double excess = kQuartzRatio - 1, ka = k * radius_m;
  return k * excess * excess * q / (q * q + inertia * inertia) + k * ka * ka * ka / 3;
}

}  // namespace

double WaterLoad::db_per_km(double frequency_hz) const {
  if (particles_kg_m3 == 0) return plants_db_per_km;
  constexpr double kDbPerKmPerNeper = 1e4 / std::numbers::ln10;  // for nepers of power a metre
  return plants_db_per_km +
         kDbPerKmPerNeper * particles_kg_m3 / kQuartzKgM3 * nepers_per_m(frequency_hz, particle_radius_m);
}

}  // namespace halocline::acoustics
