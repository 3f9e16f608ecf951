// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/rays/search/smoothed_folds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <utility>

#include "acoustics/rays/search/family_rays.h"
#include "acoustics/rays/search/ray_family.h"
#include "acoustics/rays/traced_eigenray.h"
#include "acoustics/sea/fine_structure.h"
#include "acoustics/sea/ray_water.h"
#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

using std::numbers::pi;

constexpr std::size_t kSigmas = 7;    // launch angles at which sigma_z is computed
constexpr double kNegligible = 1e-4;  // of the strongest power: windows below are left out
constexpr int kFirstWindow = 8192;    // of identities: the windows of a rough bottom are fewer
constexpr int kWindowNumbers = 8000;
constexpr int kAnyBounces = 1 << 20;
constexpr int kUnevenBounces = 1;  // over a bottom that is not level, families of more end at its corners

// 0 below `low`, 1 above `high`, linear in between.
double ramp(double x, double low, double high) { return std::clamp((x - low) / (high - low), 0.0, 1.0); }

double power_of(const Eigenray& path) { return path.amplitude * path.amplitude; }

double factor_of(const Eigenray& path) { return elementary::exp10(-path.bounce_loss_db() / 10); }

// The geometry of a link.
struct SmoothedLink {
  const RayWater& water;
  const RayOptions& options;
  double core_mps;  // rays that nowhere exceed it are left out
  RayLink link;
  double bottom_m, source_mps, receiver_mps;
  int most_bottom_bounces;  // of paths that are smoothed

  // Spread of rays before the depth of the water limits it, m.
  double free_sigma_m(double theta) const {
    const double r = link.range_m, xi = elementary::cos(theta) / source_mps;
    const double mu = cycle_turning_rate(water, options.fine_structure, bottom_m, link.source_depth_m, xi);
    const double fresnel = 0.5 * std::sqrt(receiver_mps / options.frequency_hz * r / (2 * pi));
    const double still = std::max(std::sqrt(mu * r * r * r / 3), fresnel), moved = options.platform_jitter_m;
    return std::sqrt(still * still + 2 * moved * moved);
  }
  // Launch angle beyond which rays meet both boundaries, rad; 0 where the source has the greatest speed.
  double steepest_turning() const {
    double most = water.speed_at(bottom_m);
    for (std::size_t i = 0; i < water.depths_m().size() && water.depths_m()[i] < bottom_m; ++i)
      most = std::max(most, water.speeds_mps()[i]);
    return most > source_mps ? elementary::acos(source_mps / most) : 0;
  }
  // Factor on the integral of a family over launch angles, re 1 m: f^2 xi_s / (xi_r r) / sqrt(2 pi).
  double strength_of(const Eigenray& path) const {
    const double source = elementary::cos(path.launch_angle_rad) / source_mps;
    const double receiver = elementary::cos(path.arrival_angle_rad) / receiver_mps;
    return factor_of(path) * source / (receiver * link.range_m * std::sqrt(2 * pi));
  }
  bool may_turn(const FamilyBounces& bounces) const {
    return (bounces.surface == 0 || bounces.bottom == 0) && bounces.bottom <= most_bottom_bounces;
  }
};

class FoldSmoother {
 public:
  FoldSmoother(FamilyRays& rays, const SmoothedLink& link, std::vector<Eigenray>& paths)
      : rays_(rays), link_(link), paths_(paths), steepest_(link.steepest_turning()) {}

  void run() {
    if (!(steepest_ > 0)) return;
    done_.assign(paths_.size(), false);
    for (std::size_t i = 0; i < done_.size(); ++i) {
      if (!done_[i] && may_fold(paths_[i])) smooth_beside(paths_[i]);
    }
    seek_shadows();
    add_windows();
  }

 private:
  struct Window {
    Eigenray path;
    double power;
  };

  // Radians by which the end of a ray moves by `sigma`, as the width of the path's tube has it.
  double step_of(const Eigenray& path, double sigma) const {
    const double tube = factor_of(path) / (link_.link.range_m * power_of(path));  // |zeta'|
    return std::min(sigma / tube, kWidestFamilyStep);
  }
  bool may_fold(const Eigenray& path) {
    if (path.diffuse || !(path.amplitude > 0) || !link_.may_turn(bounces_of(path))) return false;
    if (path.launch_slowness_spm * link_.core_mps > 1 && path.bounce_loss_db() == 0) return false;
    const double steeper = std::abs(path.launch_angle_rad) - steepest_;
    return steeper < 0 || steeper < kFamilyReach * step_of(path, sigma_of(path.launch_angle_rad));
  }
  // The spread of rays changes slowly with the angle: it is interpolated between kSigmas angles.
  double free_sigma_of(double theta);
  // sigma_z, which is at most half of the depth.
  double sigma_of(double theta) { return std::min(free_sigma_of(theta), 0.5 * link_.bottom_m); }
  // True when the rays `step` to both sides of a path end `off_m` above and below the receiver, as the width
  // of its tube has it.
  bool is_straight(const Eigenray& path, double step, double off_m);
  RayFamily family_of(const FamilyRay& seed, double sigma, double step) {
    return {rays_, seed, {sigma, link_.link.receiver_depth_m, link_.bottom_m}, step};
  }
  // Weight of the smoothed power of the family of a ray against that of the family's folds.
  double weight_of(const RayFamily& family, double theta) {
    if (family.is_empty()) return 0;
    return family.share_beyond_folds(free_sigma_of(theta), link_.options.frequency_hz, link_.receiver_mps);
  }
  void smooth_beside(const Eigenray& path);
  void share_among_paths(const RayFamily& family, double weight);
  // Families that turn before they reach the receiver, within reach of sigma_z.
  void seek_shadows();
  void seek_shadow(const FamilyRay& a, const FamilyRay& b, const FamilyRay& c);
  void add_shadow(const FamilyRay& turn, double step);
  void add_windows();

