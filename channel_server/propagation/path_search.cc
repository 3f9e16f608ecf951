#include "channel_server/propagation/path_search.h"

#include <cmath>

#include "acoustics/rays/eigenray.h"
#include "acoustics/sea/bottom_profile.h"
#include "channel_server/propagation/ray_limits.h"
#include "core/check.h"

namespace halocline::channel_server {
namespace {

constexpr double kMinCellsOfALink = 20;
constexpr int kMaxHalvings = 6;
constexpr double kDepthShare = 0.1;  // height of a cell over its length

double middle(double value, double cell) { return cell * (std::floor(value / cell) + 0.5); }

}  // namespace

void validate(const RayModel& model) {
  validate(model.bottom);
  validate(model.options);
  validate(model.fading);
  validate(model.reverberation);
  require_in_range(model.speed_tolerance_mps, 0, 1, "tolerance of sound speed for rays", "m/s");
  require_in_range(model.diffuse_below_noise.value, -100, 100, "level of diffuse sound below the noise",
                   "dB");
  require_in_range(model.reuse_distance_m, 0, 1000, "distance of reuse of paths", "m");
  require_in_range(model.profile_reuse_distance_m, 0.1, 1000, "distance of reuse of bottom profiles", "m");
}

std::shared_ptr<const FoundPaths> search_paths(const RayModel& model, const acoustics::RayWater& water,
                                               const acoustics::Environment& environment,
                                               const PathQuery& query, const SeabedProfile& seabed) {
  acoustics::RayOptions options = model.options;
  options.frequency_hz = query.frequency_hz;
  options.diffuse_below_pressure = query.diffuse_below_pressure;
  const acoustics::BottomProfile bottom = bottom_under(seabed, query.link, environment.sea_surface_z_m);
  const double depth_m = mean_depth_m(bottom, query.link.range_m);
  if (model.bounces_follow_range) options.max_bounces = bounces_for(query.link.range_m, depth_m);
  const acoustics::RaySea sea{water, bottom, model.bottom,
                              acoustics::RaySurface{model.surface, environment.noise.wind_mps}, options};
  auto found = std::make_shared<FoundPaths>();
  found->given = query.given;
  found->mean_depth_m = depth_m;
  found->arrivals = arrivals(sea, query.link, usable_solver(model.solver, sea, query.link));
  found->blocked = cuts_straight_line(sea.bottom_profile, query.link);
  return found;
}

std::optional<acoustics::RayLink> middle_of_cell(const acoustics::RayLink& link, double distance_m) {
  double cell = distance_m;
  for (int halvings = 0; link.range_m < kMinCellsOfALink * cell; ++halvings, cell /= 2) {
    if (halvings == kMaxHalvings) return std::nullopt;
  }
  const double height = kDepthShare * cell;
  return acoustics::RayLink{middle(link.source_depth_m, height), middle(link.receiver_depth_m, height),
                            middle(link.range_m, cell)};
}

}  // namespace halocline::channel_server
