// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/link/line_means.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "acoustics/math/gauss_legendre.h"
#include "acoustics/sea/absorption.h"
#include "acoustics/sea/pressure.h"
#include "acoustics/sea/sound_speed.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "core/check.h"
#include "core/units.h"
#include "ocean/ocean_field.h"

namespace halocline::acoustics {
namespace {

// North, east and depth below the surface, the depth clamped to the water.
Vec3 in_water(const Environment& environment, const Vec3& ned_m) {
  const double depth_m = depth_below_surface_m(ned_m, environment.sea_surface_z_m);
  return {ned_m.x(), ned_m.y(), std::clamp(depth_m, 0.0, kDeepestWater)};
}

// Slowness and absorption at one place.
LineMeans water_at(const Environment& environment, const Vec3& place, double khz_squared) {
  const ocean::WaterAtDepth water = environment.field.ocean->water_at(place, environment.field.time_s);
  const double speed_mps = sound_speed_mps(environment.profile.model(), water.temperature_degc,
                                           water.salinity_psu, place.z(), environment.latitude_rad) +
                           environment.profile.change_mps(place.z());
  const AbsorptionSpectrum absorption = absorption_spectrum_in(
      environment, {.temperature_degc = water.temperature_degc,
                    .salinity_psu = water.salinity_psu,
                    .depth_m = place.z(),
                    .pressure_atm = pressure_atm_absolute(place.z(), environment.latitude_rad),
                    .ph = environment.ph});
  return {1 / speed_mps, absorption.db_per_km(khz_squared)};
}

}  // namespace

LineMeans means_along(const Environment& environment, const Vec3& from_ned_m, const Vec3& to_ned_m,
                      double frequency_hz) {
  ensure(bool(environment.field), "the line between places of a sea without a field");
  const GaussLegendreRule& rule = gauss_legendre_5();
  // The ends are put in a fixed order, so that both directions give the same bits.
  const auto before = [](const Vec3& a, const Vec3& b) {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
  };
  Vec3 from = in_water(environment, from_ned_m), to = in_water(environment, to_ned_m);
  if (before(to, from)) std::swap(from, to);
  const double khz_squared = hz_to_khz(frequency_hz) * hz_to_khz(frequency_hz);
  std::vector<double> shares = environment.field.ocean->crossings(from, to);
  shares.push_back(1);
  LineMeans means;
  double start = 0;
  for (const double end : shares) {
    const double half = (end - start) / 2;
    for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
      const Vec3 place = from + (start + half * (1 + rule.nodes[i])) * (to - from);
      const LineMeans there = water_at(environment, place, khz_squared);
      means.slowness_s_per_m += rule.weights[i] * half * there.slowness_s_per_m;
      means.absorption_db_per_km += rule.weights[i] * half * there.absorption_db_per_km;
    }
    start = end;
  }
  return means;
}

}  // namespace halocline::acoustics
