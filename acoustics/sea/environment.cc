// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/sea/environment.h"

#include <algorithm>
#include <numbers>
#include <utility>
#include <vector>

#include "acoustics/sea/pressure.h"
#include "acoustics/sea/sound_speed.h"
#include "core/check.h"

namespace halocline::acoustics {

void validate(const Environment& environment) {
  require_in_range(environment.noise.shipping, 0, 1, "shipping activity");
  require_in_range(environment.noise.wind_mps, 0, 60, "wind speed", "m/s");
  require_in_range(environment.noise.rain_mm_per_h, 0, 500, "rain", "mm/h");
  require_in_range(environment.spreading_exponent, 1, 2, "spreading exponent");
  require_in_range(environment.ph, 7, 9, "pH");
  require_in_range(environment.latitude_rad, -std::numbers::pi / 2, std::numbers::pi / 2, "latitude", "rad");
  require_in_range(environment.sea_surface_z_m, -100, 100, "z of the sea surface", "m");
  validate(environment.drift);
  require_in_range(environment.load.particles_kg_m3, 0, 100, "mass of particles in the water", "kg/m^3");
  require_in_range(environment.load.particle_radius_m, 1e-7, 1e-3, "radius of the particles", "m");
  require_in_range(environment.load.plants_db_per_km, 0, 1000, "absorption by plants", "dB/km");
  validate(environment.ice);
}

Environment environment_at(const Environment& environment, double north_m, double east_m) {
  Environment there = environment;
  if (!environment.field) return there;
  std::vector<WaterRow> rows;
  for (const auto& [depth_m, temperature_degc, salinity_psu] :
       environment.field.ocean->column_at(north_m, east_m, environment.field.time_s)) {
    rows.push_back({depth_m, temperature_degc, salinity_psu});
  }
  there.profile =
      SoundSpeedProfile::from_water(std::move(rows), environment.profile.model(), environment.latitude_rad);
  const std::vector<SpeedRow>& change = environment.profile.change();
  if (!change.empty()) there.profile = there.profile.with_change(change);
  there.field = {};
  return there;
}

double sound_speed_at(const Environment& environment, const Vec3& position_ned_m) {
  const double depth_m =
      std::clamp(depth_below_surface_m(position_ned_m, environment.sea_surface_z_m), 0.0, kDeepestWater);
  if (!environment.field) return environment.profile.sound_speed_mps(depth_m);
  const ocean::WaterAtDepth water = environment.field.ocean->water_at(
      {position_ned_m.x(), position_ned_m.y(), depth_m}, environment.field.time_s);
  return sound_speed_mps(environment.profile.model(), water.temperature_degc, water.salinity_psu, depth_m,
                         environment.latitude_rad) +
         environment.profile.change_mps(depth_m);
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

AbsorptionSpectrum absorption_spectrum_in(const Environment& environment, const AbsorbingWater& water) {
  AbsorptionSpectrum spectrum = absorption_spectrum(environment.absorption_model, water);
  spectrum.load = environment.load;
  return spectrum;
}

AbsorptionSpectrum absorption_spectrum_at(const Environment& environment, double depth_m) {
  return absorption_spectrum_in(environment, absorbing_water(environment, depth_m));
}

}  // namespace halocline::acoustics
