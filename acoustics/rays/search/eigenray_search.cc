// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/rays/search/eigenray_search.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "acoustics/rays/arc_tracer.h"
#include "acoustics/rays/channel_core.h"
#include "acoustics/rays/extrapolate_eigenrays.h"
#include "acoustics/rays/image_rays.h"
#include "acoustics/rays/layered_rays.h"
#include "acoustics/rays/profile_rays.h"
#include "acoustics/rays/ray_trace.h"
#include "acoustics/rays/search/smoothed_folds.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "core/check.h"
#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

constexpr double kNoLessDb = 250;          // loss of bounces beyond which a path is negligible everywhere
constexpr double kWidening = 3;            // factor on the searched loss, per step, while no path is found
constexpr double kStrongestMayLoseDb = 6;  // beyond it, losses are compared with that of the strongest path
constexpr double kLoudestFocus = 10;       // greatest amplitude of a path over that of spherical spreading
constexpr int kBouncesThatTell = 40;       // limit of the search that only finds out why no path is kept
const double kNearlyVertical = to_radians(89.5);  // rays over a profile are traced up to 89.9 degrees

double factor_of(double loss_db) { return elementary::exp10(-loss_db / 20); }

// The path of the greatest received pressure, which is at most the amplitude. Diffuse paths count only
// when there are no others.
const Eigenray& strongest(const std::vector<Eigenray>& paths) {
  const bool all_diffuse =
      std::all_of(paths.begin(), paths.end(), [](const Eigenray& path) { return path.diffuse; });
  const Eigenray* best = &paths.front();
  double most = 0;
  for (const Eigenray& path : paths) {
    if (path.diffuse != all_diffuse || path.amplitude <= most) continue;
    const double pressure = path.received_pressure();
    if (pressure <= most) continue;
    best = &path;
    most = pressure;
  }
  return *best;
}

// A search for the paths of one link; only the options change from one solver call to the next.
class EigenraySearch {
 public:
  EigenraySearch(const RaySea& sea, const RayLink& link, RaySolver solver, SharedRays* shared)
      : sea_(sea),
        link_(link),
        solver_(solver),
        shared_(shared),
        core_(solver == RaySolver::kImages || sea.section
                  ? std::nullopt
                  : channel_core(sea.water, sea.bottom_profile.shallowest_m(), link,
                                 sea.options.frequency_hz)) {}

  // Returns all paths within the limits. The limit on the loss of bounces is relative to the strongest path.
  std::vector<Eigenray> paths() const;
  // The reason why there are no paths.
  PathLack lack() const;
  // Gives families of rays the mean power of a medium that is not perfect.
  void smooth(std::vector<Eigenray>& paths) const;

 private:
  std::vector<Eigenray> paths_with(const RayOptions& options) const;
  std::vector<Eigenray> solved(const RayOptions& options) const;
  void add_vertical(const RayOptions& options, std::vector<Eigenray>& paths) const;
  void add_axial(std::vector<Eigenray>& paths) const;
  double core_speed() const { return core_ ? core_->greatest_speed_mps : 0; }
  FlatSea flat_sea(const RayOptions& options, double bottom_m) const {
    return {sea_.water, bottom_m, sea_.bottom, sea_.surface, options, core_speed()};
  }
  ProfiledSea profiled_sea(const RayOptions& options) const {
    return {sea_.water, sea_.bottom_profile, sea_.bottom,       sea_.surface,
            options,    core_speed(),        sea_.section.get()};
  }
  RayOptions with_bounce_loss(double loss_db) const;
  double most_bounce_loss_db() const;

  const RaySea& sea_;
  RayLink link_;
  RaySolver solver_;
  SharedRays* shared_;
  std::optional<ChannelCore> core_;
};

std::vector<Eigenray> EigenraySearch::solved(const RayOptions& options) const {
  switch (solver_) {
    case RaySolver::kImages:
      return image_rays(flat_sea(options, sea_.bottom_profile.depth_at(link_.range_m)), link_);
    case RaySolver::kSnell:
      return layered_rays(flat_sea(options, sea_.bottom_profile.depth_at(link_.range_m)), link_);
    case RaySolver::kArcs: {
      const ProfiledSea profiled = profiled_sea(options);
      return shared_ != nullptr ? shared_->at(profiled, link_) : profile_rays(profiled, link_);
    }
  }
  return {};
}

