// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/rays/smoothed_folds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <utility>

#include "acoustics/math/fast_functions.h"
#include "acoustics/math/fold_field.h"
#include "acoustics/rays/arc_tracer.h"
#include "acoustics/rays/cycle_rays.h"
#include "acoustics/rays/fan_tracer.h"
#include "acoustics/rays/traced_eigenray.h"
#include "acoustics/sea/fine_structure.h"
#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

using std::numbers::pi;

constexpr double kReach = 3.5;        // sigma_z beyond which a ray does not count
constexpr double kStep = 1.2;         // sigma_z between neighbouring rays of an integral
constexpr double kLongestStep = 2.4;  // sigma_z beyond which a step is halved
constexpr int kMaxHalvings = 6;       // of steps on one side of a family
constexpr int kMaxEdgeHalvings = 2;   // of those towards its edge
constexpr std::size_t kSigmas = 7;
constexpr double kBendReach = 2.5;    // sigma_z within which rays tell how zeta is bent
constexpr int kMaxRays = 48;          // on one side of a family
constexpr double kWidestStep = 0.02;  // rad
constexpr double kSteepest = 1.4;     // rad: families end there
// sigma_z over the Airy length of a fold between which its field gives way.
constexpr double kFoldStays = 1, kFoldGone = 1.5;
constexpr double kNegligible = 1e-4;  // of the strongest path's power: windows below are left out
constexpr int kFirstWindow = 8192;    // of identities: those of a rough bottom are fewer

constexpr int kAnyBounces = 1 << 20;
// Over a bottom that is not level, families of more bounces end at each of its corners.
constexpr int kUnevenBounces = 1;

// 0 below `low`, 1 above `high`, linear in between.
double ramp(double x, double low, double high) { return std::clamp((x - low) / (high - low), 0.0, 1.0); }

struct Bounces {
  int surface = 0, bottom = 0;
  bool operator==(const Bounces&) const = default;
};

// Ray of a family at the receiver's range: `off_m` below the receiver.
struct FamilyRay {
  double theta = 0, off_m = 0, sine = 0;
};

// The geometry of a link over which families are smoothed.
struct SmoothedLink {
  const RayWater& water;
  FineStructure structure;
  double frequency_hz, core_mps;
  double source_m, receiver_m, range_m, bottom_m;
  double source_mps, receiver_mps, jitter_m;
  int most_bottom_bounces = kAnyBounces;  // of paths that are smoothed

  double sigma_m(double theta) const {
    const double xi = elementary::cos(theta) / source_mps;
    const double mu = cycle_turning_rate(water, structure, bottom_m, source_m, xi);
    const double turned = std::sqrt(mu * range_m * range_m * range_m / 3);
    const double fresnel = 0.5 * std::sqrt(receiver_mps / frequency_hz * range_m / (2 * pi));
    const double still = std::max(turned, fresnel);
    return std::min(std::sqrt(still * still + 2 * jitter_m * jitter_m), 0.5 * bottom_m);
  }
  // Launch angle beyond which rays meet both boundaries.
  double steepest_turning() const {
    double most = 0;
    for (std::size_t i = 0; i < water.depths_m().size() && water.depths_m()[i] < bottom_m; ++i)
      most = std::max(most, water.speeds_mps()[i]);
    most = std::max(most, water.speed_at(bottom_m));
    return most > source_mps ? elementary::acos(source_mps / most) : 0;
  }
};

// Normal density of arriving `off_m` beside the receiver, times sqrt(2 pi), reflected at both boundaries.
double reflected_density(double off_m, double sigma_m, double receiver_m, double bottom_m) {
  const double scale = -0.5 / (sigma_m * sigma_m), depth = receiver_m + off_m;
  double sum = 0;
  for (const double off : {off_m, depth + receiver_m, depth + receiver_m - 2 * bottom_m, off_m + 2 * bottom_m,
                           off_m - 2 * bottom_m}) {
    const double exponent = off * off * scale;
    if (exponent > -18) sum += fast_exp(exponent);
  }
  return sum / sigma_m;
}

