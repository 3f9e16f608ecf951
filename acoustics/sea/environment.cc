#include "acoustics/sea/environment.h"

#include <algorithm>
#include <numbers>

#include "acoustics/sea/pressure.h"
#include "core/check.h"

namespace halocline::acoustics {

void validate(const Environment& environment) {
  require_in_range(environment.noise.shipping, 0, 1, "shipping activity");
  require_in_range(environment.noise.wind_mps, 0, 60, "wind speed", "m/s");
  require_in_range(environment.spreading_exponent, 1, 2, "spreading exponent");
  require_in_range(environment.ph, 7, 9, "pH");
  require_in_range(environment.latitude_rad, -std::numbers::pi / 2, std::numbers::pi / 2, "latitude", "rad");
  require_in_range(environment.sea_surface_z_m, -100, 100, "z of the sea surface", "m");
}

AbsorbingWater absorbing_water(const Environment& environment, double depth_m) {
  const double depth = std::max(depth_m, 0.0);
  const WaterSample water = environment.profile.water(depth);
  return {.temperature_degc = water.temperature_degc,
          .salinity_psu = water.salinity_psu,
          .depth_m = depth,
          .pressure_atm = pressure_atm_absolute(depth, environment.latitude_rad),
          .ph = environment.ph};
}

AbsorptionSpectrum absorption_spectrum_at(const Environment& environment, double depth_m) {
  return absorption_spectrum(environment.absorption_model, absorbing_water(environment, depth_m));
}

}  // namespace halocline::acoustics