// Over a profile, nearly vertical rays are not traced. The direct ray is then that of a flat sea.
void EigenraySearch::add_vertical(const RayOptions& options, std::vector<Eigenray>& paths) const {
  const double down = std::abs(link_.receiver_depth_m - link_.source_depth_m);
  if (solver_ != RaySolver::kArcs || elementary::atan2(down, link_.range_m) < kNearlyVertical) return;
  RayOptions direct = options;
  direct.max_bounces = 0;
  std::erase_if(paths, [](const Eigenray& path) { return path.surface_bounces + path.bottom_bounces == 0; });
  const double bottom =
      std::max(sea_.bottom_profile.depth_at(0), sea_.bottom_profile.depth_at(link_.range_m));
  const std::vector<Eigenray> vertical = layered_rays(flat_sea(direct, bottom), link_);
  paths.insert(paths.end(), vertical.begin(), vertical.end());
  std::stable_sort(paths.begin(), paths.end(),
                   [](const Eigenray& a, const Eigenray& b) { return a.delay_s < b.delay_s; });
}

// Replaces all rays within the core of a channel by the axial ray, unless a direct ray runs outside the core.
void EigenraySearch::add_axial(std::vector<Eigenray>& paths) const {
  std::erase_if(paths, [&](const Eigenray& path) { return runs_within(*core_, path); });
  const bool is_direct = std::any_of(paths.begin(), paths.end(), [](const Eigenray& path) {
    return path.surface_bounces + path.bottom_bounces + path.identity.upper_turns +
               path.identity.lower_turns ==
           0;
  });
  if (is_direct) return;
  const Eigenray axial = axial_ray(sea_.water, *core_, link_);
  const auto later = std::find_if(paths.begin(), paths.end(),
                                  [&](const Eigenray& path) { return path.delay_s > axial.delay_s; });
  paths.insert(later, axial);
}

std::vector<Eigenray> EigenraySearch::paths_with(const RayOptions& options) const {
  std::vector<Eigenray> paths = solved(options);
  add_vertical(options, paths);
  if (core_) add_axial(paths);
  if (options.keep_steep_direct) return paths;
  // The solvers find paths without bounces at every launch angle.
  std::erase_if(paths, [limit = options.max_launch_angle_rad](const Eigenray& path) {
    return std::abs(path.launch_angle_rad) > limit;
  });
  return paths;
}

RayOptions EigenraySearch::with_bounce_loss(double loss_db) const {
  RayOptions options = sea_.options;
  options.min_boundary_factor = factor_of(loss_db);
  return options;
}

// Greatest loss of bounces of a path that still reaches the least amplitude, dB.
double EigenraySearch::most_bounce_loss_db() const {
  if (sea_.options.min_amplitude <= 0) return kNoLessDb;
  const double spherical = kLoudestFocus / std::max(link_.range_m, kMinDistance);
  return std::min(20 * elementary::log10(spherical / sea_.options.min_amplitude), kNoLessDb);
}

std::vector<Eigenray> EigenraySearch::paths() const {
  std::vector<Eigenray> paths = paths_with(sea_.options);
  if (!(sea_.options.min_boundary_factor > 0)) return paths;
  const double limit_db = -20 * elementary::log10(sea_.options.min_boundary_factor),
               most_db = most_bounce_loss_db();
  double searched_db = limit_db;
  while (paths.empty() && searched_db < most_db) {
    searched_db = std::min(kWidening * searched_db, most_db);
    paths = paths_with(with_bounce_loss(searched_db));
  }
  if (paths.empty()) return paths;
  const double wanted_db = limit_db + strongest(paths).bounce_loss_db();
  if (wanted_db > searched_db + kStrongestMayLoseDb) return paths_with(with_bounce_loss(wanted_db));
  if (searched_db > limit_db)
    std::erase_if(paths, [wanted_db](const Eigenray& path) { return path.bounce_loss_db() > wanted_db; });
  return paths;
}

