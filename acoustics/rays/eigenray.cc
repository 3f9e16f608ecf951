#include "acoustics/rays/eigenray.h"

#include <cmath>
#include <vector>

#include "acoustics/rays/arc_tracer.h"
#include "acoustics/rays/image_rays.h"
#include "acoustics/rays/layered_rays.h"
#include "acoustics/rays/profile_rays.h"
#include "core/check.h"

namespace halocline::acoustics {
namespace {

FlatSea flat_sea(const RaySea& sea, const RayLink& link) {
  return {sea.water, sea.bottom_profile.depth_at(link.range_m), sea.bottom, sea.surface, sea.options};
}

ProfiledSea profiled_sea(const RaySea& sea) {
  return {sea.water, sea.bottom_profile, sea.bottom, sea.surface, sea.options};
}

std::vector<Arrival> search(const RaySea& sea, const RayLink& link, RaySolver solver) {
  switch (solver) {
    case RaySolver::kImages:
      return image_rays(flat_sea(sea, link), link);
    case RaySolver::kSnell:
      return layered_rays(flat_sea(sea, link), link);
    case RaySolver::kArcs:
      return profile_rays(profiled_sea(sea), link);
  }
  return {};
}

// The solvers find paths that do not bounce at every angle.
std::vector<Arrival> within_launch_limit(std::vector<Arrival> paths, const RayOptions& options) {
  if (!options.keep_steep_direct) {
    std::erase_if(paths, [limit = options.max_launch_angle_rad](const Arrival& path) {
      return std::abs(path.launch_angle_rad) > limit;
    });
  }
  return paths;
}

}  // namespace

RayWater ray_water(const Environment& environment, double frequency_hz, double thinning_tolerance_mps) {
  const double khz = hz_to_khz(frequency_hz);
  const auto absorption = [&](double depth_m) {
    return absorption_spectrum_at(environment, depth_m).db_per_km(khz * khz);
  };
  RayWater water = RayWater::from_profile(environment.profile, absorption);
  if (thinning_tolerance_mps <= 0) return water;
  return RayWater(thinned(knots_of(water), thinning_tolerance_mps), absorption);
}

RaySolver choose_solver(const RaySea& sea, const RayLink& link) {
  if (!sea.bottom_profile.is_flat_until(link.range_m)) return RaySolver::kArcs;
  const bool one_speed = sea.water.is_isovelocity_above(sea.bottom_profile.depth_at(link.range_m));
  return one_speed ? RaySolver::kImages : RaySolver::kSnell;
}

Arrivals arrivals(const RaySea& sea, const RayLink& link, std::optional<RaySolver> solver) {
  require(!solver || *solver == RaySolver::kArcs || sea.bottom_profile.is_flat_until(link.range_m),
          "the ray solvers 'images' and 'snell' need a flat bottom");
  const RaySolver chosen = solver.value_or(choose_solver(sea, link));
  return {chosen, within_launch_limit(search(sea, link, chosen), sea.options)};
}

}  // namespace halocline::acoustics
