// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/rays/depth_fan.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "acoustics/math/hermite_cubic.h"
#include "acoustics/rays/branch_solver.h"
#include "acoustics/rays/profile_rays.h"
#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

constexpr double kZetaTolerance = 5e-3;   // m: zeta, between the two cubics of a path
constexpr double kSlopeTolerance = 4e-3;  // relative: between the slopes of the two cubics
// Seconds: slope of the delay over the span between the two paths; the error of the delay is an eighth of it.
constexpr double kDelayTolerance = 3e-7;
constexpr double kMaxSpread = 0.1;  // relative difference of the two paths' spreading over slope
constexpr double kMaxLossDb = 0.5;  // between the two paths, of bounces and of absorption
constexpr double kMaxPhaseRad = 0.3;
constexpr double kMaxSlack = 100, kMaxDelaySlack = 10;

// Spreading of a path: 1 / A^2 without the losses of bounces.
double spreading(const Eigenray& path) {
  return elementary::exp10(-path.bounce_loss_db() / 10) / (path.amplitude * path.amplitude);
}

double mixed(double a, double b, double share) { return a + share * (b - a); }

}  // namespace

bool PathChains::Chain::holds(const ImageHit& path) const {
  const ImageHit& one = nodes.front().path;
  return one.family == path.family && one.eigenray.caustics == path.eigenray.caustics &&
         one.eigenray.identity == path.eigenray.identity && (one.zeta_slope > 0) == (path.zeta_slope > 0);
}

std::int64_t PathChains::number_of(const ReceiverImage& image) {
  return 2 * static_cast<std::int64_t>(image.k) + (image.sign > 0 ? 1 : 0);
}

void PathChains::keep(const ImageHit& path, const ReceiverImage& image) {
  const double depth_m = tracer_.receiver_depth_m();
  note_strength(path.eigenray);
  Node node{depth_m, tracer_.water_at_receiver().speed_at(depth_m), strongest_.size() - 1, path};
  std::vector<Chain>& chains = chains_[number_of(image)];
  const auto chain =
      std::find_if(chains.begin(), chains.end(), [&](const Chain& one) { return one.holds(path); });
  if (chain == chains.end()) {
    chains.push_back({{std::move(node)}});
    return;
  }
  const auto place = std::lower_bound(chain->nodes.begin(), chain->nodes.end(), depth_m,
                                      [](const Node& one, double depth) { return one.depth_m < depth; });
  if (place != chain->nodes.end() && place->depth_m == depth_m) {
    chain->is_several = true;
    return;
  }
  chain->nodes.insert(place, std::move(node));
}

std::optional<ImageHit> PathChains::between(const FanRay& a, const FanRay& b, const ReceiverImage& image) {
  const auto chains = chains_.find(number_of(image));
  if (chains == chains_.end()) return std::nullopt;
  std::optional<ImageHit> found;
  for (const Chain& chain : chains->second) {
    const auto below = std::upper_bound(chain.nodes.begin(), chain.nodes.end(), tracer_.receiver_depth_m(),
                                        [](double depth, const Node& one) { return depth < one.depth_m; });
    if (chain.is_several || below == chain.nodes.begin() || below == chain.nodes.end()) continue;
    auto path = interpolated(*std::prev(below), *below, image);
    if (!path || path->eigenray.launch_angle_rad < a.theta || path->eigenray.launch_angle_rad > b.theta)
      continue;
    if (found) return std::nullopt;
    found = std::move(path);
  }
  if (found) note_strength(found->eigenray);
  return found;
}

void PathChains::note_strength(const Eigenray& path) {
  strongest_.back() = std::max(strongest_.back(), path.received_pressure());
}

double PathChains::slack_of(const Node& a, const Node& b) const {
  const auto weakness = [this](const Node& node) {
    const double ratio = strongest_[node.receiver] / node.path.eigenray.received_pressure();
    return ratio * ratio;
  };
  return std::clamp(std::min(weakness(a), weakness(b)), 1.0, kMaxSlack);
}