// Rays of a level sea.
class LevelRays {
 public:
  LevelRays(const FlatSea& sea, const RayLink& link)
      : sea_(sea), link_(link), rays_(sea.water, sea.bottom_depth_m, link.source_depth_m, link.range_m) {}

  std::optional<std::pair<FamilyRay, Bounces>> at(double theta) {
    const RangeEnd end = rays_.at(theta);
    if (!end.arrived) return std::nullopt;
    return std::pair{FamilyRay{theta, end.depth_m - link_.receiver_depth_m, end.sine},
                     Bounces{end.surface_bounces, end.bottom_bounces}};
  }
  std::optional<Eigenray> representative(double theta) const {
    const BottomProfile profile = BottomProfile::flat(sea_.bottom_depth_m);
    const ArcTracer tracer({sea_.water, profile, sea_.bottom, sea_.surface, sea_.options}, link_);
    const std::optional<DiffuseRay> ray = diffuse_ray(tracer, theta, 0);
    return ray ? std::optional(ray->eigenray) : std::nullopt;
  }

 private:
  const FlatSea& sea_;
  RayLink link_;
  CycleRays rays_;
};

// Rays over a bottom that changes, or through water that does.
class ProfiledRays {
 public:
  ProfiledRays(const ProfiledSea& sea, const RayLink& link) : tracer_(sea, link), fan_(tracer_) {}

  std::optional<std::pair<FamilyRay, Bounces>> at(double theta) {
    const std::size_t kept = fan_.kept_events();
    const FanRay ray = fan_.trace(theta);
    if (!ray.arrived) return std::nullopt;
    Bounces bounces;
    for (const EventCode& event : fan_.events_of(ray)) {
      if (event.event == RayEvent::kSurface) ++bounces.surface;
      if (event.event == RayEvent::kBottom) ++bounces.bottom;
    }
    fan_.forget_since(kept);
    // Unfolded depth is an image of the depth, z or -z, a whole number of 2 H away.
    const double depth = std::abs(std::remainder(ray.zeta, 2 * tracer_.bottom_at_receiver_m()));
    const double sine = ray.slowness * tracer_.water_at_receiver().speed_at(depth);
    return std::pair{FamilyRay{theta, depth - tracer_.receiver_depth_m(), sine}, bounces};
  }
  std::optional<Eigenray> representative(double theta) const {
    const std::optional<DiffuseRay> ray = diffuse_ray(tracer_, theta, 0);
    return ray ? std::optional(ray->eigenray) : std::nullopt;
  }

 private:
  ArcTracer tracer_;
  FanTracer fan_;
};

template <class Rays>
class FoldSmoother {
 public:
  FoldSmoother(Rays rays, const SmoothedLink& link, std::vector<Eigenray>& paths)
      : rays_(std::move(rays)), link_(link), paths_(paths), steepest_(link.steepest_turning()) {}

  void run() {
    if (!(steepest_ > 0)) return;
    smoothed_.assign(paths_.size(), false);
    const std::size_t count = paths_.size();
    for (std::size_t i = 0; i < count; ++i) {
      if (smoothed_[i] || !may_fold(paths_[i])) continue;
      smooth_beside(i);
    }
    seek_shadows();
    add_windows();
  }

 private:
  // The integral of a family over its rays, which are by rising launch angle.
  struct Family {
    Bounces bounces;
    double sigma_m = 0;
    std::vector<FamilyRay> rays;
    std::vector<double> sums;  // of the density over the launch angles below each ray
  };
  struct Window {
    Eigenray path;
    double power;
  };

  double step_of(const Eigenray& path, double sigma) const {
    const double factor = elementary::exp10(-path.bounce_loss_db() / 10);
    const double tube = factor / (link_.range_m * path.amplitude * path.amplitude);  // |zeta'|
    return std::min(sigma / tube, kWidestStep);
  }

