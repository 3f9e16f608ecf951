// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/propagation/surface_ends.h"

#include <numbers>

#include "acoustics/fading/complex_noise.h"
#include "acoustics/sea/surface/surface_layers.h"
#include "core/frames.h"
#include "core/random.h"

namespace halocline::channel_server {

double SurfaceEnds::share_under_water(VehicleId id, double z_m,
                                      const acoustics::Environment& environment) const {
  if (floating.contains(id)) return 1;
  const auto waves = acoustics::surface_waves(environment.noise.wind_mps);
  return waves.share_under_water(z_m - environment.sea_surface_z_m);
}

bool SurfaceEnds::is_under_water(VehicleId id, double z_m, const acoustics::Environment& environment,
                                 SimTime at) const {
  if (floating.contains(id)) return true;
  const double depth_m = z_m - environment.sea_surface_z_m;
  const auto waves = acoustics::surface_waves(environment.noise.wind_mps);
  if (!(waves.rms_height_m > 0)) return depth_m >= 0;
  constexpr double kHighest = 5;  // in rms heights: the sum of sines reaches no further
  if (depth_m > kHighest * waves.rms_height_m) return true;
  const acoustics::ComplexNoise noise({.seed = identity_of({seed, static_cast<std::uint64_t>(id)}),
                                       .purpose = purpose_of("waves-over-an-end")});
  // The real part of the noise has the variance 1/2.
  const double height = std::numbers::sqrt2 *
                        noise.at(at.seconds(), waves.mean_frequency_radps / (2 * std::numbers::pi)).real();
  return depth_m + height * waves.rms_height_m > 0;
}

double SurfaceEnds::heave_mps(VehicleId id, double z_m, const acoustics::Environment& environment) const {
  if (!heaving.contains(id) && !floating.contains(id)) return 0;
  const auto waves = acoustics::surface_waves(environment.noise.wind_mps);
  return waves.heave_mps(z_m - environment.sea_surface_z_m);
}

}  // namespace halocline::channel_server