// Snell's xi is interpolated linearly between the two nodes, whatever the profile does there.
std::optional<PathChains::Direction> PathChains::direction_between(const Node& a, const Node& b,
                                                                   double sine_a, double sine_b,
                                                                   double share) const {
  const double speed_mps = tracer_.water_at_receiver().speed_at(mixed(a.depth_m, b.depth_m, share));
  const double cosine = speed_mps * mixed(std::sqrt(1 - sine_a * sine_a) / a.speed_mps,
                                          std::sqrt(1 - sine_b * sine_b) / b.speed_mps, share);
  if (!(cosine < 1) || sine_a * sine_b <= 0) return std::nullopt;
  return Direction{std::copysign(std::sqrt(1 - cosine * cosine), sine_a), speed_mps};
}

std::optional<ImageHit> PathChains::interpolated(const Node& a, const Node& b,
                                                 const ReceiverImage& image) const {
  using std::numbers::pi;
  const Eigenray &one = a.path.eigenray, &other = b.path.eigenray;
  const double height = b.depth_m - a.depth_m, share = (tracer_.receiver_depth_m() - a.depth_m) / height;
  const double slack = slack_of(a, b);
  const double loss_a = one.bounce_loss_db(), loss_b = other.bounce_loss_db();
  if (std::abs(loss_b - loss_a) > slack * kMaxLossDb ||
      std::abs(other.absorption_db - one.absorption_db) > slack * kMaxLossDb)
    return std::nullopt;
  const double turned = std::remainder(other.phase_rad - one.phase_rad, 2 * pi);
  if (std::abs(turned) > slack * kMaxPhaseRad) return std::nullopt;
  // Launch angle over depth, and zeta over launch angle.
  const HermiteCubic angle(one.launch_angle_rad, image.sign / a.path.zeta_slope, other.launch_angle_rad,
                           image.sign / b.path.zeta_slope, height);
  const double theta = angle(share), width = other.launch_angle_rad - one.launch_angle_rad;
  const double t = (theta - one.launch_angle_rad) / width;
  if (!(t > 0 && t < 1)) return std::nullopt;
  const HermiteCubic zeta(image.sign * a.depth_m, a.path.zeta_slope, image.sign * b.depth_m,
                          b.path.zeta_slope, width);
  const double slope = image.sign * height / angle.slope(share), other_slope = zeta.slope(t) / width;
  if (std::abs(zeta(t) - image.sign * tracer_.receiver_depth_m()) > slack * kZetaTolerance ||
      !(std::abs(slope - other_slope) < slack * kSlopeTolerance * std::abs(slope)))
    return std::nullopt;
  const double sine_a = elementary::sin(one.arrival_angle_rad),
               sine_b = elementary::sin(other.arrival_angle_rad);
  const auto direction = direction_between(a, b, sine_a, sine_b, share);
  if (!direction) return std::nullopt;
  const HermiteCubic delay(one.delay_s, sine_a / a.speed_mps, other.delay_s, sine_b / b.speed_mps, height);
  // The error of a cubic has its steepest slope near the quarters.
  for (const double part : {0.25, 0.75}) {
    const auto there = direction_between(a, b, sine_a, sine_b, part);
    if (!there || std::abs(delay.slope(part) - there->sine / there->speed_mps * height) >
                      std::min(slack, kMaxDelaySlack) * kDelayTolerance)
      return std::nullopt;
  }
  const double spread_a = spreading(one) / std::abs(a.path.zeta_slope),
               spread_b = spreading(other) / std::abs(b.path.zeta_slope);
  if (std::abs(spread_b - spread_a) > slack * kMaxSpread * spread_a) return std::nullopt;

  ImageHit path{one, image.target, slope, a.path.family};
  Eigenray& mean = path.eigenray;
  const auto mix = [&](double Eigenray::*field) { mean.*field = mixed(one.*field, other.*field, share); };
  for (const auto field : {&Eigenray::range_slowness_spm, &Eigenray::path_length_m, &Eigenray::absorption_db,
                           &Eigenray::surface_loss_db, &Eigenray::bottom_loss_db,
                           &Eigenray::surface_sine_squares, &Eigenray::bottom_sine_squares})
    mix(field);
  mean.delay_s = delay(share);
  mean.launch_angle_rad = theta;
  mean.arrival_angle_rad = elementary::asin(direction->sine);
  mean.launch_slowness_spm = elementary::cos(theta) / tracer_.source_speed_mps();
  mean.amplitude = elementary::exp10(-mean.bounce_loss_db() / 20) /
                   std::sqrt(mixed(spread_a, spread_b, share) * std::abs(slope));
  mean.phase_rad = positive_angle(one.phase_rad + share * turned);
  return path;
}