  bool may_fold(const Eigenray& path) {
    if (path.diffuse || !(path.amplitude > 0)) return false;
    if (path.surface_bounces > 0 && path.bottom_bounces > 0) return false;
    if (path.bottom_bounces > link_.most_bottom_bounces) return false;
    if (path.launch_slowness_spm * link_.core_mps > 1 && path.bounce_loss_db() == 0) return false;
    const double steep = std::abs(path.launch_angle_rad) - steepest_;
    return steep < 0 || steep < kReach * step_of(path, sigma_of(path.launch_angle_rad));
  }

  // sigma_z changes slowly with the angle: it is interpolated between kSigmas angles.
  double sigma_of(double theta) {
    const double place = std::min(std::abs(theta) / steepest_, 1.0) * (kSigmas - 1);
    const auto below = std::min(static_cast<std::size_t>(place), kSigmas - 2);
    for (const std::size_t i : {below, below + 1}) {
      if (sigmas_[i] == 0)
        sigmas_[i] = link_.sigma_m(steepest_ * static_cast<double>(i) / static_cast<double>(kSigmas - 1));
    }
    return sigmas_[below] + (place - static_cast<double>(below)) * (sigmas_[below + 1] - sigmas_[below]);
  }

  // True when the rays `step` to both sides of a path end `off_m` above and below the receiver, as the width
  // of its ray tube has it.
  bool is_straight(const Eigenray& path, double step, double off_m) {
    if (step >= 2 * kWidestStep) return false;
    const Bounces bounces{path.surface_bounces, path.bottom_bounces};
    std::array<double, 2> off{};
    for (const int side : {0, 1}) {
      const auto ray = rays_.at(path.launch_angle_rad + (side == 0 ? -step : step));
      if (!ray || ray->second != bounces) return false;
      off[side] = ray->first.off_m;
    }
    return off[0] * off[1] < 0 && std::abs(std::abs(off[0]) - off_m) < 0.5 * kStraight * off_m &&
           std::abs(std::abs(off[1]) - off_m) < 0.5 * kStraight * off_m;
  }

  // e of a path among the rays of its family: how far they are from the straight line through the two beside
  // it, within 2 sigma_z.
  static double bend_of(const Family& family, double theta) {
    const std::vector<FamilyRay>& rays = family.rays;
    std::size_t next = 1;
    while (next + 1 < rays.size() && rays[next].theta <= theta) ++next;
    const FamilyRay &a = rays[next - 1], &b = rays[next];
    const double slope = (b.off_m - a.off_m) / (b.theta - a.theta), middle = 0.5 * (a.theta + b.theta);
    const double most = kBendReach * family.sigma_m;
    double bend = 0;
    for (const FamilyRay& ray : rays) {
      const double straight = slope * (ray.theta - middle);
      if (std::abs(straight) > most || &ray == &a || &ray == &b) continue;
      const double away = std::abs(ray.off_m - 0.5 * (a.off_m + b.off_m) - straight);
      bend = std::max(bend, away * 2 * family.sigma_m / std::max(straight * straight, 1e-12));
    }
    return bend;
  }

