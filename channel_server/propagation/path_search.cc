// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/propagation/path_search.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "acoustics/link/energy_flux.h"
#include "acoustics/rays/depth_fan.h"
#include "acoustics/rays/range_fan.h"
#include "acoustics/rays/search/eigenray_search.h"
#include "acoustics/sea/surface/surface_boundary.h"
#include "core/check.h"
#include "core/hash.h"

namespace halocline::channel_server {
namespace {

constexpr double kEvenM = 0.5;      // a bottom at least this uneven permits energy flux, m
constexpr double kRounding = 1e-6;  // m

acoustics::RayOptions options_of(const RayModel& model, const PathQuery& query) {
  acoustics::RayOptions options = model.options;
  options.frequency_hz = query.frequency_hz;
  options.diffuse_below_pressure = query.diffuse_below_pressure;
  return options;
}

// Traced paths of several bounces keep their coherent share alone where sound turns.
acoustics::BounceScattering scattering_of(const RayModel& model, const acoustics::Environment& environment,
                                          double frequency_hz) {
  const acoustics::SurfaceBoundary surface =
      surface_boundary(environment.noise.wind_mps, environment.ice, frequency_hz);
  return {acoustics::rayleigh_squares(surface.rms_height_m, frequency_hz, 1),
          acoustics::rayleigh_squares(model.fading.bottom_roughness_m, frequency_hz, 1)};
}

// Variance of the slope of the seabed's samples between the ends of a link about its mean.
double mean_square_slope(const SeabedProfile& seabed, double range_m) {
  SlopeSums sums;
  for (std::size_t i = 0; i + 1 < seabed.z_m.size(); ++i) {
    const double middle_m = seabed.first_m + (static_cast<double>(i) + 0.5) * seabed.spacing_m;
    if (middle_m < 0 || middle_m > range_m) continue;
    const double slope = (seabed.z_m[i + 1] - seabed.z_m[i]) / seabed.spacing_m;
    sums.count += 1;
    sums.sum += slope;
    sums.squares += slope * slope;
  }
  return sums.variance();
}

// Depths at equal distances between the ends, each below both ends' own depth there.
std::array<double, 16> depths_along(const acoustics::BottomProfile& bottom, double range_m) {
  std::array<double, 16> depths{};
  for (std::size_t i = 0; i < depths.size(); ++i) {
    const double place = (static_cast<double>(i) + 0.5) / static_cast<double>(depths.size());
    depths[i] = std::max(bottom.depth_at(range_m * place), kMinWaterM);
  }
  return depths;
}

std::shared_ptr<const SearchResult> result_over(const RayModel& model, const PathSea& along,
                                                const PathQuery& query, const SeabedProfile& seabed,
                                                acoustics::SharedRays* shared) {
  auto found = std::make_shared<SearchResult>();
  found->given = query.given;
  found->mean_depth_m = along.mean_depth_m;
  found->eigenrays =
      eigenrays(along.sea, query.link, usable_solver(model.solver, along.sea, query.link), shared);
  if (model.turned) {
    const acoustics::RaySea& sea = along.sea;
    found->eigenrays.paths = model.turned->with_turned_sound(
        {sea.water, sea.bottom, sea.surface, model.fading, query.frequency_hz, query.link,
         depths_along(sea.bottom_profile, query.link.range_m), mean_square_slope(seabed, query.link.range_m),
         model.options.fine_structure},
        std::move(found->eigenrays.paths));
  }
  found->blocked = cuts_straight_line(along.sea.bottom_profile, query.link);
  found->beyond_terrain = seabed.beyond_terrain;
  return found;
}

}  // namespace

acoustics::RaySurface surface_of(const RayModel& model, const acoustics::Environment& environment) {
  return {model.surface, environment.noise.wind_mps, environment.ice};
}

std::uint64_t PathQuery::hash_of_places() const {
  std::array<double, 7> all{
      places[0], places[1], places[2], places[3], link.source_depth_m, link.receiver_depth_m, link.range_m};
  for (double& one : all) one += 0.0;  // -0 becomes 0: both hash alike
  return xxh3(std::bit_cast<std::array<std::uint8_t, sizeof all>>(all));
}

int bounces_for(double range_m, double depth_m) {
  constexpr double kMin = 60, kMax = 10'000, kSlope = 0.6;
  const double bounces = std::ceil(kSlope * range_m / depth_m);
  return static_cast<int>(std::clamp(bounces, kMin, kMax));
}

double mean_depth_m(const acoustics::BottomProfile& bottom, double range_m) {
  constexpr int kPlaces = 16;
  double sum = 0;
  for (int i = 0; i < kPlaces; ++i) sum += bottom.depth_at(range_m * (i + 0.5) / kPlaces);
  return sum / kPlaces;
}

std::optional<acoustics::RaySolver> usable_solver(std::optional<acoustics::RaySolver> wanted,
                                                  const acoustics::RaySea& sea,
                                                  const acoustics::RayLink& link) {
  using Solver = acoustics::RaySolver;
  const Solver simplest = choose_solver(sea, link);
  if (!wanted || *wanted == Solver::kArcs || simplest == Solver::kImages) return wanted;
  return *wanted == Solver::kSnell && simplest == Solver::kSnell ? wanted : simplest;
}

Decibels gain_beyond_powers(const RayModel& model, const acoustics::Environment& environment) {
  double gain_db = 0;
  if (model.coherent) {
    gain_db += 10;
  } else if (model.fading.enabled) {
    gain_db += 3;
  }
  if (model.reverberation.enabled) gain_db += 10;
  if (environment.spreading_exponent < 1.5) gain_db += 6;
  if (turns_sound(model)) gain_db += 2;
  return Decibels{gain_db};
}

void validate(const RayModel& model) {
  validate(model.bottom);
  validate(model.options);
  validate(model.fading);
  validate(model.reverberation);
  require_in_range(model.speed_tolerance_mps, 0, 1, "tolerance of sound speed for rays", "m/s");
  require_in_range(model.diffuse_below_noise.value, -100, 100, "level of diffuse sound below the noise",
                   "dB");
  require_in_range(model.weak_below_diffuse.value, -100, 100, "level of weak links below diffuse sound",
                   "dB");
  require_in_range(model.greatest_depth_m, 0, acoustics::kDeepestWater, "greatest depth of the water", "m");
  require_in_range(model.least_depth_m, 0, model.greatest_depth_m, "least depth of the water", "m");
  require_in_range(model.reuse_distance_m, 0, 1000, "distance of reuse of paths", "m");
}

RayModel with_turned_seas(RayModel model) {
  if (turns_sound(model) && !model.turned) model.turned = std::make_shared<const TurnedSeas>();
  return model;
}

acoustics::LinkWater water_along(const RayModel& model, const acoustics::RayWater& water,
                                 const acoustics::Environment& environment, const PathQuery& query,
                                 double deepest_m) {
  if (!environment.field) return {water, nullptr};
  const auto [north, east, last_north, last_east] = query.places;
  return water_between(environment, {north, east, 0}, {last_north, last_east, 0}, deepest_m,
                       query.frequency_hz, model.speed_tolerance_mps);
}

PathSea path_sea(const RayModel& model, const acoustics::RayWater& water,
                 const acoustics::Environment& environment, const PathQuery& query,
                 const SeabedProfile& seabed) {
  acoustics::RayOptions options = options_of(model, query);
  const acoustics::BottomProfile bottom = bottom_under(seabed, query.link, environment.sea_surface_z_m);
  const double depth_m = mean_depth_m(bottom, query.link.range_m);
  if (model.bounces_follow_range) options.max_bounces = bounces_for(query.link.range_m, depth_m);
  if (model.turned) options.scattering = scattering_of(model, environment, query.frequency_hz);
  const acoustics::LinkWater along = water_along(model, water, environment, query, bottom.deepest_m());
  return {{along.water, bottom, model.bottom, surface_of(model, environment), options, along.section},
          depth_m};
}

std::shared_ptr<const SearchResult> search_paths(const RayModel& model, const acoustics::RayWater& water,
                                                 const acoustics::Environment& environment,
                                                 const PathQuery& query, const SeabedProfile& seabed) {
  return result_over(model, path_sea(model, water, environment, query, seabed), query, seabed, nullptr);
}

std::shared_ptr<const SearchResult> PathLine::search(const RayModel& model, const acoustics::RayWater& water,
                                                     const acoustics::Environment& environment,
                                                     const PathQuery& query, const SeabedProfile& seabed,
                                                     acoustics::SharedRays* shared) {
  if (!sea_) {
    PathQuery at_surface = query;
    at_surface.link.source_depth_m = at_surface.link.receiver_depth_m = 0;
    sea_ = std::make_unique<const PathSea>(path_sea(model, water, environment, at_surface, seabed));
  }
  const acoustics::BottomProfile& bottom = sea_->sea.bottom_profile;
  const auto is_above = [&](double depth_m, double range_m) {
    return depth_m + kMinWaterM + kRounding < bottom.depth_at(range_m);
  };
  if (!is_above(query.link.source_depth_m, 0) || !is_above(query.link.receiver_depth_m, query.link.range_m))
    return search_paths(model, water, environment, query, seabed);
  return result_over(model, *sea_, query, seabed, shared);
}

SharedLine SharedLine::of_depths() { return {{}, std::make_unique<acoustics::DepthFan>()}; }

SharedLine SharedLine::of_ranges(std::vector<double> rising_ranges_m) {
  return {{}, std::make_unique<acoustics::RangeFan>(std::move(rising_ranges_m))};
}

bool may_be_flux_only(const RayModel& model, const acoustics::RayWater& water, const PathQuery& query) {
  return acoustics::may_be_flux_only(water, options_of(model, query), query.link, model.weak_below_diffuse);
}

namespace {

// The windows of a link of more than ten depths whose turned sound is weak; nullopt for other links.
std::optional<std::vector<acoustics::Eigenray>> weak_turned_windows(
    const RayModel& model, const acoustics::RayWater& water, const acoustics::Environment& environment,
    const PathQuery& query, const SeabedPlaces& seabed, double depth_m) {
  constexpr double kFarAway = 10;  // least length, in depths
  if (!model.turned || query.link.range_m < kFarAway * depth_m || !may_be_flux_only(model, water, query))
    return std::nullopt;
  TurnedLink link{water,
                  model.bottom,
                  surface_of(model, environment),
                  model.fading,
                  query.frequency_hz,
                  query.link,
                  {},
                  seabed.mean_square_slope,
                  model.options.fine_structure};
  for (std::size_t i = 0; i < link.depths_m.size(); ++i)
    link.depths_m[i] = std::max(seabed.z_m[i] - environment.sea_surface_z_m, kMinWaterM);
  std::vector<acoustics::Eigenray> windows = model.turned->windows_alone(link);
  double power = 0;
  for (const acoustics::Eigenray& window : windows)
    power += window.received_pressure() * window.received_pressure();
  const double weak = query.diffuse_below_pressure * query.diffuse_below_pressure *
                      to_power_ratio(-model.weak_below_diffuse).value;
  return windows.empty() || power > weak ? std::nullopt : std::optional(std::move(windows));
}

}  // namespace

std::shared_ptr<const SearchResult> flux_only_paths(const RayModel& model, const acoustics::RayWater& water,
                                                    const acoustics::Environment& environment,
                                                    const PathQuery& query, const SeabedPlaces& seabed) {
  const auto [least, most] = std::minmax_element(seabed.z_m.begin(), seabed.z_m.end());
  if (*most - *least < kEvenM) return nullptr;
  double mean_z_m = 0;
  for (const double z_m : seabed.z_m) mean_z_m += z_m / static_cast<double>(seabed.z_m.size());
  const double deepest_end_m = std::max(query.link.source_depth_m, query.link.receiver_depth_m);
  const double depth_m =
      std::clamp(mean_z_m - environment.sea_surface_z_m, deepest_end_m + kEvenM, acoustics::kDeepestWater);
  const acoustics::LinkWater along = water_along(model, water, environment, query, depth_m);
  auto windows =
      turns_sound(model)
          ? weak_turned_windows(model, along.water, environment, query, seabed, depth_m)
          : acoustics::flux_only_eigenrays({along.water, depth_m, model.bottom,
                                            surface_of(model, environment), options_of(model, query)},
                                           query.link, model.weak_below_diffuse);
  if (!windows) return nullptr;
  auto found = std::make_shared<SearchResult>();
  found->eigenrays = {acoustics::RaySolver::kArcs, *std::move(windows)};
  found->mean_depth_m = depth_m;
  found->beyond_terrain = seabed.beyond_terrain;
  return found;
}

}  // namespace halocline::channel_server