void EigenraySearch::smooth(std::vector<Eigenray>& paths) const {
  if (sea_.options.fine_structure.is_perfect() || solver_ == RaySolver::kImages) return;
  if (solver_ == RaySolver::kSnell)
    return smooth_folds(flat_sea(sea_.options, sea_.bottom_profile.depth_at(link_.range_m)), link_, paths);
  smooth_folds(profiled_sea(sea_.options), link_, paths);
}

PathLack EigenraySearch::lack() const {
  RayOptions all = sea_.options;
  all.max_launch_angle_rad = std::numbers::pi / 2;
  all.keep_steep_direct = true;
  all.min_boundary_factor = factor_of(kNoLessDb);
  all.min_amplitude = 0;
  all.max_bounces = std::min(all.max_bounces, kBouncesThatTell);
  const std::vector<Eigenray> rays = paths_with(all);
  if (rays.empty()) return PathLack::kShadow;
  const bool some_too_steep = std::any_of(rays.begin(), rays.end(), [&](const Eigenray& ray) {
    return std::abs(ray.launch_angle_rad) > sea_.options.max_launch_angle_rad &&
           ray.amplitude > sea_.options.min_amplitude;
  });
  return some_too_steep ? PathLack::kTooSteep : PathLack::kTooWeak;
}

// The link with its ends at least 1 m apart. Changes of the bottom within that metre are neglected.
RayLink held_apart_over(const BottomProfile& bottom, const RayLink& link) {
  require_in_range(link.range_m, 0, 1e7, "range", "m");
  RayLink held = held_apart(link);
  if (held.range_m == link.range_m) return link;
  require_in_range(link.receiver_depth_m, 0, bottom.depth_at(link.range_m), "depth of the receiver", "m");
  held.receiver_depth_m = std::min(link.receiver_depth_m, bottom.depth_at(held.range_m));
  return held;
}

}  // namespace

RayWater ray_water(const Environment& environment, double frequency_hz, double thinning_tolerance_mps) {
  const double khz = hz_to_khz(frequency_hz);
  const auto absorption = [&](double depth_m) {
    return absorption_spectrum_at(environment, depth_m).db_per_km(khz * khz);
  };
  if (thinning_tolerance_mps <= 0) return RayWater::from_profile(environment.profile, absorption);
  const std::vector<SpeedRow> few =
      thinned(knots_of(environment.profile, kSpeedTolerance), thinning_tolerance_mps);
  return RayWater(rounded_channels(few, thinning_tolerance_mps), absorption);
}

RaySolver choose_solver(const RaySea& sea, const RayLink& link) {
  if (sea.section || !sea.bottom_profile.is_flat_until(link.range_m)) return RaySolver::kArcs;
  const bool one_speed = sea.water.is_isovelocity_above(sea.bottom_profile.depth_at(link.range_m));
  return one_speed ? RaySolver::kImages : RaySolver::kSnell;
}

Eigenrays eigenrays(const RaySea& sea, const RayLink& link, std::optional<RaySolver> solver,
                    SharedRays* shared) {
  require(!solver || *solver == RaySolver::kArcs || sea.bottom_profile.is_flat_until(link.range_m),
          "the ray solvers 'images' and 'snell' need a flat bottom");
  require(!solver || *solver == RaySolver::kArcs || !sea.section,
          "the ray solvers 'images' and 'snell' need water that is the same all along the link");
  const RayLink held = held_apart_over(sea.bottom_profile, link);
  const RaySolver chosen = solver.value_or(choose_solver(sea, held));
  const EigenraySearch search(sea, held, chosen, shared);
  Eigenrays found{chosen, search.paths()};
  search.smooth(found.paths);
  // Scattered sound goes on without a path: a link whose paths it leaves is not in a shadow.
  if (found.silent()) found.lack = sea.options.scattering.scatters() ? PathLack::kTooWeak : search.lack();
  if (held.range_m != link.range_m) {
    const EndSpeeds speeds{sea.water.speed_at(held.source_depth_m),
                           sea.water.speed_at(held.receiver_depth_m)};
    found.paths = extrapolate_eigenrays(found.paths, held, speeds, link);
  }
  return found;
}

}  // namespace halocline::acoustics