  void smooth_beside(std::size_t index) {
    const Eigenray& path = paths_[index];
    const double sigma = sigma_of(path.launch_angle_rad);
    const double step = step_of(path, sigma);
    if (is_straight(path, 2 * step, 2 * sigma)) return;
    const auto self = rays_.at(path.launch_angle_rad);
    if (!self || self->second != Bounces{path.surface_bounces, path.bottom_bounces}) return;
    const Family family = family_of(self->first, self->second, sigma, 0.5 * step);
    if (family.rays.size() < 3) return;
    const double gives_way = ramp(sigma / airy_length_m(family), kFoldStays, kFoldGone);
    if (gives_way <= 0) return;
    std::vector<std::size_t> members;
    for (std::size_t i = 0; i < smoothed_.size(); ++i) {
      const Eigenray& one = paths_[i];
      if (one.diffuse || smoothed_[i] || one.surface_bounces != family.bounces.surface ||
          one.bottom_bounces != family.bounces.bottom || one.launch_angle_rad < family.rays.front().theta ||
          one.launch_angle_rad > family.rays.back().theta)
        continue;
      members.push_back(i);
    }
    std::sort(members.begin(), members.end(), [this](std::size_t a, std::size_t b) {
      return paths_[a].launch_angle_rad < paths_[b].launch_angle_rad;
    });
    visited_.push_back({family.bounces, family.rays.front().theta, family.rays.back().theta});
    double from = 0, window = 0;
    const Eigenray* strongest = nullptr;
    for (std::size_t k = 0; k < members.size(); ++k) {
      const double to = k + 1 < members.size()
                            ? family.sums[between(family, paths_[members[k]], paths_[members[k + 1]])]
                            : family.sums.back();
      Eigenray& one = paths_[members[k]];
      smoothed_[members[k]] = true;
      const double weight = gives_way * ramp(bend_of(family, one.launch_angle_rad), kStraight, kBent);
      const double integral = (to - from) * strength_of(one), power = one.amplitude * one.amplitude;
      from = to;
      const double share = std::min(integral / power, 1.0), kept = power * share * share;
      window += weight * (integral - kept);
      one.amplitude *= std::sqrt(1 - weight + weight * share * share);
      if (strongest == nullptr || power > strongest->amplitude * strongest->amplitude) strongest = &one;
    }
    if (strongest != nullptr && window > 0) windows_.push_back({*strongest, window});
  }

  // Factor on the integral of the density over launch angles, re 1 m: f^2 xi_s / (xi_r r) / sqrt(2 pi).
  double strength_of(const Eigenray& path) const {
    const double factor = elementary::exp10(-path.bounce_loss_db() / 10);
    const double source = elementary::cos(path.launch_angle_rad) / link_.source_mps;
    const double receiver = elementary::cos(path.arrival_angle_rad) / link_.receiver_mps;
    return factor * source / (receiver * link_.range_m * std::sqrt(2 * pi));
  }

  // Index of the ray of a family between two paths that ends furthest from the receiver: the fold.
  static std::size_t between(const Family& family, const Eigenray& a, const Eigenray& b) {
    std::size_t best = 0;
    double most = -1;
    for (std::size_t i = 0; i < family.rays.size(); ++i) {
      const FamilyRay& ray = family.rays[i];
      if (ray.theta < a.launch_angle_rad || ray.theta > b.launch_angle_rad) continue;
      if (std::abs(ray.off_m) > most) {
        most = std::abs(ray.off_m);
        best = i;
      }
    }
    if (most < 0) {  // no ray between two that are closer than a step
      while (best + 1 < family.rays.size() && family.rays[best].theta < a.launch_angle_rad) ++best;
    }
    return best;
  }

  Family family_of(const FamilyRay& seed, const Bounces& bounces, double sigma, double step) {
    Family family{bounces, sigma, {}, {}};
    add_side(seed, bounces, sigma, -step, family.rays);
    std::reverse(family.rays.begin(), family.rays.end());
    family.rays.push_back(seed);
    add_side(seed, bounces, sigma, step, family.rays);
    family.sums.assign(family.rays.size(), 0);
    const auto density = [&](std::size_t i) {
      return reflected_density(family.rays[i].off_m, sigma, link_.receiver_m, link_.bottom_m);
    };
    double before = density(0);
    for (std::size_t i = 1; i < family.rays.size(); ++i) {
      const double here = density(i), width = family.rays[i].theta - family.rays[i - 1].theta;
      family.sums[i] = family.sums[i - 1] + 0.5 * (before + here) * width;
      before = here;
    }
    return family;
  }