  FamilyRays& rays_;
  const SmoothedLink& link_;
  std::vector<Eigenray>& paths_;
  double steepest_;
  std::array<double, kSigmas> sigmas_{};  // free ones at angles 0..steepest_, m; 0: not computed yet
  std::vector<bool> done_;                // one for each path
  std::vector<RayFamily> families_;
  std::vector<Window> windows_;
};

double FoldSmoother::free_sigma_of(double theta) {
  const double place = std::min(std::abs(theta) / steepest_, 1.0) * (kSigmas - 1);
  const auto below = std::min(static_cast<std::size_t>(place), kSigmas - 2);
  for (const std::size_t i : {below, below + 1}) {
    if (sigmas_[i] == 0)
      sigmas_[i] = link_.free_sigma_m(steepest_ * static_cast<double>(i) / static_cast<double>(kSigmas - 1));
  }
  return sigmas_[below] + (place - static_cast<double>(below)) * (sigmas_[below + 1] - sigmas_[below]);
}

bool FoldSmoother::is_straight(const Eigenray& path, double step, double off_m) {
  if (step >= 2 * kWidestFamilyStep) return false;
  double before = 0;
  for (const double h : {-step, step}) {
    const std::optional<FamilyRay> ray = rays_.at(path.launch_angle_rad + h);
    if (!ray || ray->bounces != bounces_of(path) || before * ray->off_m > 0) return false;
    if (std::abs(std::abs(ray->off_m) - off_m) >= 0.5 * kStraight * off_m) return false;
    before = ray->off_m;
  }
  return true;
}

void FoldSmoother::smooth_beside(const Eigenray& path) {
  const double sigma = sigma_of(path.launch_angle_rad), step = step_of(path, sigma);
  if (is_straight(path, 2 * step, 2 * sigma)) return;
  const std::optional<FamilyRay> ray = rays_.at(path.launch_angle_rad);
  if (!ray || ray->bounces != bounces_of(path)) return;
  RayFamily family = family_of(*ray, sigma, 0.5 * step);
  const double weight = weight_of(family, path.launch_angle_rad);
  if (weight > 0) {
    share_among_paths(family, weight);
    families_.push_back(std::move(family));
  }
}

void FoldSmoother::share_among_paths(const RayFamily& family, double weight) {
  std::vector<std::size_t> members;
  for (std::size_t i = 0; i < done_.size(); ++i) {
    if (family.holds(paths_[i])) members.push_back(i);
  }
  std::sort(members.begin(), members.end(), [this](std::size_t a, std::size_t b) {
    return paths_[a].launch_angle_rad < paths_[b].launch_angle_rad;
  });
  double from = 0, window = 0, most = 0;
  Eigenray strongest;
  for (std::size_t k = 0; k < members.size(); ++k) {
    Eigenray& path = paths_[members[k]];
    const double to =
        k + 1 < members.size() ? family.integral_to_fold(path, paths_[members[k + 1]]) : family.integral();
    const double part = to - std::exchange(from, to);
    if (done_[members[k]]) continue;  // by a family that ends before some of these paths
    done_[members[k]] = true;
    const double integral = part * link_.strength_of(path), power = power_of(path);
    const double smoothed = weight * ramp(family.bend_at(path.launch_angle_rad), kStraight, kBent);
    const double share = std::min(integral / power, 1.0), kept = share * share;
    if (power > most) strongest = path;
    most = std::max(most, power);
    window += smoothed * (integral - kept * power);
    path.amplitude *= std::sqrt(1 - smoothed + smoothed * kept);
  }
  if (window > 0) windows_.push_back({strongest, window});
}

