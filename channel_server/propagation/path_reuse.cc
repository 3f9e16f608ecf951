// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/propagation/path_reuse.h"

#include <algorithm>
#include <cmath>

#include "acoustics/rays/extrapolate_eigenrays.h"

namespace halocline::channel_server {
namespace {

constexpr double kMinCellsOfALink = 20;
constexpr int kMaxHalvings = 6;

double middle(double value, double cell) { return cell * (std::floor(value / cell) + 0.5); }

// True when the depth equals, to the last bit, a depth at which the gradient of sound speed jumps. Bits agree
// when the profile and the depth of a mooring are stated in one scenario.
bool is_knot(const acoustics::RayWater& water, double depth_m) {
  return depth_m > 0 && std::binary_search(water.depths_m().begin(), water.depths_m().end(), depth_m);
}

double searched_depth_m(const acoustics::RayWater& water, double depth_m, double middle_m) {
  return is_knot(water, depth_m) ? depth_m : std::min(middle_m, kDeepestEndM);
}

// Returns the sound speeds at the ends of the query's link, from `water` or the field, m/s.
acoustics::EndSpeeds end_speeds(const acoustics::RayWater& water, const acoustics::Environment& environment,
                                const PathQuery& query) {
  const double source_m = query.link.source_depth_m, receiver_m = query.link.receiver_depth_m;
  if (!environment.field) return {water.speed_at(source_m), water.speed_at(receiver_m)};
  const auto [north, east, last_north, last_east] = query.places;
  return {sound_speed_at(environment, {north, east, source_m + environment.sea_surface_z_m}),
          sound_speed_at(environment, {last_north, last_east, receiver_m + environment.sea_surface_z_m})};
}

}  // namespace

std::optional<acoustics::RayLink> middle_of_cell(const acoustics::RayLink& link, double distance_m) {
  double cell = distance_m;
  for (int halvings = 0; link.range_m < kMinCellsOfALink * cell; ++halvings, cell /= 2) {
    if (halvings == kMaxHalvings) return std::nullopt;
  }
  const double height = cell / kDepthsCount;
  return acoustics::RayLink{middle(link.source_depth_m, height), middle(link.receiver_depth_m, height),
                            middle(link.range_m, cell)};
}

PathQuery query_of_cell(PathQuery query, const acoustics::RayWater& water, double distance_m) {
  const acoustics::RayLink link = query.link;
  const auto cell = middle_of_cell(link, distance_m);
  if (!cell) return query;
  query.link = {searched_depth_m(water, link.source_depth_m, cell->source_depth_m),
                searched_depth_m(water, link.receiver_depth_m, cell->receiver_depth_m), cell->range_m};
  for (double& place_m : query.places) place_m = std::round(place_m / distance_m) * distance_m;
  return query;
}

std::optional<acoustics::Eigenrays> reused_eigenrays(const acoustics::RayLink& link,
                                                     const PathQuery& searched,
                                                     const acoustics::RayWater& water,
                                                     const acoustics::Environment& environment,
                                                     const acoustics::Eigenrays& found) {
  const acoustics::RayLink& from = searched.link;
  const bool itself = from.range_m == link.range_m && from.source_depth_m == link.source_depth_m &&
                      from.receiver_depth_m == link.receiver_depth_m;
  if (itself) return std::nullopt;
  const acoustics::EndSpeeds speeds = end_speeds(water, environment, searched);
  return acoustics::Eigenrays{found.solver, extrapolate_eigenrays(found.paths, from, speeds, link)};
}

}  // namespace halocline::channel_server