  // Adds the rays of a family on one side of `seed`, at steps over which zeta changes by kStep sigma_z.
  void add_side(FamilyRay seed, const Bounces& bounces, double sigma, double step,
                std::vector<FamilyRay>& rays) {
    FamilyRay last = seed;
    double slope_before = 0;
    int halvings = 0, parted = 0;
    for (int i = 0; i < kMaxRays; ++i) {
      const double theta = last.theta + step;
      if (std::abs(theta) > kSteepest) return;
      const auto ray = rays_.at(theta);
      const bool same = ray && ray->second == bounces;
      const double change = same ? ray->first.off_m - last.off_m : 0;
      if (!same || std::abs(change) > kLongestStep * sigma) {
        if (++halvings > kMaxHalvings || (!same && ++parted > kMaxEdgeHalvings)) return;
        step *= 0.5;
        continue;
      }
      rays.push_back(ray->first);
      last = ray->first;
      if (std::abs(last.off_m) > kReach * sigma) return;
      const double slope = change / step, bend = std::abs((slope - slope_before) / step);
      const double used = i == 0 ? 0 : bend;
      slope_before = slope;
      // |slope| h + bend h^2 / 2 = kStep sigma
      const double s = std::abs(slope);
      const double next = 2 * kStep * sigma / (s + std::sqrt(s * s + 2 * used * kStep * sigma));
      const double most = halvings > 0 ? std::abs(step) : 2 * std::abs(step);
      step = std::copysign(std::min({next, most, kWidestStep}), step);
    }
  }

  // Airy length of the fold of a family, in depth, m: where zeta turns or is the least steep.
  double airy_length_m(const Family& family) const {
    double least = 1e300, length = 1e-3;
    for (std::size_t i = 1; i + 1 < family.rays.size(); ++i) {
      const FamilyRay &a = family.rays[i - 1], &b = family.rays[i], &c = family.rays[i + 1];
      const double before = (b.off_m - a.off_m) / (b.theta - a.theta);
      const double after = (c.off_m - b.off_m) / (c.theta - b.theta);
      const double steep = std::abs(before + after);
      if (steep >= least) continue;
      least = steep;
      const double width = 0.5 * (c.theta - a.theta);
      const Fold fold{(after - before) / width, (c.sine - a.sine) / (c.theta - a.theta) / link_.receiver_mps};
      if (fold.slowness_slope != 0) length = fold.length_m(link_.frequency_hz);
    }
    return std::max(length, 1e-3);
  }

  // Families that turn before they reach the receiver, within reach of sigma_z.
  void seek_shadows() {
    const double wanted = 12 + 0.6 * link_.range_m / link_.bottom_m;
    const int count = static_cast<int>(std::clamp<double>(wanted, kMinShadowRays, kMaxShadowRays));
    std::array<std::optional<std::pair<FamilyRay, Bounces>>, kMaxShadowRays> fan;
    for (int i = 0; i < count; ++i) fan[i] = rays_.at(steepest_ * (2.0 * (i + 0.5) / count - 1));
    for (int i = 1; i + 1 < count; ++i) {
      const auto &a = fan[i - 1], &b = fan[i], &c = fan[i + 1];
      if (!a || !b || !c || a->second != b->second || b->second != c->second) continue;
      if (b->second.surface > 0 && b->second.bottom > 0) continue;
      if (b->second.bottom > link_.most_bottom_bounces) continue;
      seek_shadow(a->first, b->first, c->first, b->second);
    }
  }
  void seek_shadow(const FamilyRay& a, const FamilyRay& b, const FamilyRay& c, const Bounces& bounces) {
    const bool greatest = b.off_m >= a.off_m && b.off_m > c.off_m,
               least = b.off_m <= a.off_m && b.off_m < c.off_m;
    if (!greatest && !least) return;
    const double h = b.theta - a.theta, bend = a.off_m - 2 * b.off_m + c.off_m;
    const double turn = b.theta + 0.5 * h * (a.off_m - c.off_m) / bend;
    for (const Visited& one : visited_) {
      if (one.bounces == bounces && turn >= one.from && turn <= one.to) return;
    }
    const auto top = rays_.at(turn);
    if (!top || top->second != bounces) return;
    const double off = top->first.off_m;
    if (greatest ? off > 0 : off < 0) return;  // lit: its paths are found
    if (elementary::cos(turn) * link_.core_mps > link_.source_mps) return;
    const double sigma = sigma_of(turn);
    if (std::abs(off) > kReach * sigma) return;
    const double step = std::sqrt(2 * kStep * sigma * h * h / std::abs(bend));
    const Family family = family_of(top->first, bounces, sigma, std::min(step, kWidestStep));
    if (family.rays.size() < 3) return;
    const double gives_way = ramp(sigma / airy_length_m(family), kFoldStays, kFoldGone);
    if (gives_way <= 0) return;
    const std::optional<Eigenray> path = rays_.representative(turn);
    if (!path) return;
    double window = gives_way * family.sums.back() * strength_of(*path);
    // A path on the shadow side of the fold already has part of it.
    for (std::size_t i = 0; i < smoothed_.size(); ++i) {
      const Eigenray& one = paths_[i];
      if (one.surface_bounces == bounces.surface && one.bottom_bounces == bounces.bottom && !one.diffuse &&
          one.launch_angle_rad >= family.rays.front().theta &&
          one.launch_angle_rad <= family.rays.back().theta)
        window -= one.amplitude * one.amplitude;
    }
    visited_.push_back({bounces, family.rays.front().theta, family.rays.back().theta});
    if (window > 0) windows_.push_back({*path, window});
  }