FanRay DepthFanCache::traced(double theta, std::size_t enough_events) {
  const Key key{theta, enough_events};
  if (const auto known = rays_.find(key); known != rays_.end()) return known->second;
  const FanRay ray = fan_.trace(theta, enough_events);
  if (fan_.kept_events() > kMaxEvents) return ray;
  kept_events_ = fan_.kept_events();
  rays_.emplace(key, ray);
  return ray;
}

std::optional<DiffuseRay> DepthFanCache::diffuse(double theta, std::size_t window) {
  const auto [known, is_new] = diffuse_.try_emplace(theta);
  if (is_new) known->second = diffuse_ray(tracer_, theta, window);
  std::optional<DiffuseRay> ray = known->second;
  if (ray) ray->eigenray.identity = diffuse_identity(theta, window);
  return ray;
}

class DepthFan::Fan {
 public:
  Fan(const ProfiledSea& sea, const RayLink& link)
      : tracer_(sea, link), fan_(tracer_), cache_(tracer_, fan_), angles_(launch_angles(tracer_)) {
    branches_ = ProfileSearch(tracer_, fan_).branches(angles_);
    fan_.forget_since(0);
  }
  const RayOptions& options() const { return tracer_.sea().options; }

  std::vector<Eigenray> at(double receiver_depth_m) {
    tracer_.move_receiver(receiver_depth_m);
    cache_.chains().begin_receiver();
    return branches_ ? of_branches() : over_rough_bottom();
  }

 private:
  std::vector<Eigenray> of_branches() {
    BranchSolver solver(tracer_, fan_);
    solver.share(&cache_);
    for (const Branch& branch : *branches_) {
      if (!solver.may_pass_image(branch.low, branch.high)) continue;
      if (branch.is_monotone) {
        solver.solve_monotone(branch.a, branch.b);
      } else {
        solver.solve(branch.a, branch.b);
      }
    }
    return solver.finished();
  }
  std::vector<Eigenray> over_rough_bottom() { return profile_rays(tracer_, fan_, angles_, &cache_); }

  ArcTracer tracer_;
  FanTracer fan_;
  DepthFanCache cache_;
  std::vector<double> angles_;
  std::optional<std::vector<Branch>> branches_;  // empty over a rough bottom
};

DepthFan::DepthFan() = default;
DepthFan::~DepthFan() = default;

std::vector<Eigenray> DepthFan::at(const ProfiledSea& sea, const RayLink& link) {
  validate(sea.options);
  // The rays that are left out depend on the receiver's depth.
  if (sea.core_speed_mps > 0) return profile_rays(sea, link);
  ProfiledSea wide = sea;
  if (!fans_.empty()) wide.options = widened(sea.options);
  auto fan = std::find_if(fans_.begin(), fans_.end(), [&](const auto& one) {
    return one->options() == sea.options || one->options() == wide.options;
  });
  if (fan == fans_.end()) fan = fans_.insert(fan, std::make_unique<Fan>(wide, link));
  std::vector<Eigenray> paths = (*fan)->at(link.receiver_depth_m);
  if (!((*fan)->options() == sea.options)) drop_faint(paths, sea.options);
  return paths;
}

}  // namespace halocline::acoustics
