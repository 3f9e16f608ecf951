// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/sea/pressure.h"

#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

constexpr double kDecibarPerMegapascal = 100;

double squared_sine(double angle_rad) {
  const double s = elementary::sin(angle_rad);
  return s * s;
}

}  // namespace

double standard_ocean_pressure_dbar(double depth_m, double latitude_rad) {
  const double z = depth_m;
  // Pressure at 45 degrees latitude, h(Z, 45), MPa (Leroy and Parthiot 1998, equation 3).
  const double h45 = (((2.8e-19 * z - 1.25e-13) * z + 2.465e-8) * z + 1.00818e-2) * z;
  // k(Z, phi) of equation 4: gravity at the latitude over gravity at 45 degrees, both varying with depth.
  const double gravity = 9.7803 * (1 + 5.3e-3 * squared_sine(latitude_rad));
  const double k = (gravity - 2e-5 * z) / (9.80612 - 2e-5 * z);
  return h45 * k * kDecibarPerMegapascal;
}

double common_oceans_pressure_dbar(double depth_m, double latitude_rad) {
  const double z = depth_m;
  const double correction_mpa = 1e-2 * z / (z + 100) + 6.2e-6 * z;  // MPa; table II, "common oceans"
  return standard_ocean_pressure_dbar(depth_m, latitude_rad) - correction_mpa * kDecibarPerMegapascal;
}

double pressure_atm_absolute(double depth_m, double latitude_rad) {
  return 1 + standard_ocean_pressure_dbar(depth_m, latitude_rad) / kDecibarPerAtmosphere;
}

}  // namespace halocline::acoustics