  void add_windows() {
    if (windows_.empty()) return;
    double most = 0;
    for (const Eigenray& path : paths_) most = std::max(most, path.amplitude * path.amplitude);
    for (const Window& window : windows_) most = std::max(most, window.power);
    std::vector<int> used;
    for (const Window& window : windows_) {
      if (window.power < kNegligible * most) continue;
      int number = kFirstWindow + (64 * window.path.surface_bounces + 8 * window.path.bottom_bounces) % 8000;
      while (std::find(used.begin(), used.end(), number) != used.end()) ++number;
      used.push_back(number);
      Eigenray path = window.path;
      path.amplitude = std::sqrt(window.power);
      path.diffuse = true;
      path.phase_rad = 0;
      path.identity = diffuse_identity(1, static_cast<std::size_t>(number));
      paths_.push_back(path);
    }
    std::stable_sort(paths_.begin(), paths_.end(),
                     [](const Eigenray& a, const Eigenray& b) { return a.delay_s < b.delay_s; });
  }

  struct Visited {
    Bounces bounces;
    double from, to;
  };

  Rays rays_;
  SmoothedLink link_;
  std::vector<Eigenray>& paths_;
  double steepest_;
  std::array<double, kSigmas> sigmas_{};  // sigma_z at angles 0..steepest_, m; 0: not computed yet
  std::vector<bool> smoothed_;
  std::vector<Visited> visited_;
  std::vector<Window> windows_;
};

}  // namespace

void smooth_folds(const FlatSea& sea, const RayLink& link, std::vector<Eigenray>& paths) {
  const RayOptions& options = sea.options;
  const SmoothedLink over{sea.water,
                          options.fine_structure,
                          options.frequency_hz,
                          sea.core_speed_mps,
                          link.source_depth_m,
                          link.receiver_depth_m,
                          link.range_m,
                          sea.bottom_depth_m,
                          sea.water.speed_at(link.source_depth_m),
                          sea.water.speed_at(link.receiver_depth_m),
                          options.platform_jitter_m};
  FoldSmoother(LevelRays(sea, link), over, paths).run();
}

void smooth_folds(const ProfiledSea& sea, const RayLink& link, std::vector<Eigenray>& paths) {
  const RayOptions& options = sea.options;
  const double bottom = sea.profile.depth_at(link.range_m);
  const RayWater& last = sea.section != nullptr ? sea.section->columns().back() : sea.water;
  const SmoothedLink over{sea.water,
                          options.fine_structure,
                          options.frequency_hz,
                          sea.core_speed_mps,
                          link.source_depth_m,
                          link.receiver_depth_m,
                          link.range_m,
                          bottom,
                          sea.water.speed_at(link.source_depth_m),
                          last.speed_at(link.receiver_depth_m),
                          options.platform_jitter_m,
                          sea.profile.is_flat_until(link.range_m) ? kAnyBounces : kUnevenBounces};
  FoldSmoother(ProfiledRays(sea, link), over, paths).run();
}

}  // namespace halocline::acoustics