void FoldSmoother::seek_shadows() {
  const double wanted = 12 + 0.6 * link_.link.range_m / link_.bottom_m;
  const int count = static_cast<int>(std::clamp<double>(wanted, kMinShadowRays, kMaxShadowRays));
  std::array<std::optional<FamilyRay>, 3> last;
  for (int i = 0; i < count; ++i) {
    last = {last[1], last[2], rays_.at(steepest_ * (2.0 * (i + 0.5) / count - 1))};
    if (!last[0] || !last[1] || !last[2] || !link_.may_turn(last[1]->bounces)) continue;
    if (last[0]->bounces == last[1]->bounces && last[1]->bounces == last[2]->bounces)
      seek_shadow(*last[0], *last[1], *last[2]);
  }
}

// The parabola through three neighbouring rays tells where zeta turns.
void FoldSmoother::seek_shadow(const FamilyRay& a, const FamilyRay& b, const FamilyRay& c) {
  const bool is_greatest = b.off_m >= a.off_m && b.off_m > c.off_m;
  const bool is_least = b.off_m <= a.off_m && b.off_m < c.off_m;
  if (!is_greatest && !is_least) return;
  const double h = b.theta - a.theta, bend = a.off_m - 2 * b.off_m + c.off_m;
  const double theta = b.theta + 0.5 * h * (a.off_m - c.off_m) / bend;
  const bool known = std::any_of(families_.begin(), families_.end(), [&](const RayFamily& one) {
    return one.bounces() == b.bounces && theta >= one.from() && theta <= one.to();
  });
  if (known || elementary::cos(theta) * link_.core_mps > link_.source_mps) return;
  const std::optional<FamilyRay> turn = rays_.at(theta);
  if (!turn || turn->bounces != b.bounces) return;
  if (is_greatest ? turn->off_m > 0 : turn->off_m < 0) return;  // lit: its paths are found
  const double sigma = sigma_of(theta);
  if (std::abs(turn->off_m) > kFamilyReach * sigma) return;
  add_shadow(*turn, std::min(std::sqrt(2 * kFamilyStep * sigma * h * h / std::abs(bend)), kWidestFamilyStep));
}

void FoldSmoother::add_shadow(const FamilyRay& turn, double step) {
  const double sigma = sigma_of(turn.theta);
  RayFamily family = family_of(turn, sigma, step);
  const double weight = weight_of(family, turn.theta);
  if (weight <= 0) return;
  const std::optional<Eigenray> ray = rays_.representative(turn.theta);
  if (!ray) return;
  double window = weight * family.integral() * link_.strength_of(*ray);
  // A path on the shadow side of the fold already has part of it.
  for (const Eigenray& path : paths_) {
    if (family.holds(path)) window -= power_of(path);
  }
  families_.push_back(std::move(family));
  if (window > 0) windows_.push_back({*ray, window});
}

void FoldSmoother::add_windows() {
  if (windows_.empty()) return;
  double most = 0;
  for (const Eigenray& path : paths_) most = std::max(most, power_of(path));
  for (const Window& window : windows_) most = std::max(most, window.power);
  std::vector<int> used;
  for (const auto& [path, power] : windows_) {
    if (power < kNegligible * most) continue;
    int number = kFirstWindow + (64 * path.surface_bounces + 8 * path.bottom_bounces) % kWindowNumbers;
    while (std::find(used.begin(), used.end(), number) != used.end()) ++number;
    used.push_back(number);
    Eigenray& window = paths_.emplace_back(path);
    window.amplitude = std::sqrt(power);
    window.diffuse = true;
    window.phase_rad = 0;
    window.identity = diffuse_identity(1, static_cast<std::size_t>(number));
  }
  std::stable_sort(paths_.begin(), paths_.end(),
                   [](const Eigenray& a, const Eigenray& b) { return a.delay_s < b.delay_s; });
}

}  // namespace

void smooth_folds(const FlatSea& sea, const RayLink& link, std::vector<Eigenray>& paths) {
  const SmoothedLink over{sea.water,
                          sea.options,
                          sea.core_speed_mps,
                          link,
                          sea.bottom_depth_m,
                          sea.water.speed_at(link.source_depth_m),
                          sea.water.speed_at(link.receiver_depth_m),
                          kAnyBounces};
  LevelFamilyRays rays(sea, link);
  FoldSmoother(rays, over, paths).run();
}

void smooth_folds(const ProfiledSea& sea, const RayLink& link, std::vector<Eigenray>& paths) {
  const RayWater& last = sea.section != nullptr ? sea.section->columns().back() : sea.water;
  const SmoothedLink over{sea.water,
                          sea.options,
                          sea.core_speed_mps,
                          link,
                          sea.profile.depth_at(link.range_m),
                          sea.water.speed_at(link.source_depth_m),
                          last.speed_at(link.receiver_depth_m),
                          sea.profile.is_flat_until(link.range_m) ? kAnyBounces : kUnevenBounces};
  ProfiledFamilyRays rays(sea, link);
  FoldSmoother(rays, over, paths).run();
}

}  // namespace halocline::acoustics
