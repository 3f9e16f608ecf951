// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/rays/search/ray_family.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "acoustics/math/fast_functions.h"
#include "acoustics/math/fold_field.h"

namespace halocline::acoustics {
namespace {

constexpr double kLongestStep = 2.4;   // sigma_z beyond which a step is halved
constexpr int kMaxHalvings = 7;        // of steps on one side of a family
constexpr int kMaxEdgeHalvings = 3;    // of those towards its edge
constexpr int kMaxFirstHalvings = 7;   // of the first step, until it stays within the family
constexpr int kMaxNarrowHalvings = 5;  // towards the edge of a family narrower than its first step
constexpr int kMaxSteps = 48;          // on one side
constexpr double kSteepest = 1.4;      // rad: families end there
constexpr double kBendReach = 2.5;     // sigma_z within which rays tell how zeta is bent
constexpr double kLeastLength = 1e-3;  // m
// sigma_z over the Airy length of a fold between which its field gives way.
constexpr double kFoldStays = 1, kFoldGone = 2;

// sqrt(2 pi) times the normal density of a ray that ends `off_m` below the receiver, reflected at surface and
// bottom.
double reflected_density(double off_m, const FamilySpread& spread) {
  const double scale = -0.5 / (spread.sigma_m * spread.sigma_m), depth = spread.receiver_m + off_m;
  const double mirrored = depth + spread.receiver_m, period = 2 * spread.bottom_m;
  double sum = 0;
  for (const double off : {off_m, mirrored, mirrored - period, off_m + period, off_m - period}) {
    const double exponent = off * off * scale;
    if (exponent > -18) sum += fast_exp(exponent);
  }
  return sum / spread.sigma_m;
}

double slope_between(const FamilyRay& a, const FamilyRay& b) {
  return (b.off_m - a.off_m) / (b.theta - a.theta);
}

}  // namespace

RayFamily::RayFamily(FamilyRays& rays, const FamilyRay& seed, const FamilySpread& spread, double step)
    : bounces_(seed.bounces), sigma_m_(spread.sigma_m) {
  add_side(rays, seed, spread.sigma_m, -step);
  std::reverse(rays_.begin(), rays_.end());
  rays_.push_back(seed);
  add_side(rays, seed, spread.sigma_m, step);
  sums_.assign(rays_.size(), 0);
  double before = reflected_density(rays_.front().off_m, spread);
  for (std::size_t i = 1; i < rays_.size(); ++i) {
    const double here = reflected_density(rays_[i].off_m, spread);
    sums_[i] = sums_[i - 1] + 0.5 * (before + here) * (rays_[i].theta - rays_[i - 1].theta);
    before = here;
  }
}

// With |zeta'| h + |zeta''| h^2 / 2 = kFamilyStep sigma_z for the next step h.
void RayFamily::add_side(FamilyRays& rays, const FamilyRay& seed, double sigma, double step) {
  FamilyRay last = seed;
  double slope_before = 0;
  int halvings = 0, edge_halvings = 0, first_halvings = 0;
  for (int i = 0; i < kMaxSteps && std::abs(last.theta + step) < kSteepest; ++i) {
    const std::optional<FamilyRay> ray = rays.at(last.theta + step);
    const bool same = ray && ray->bounces == bounces_;
    if (!same || std::abs(ray->off_m - last.off_m) > kLongestStep * sigma) {
      // The first step may be wider than the whole family, that of a focus.
      const bool is_narrow = !same && last.theta == seed.theta && ++first_halvings <= kMaxFirstHalvings;
      const int most_at_edge = first_halvings > 0 ? kMaxNarrowHalvings : kMaxEdgeHalvings;
      if (!is_narrow && (++halvings > kMaxHalvings || (!same && ++edge_halvings > most_at_edge))) return;
      step *= 0.5;
      continue;
    }
    const double slope = std::abs(slope_between(last, *ray)), signed_slope = slope_between(last, *ray);
    const double bend = i == 0 ? 0 : std::abs((signed_slope - slope_before) / step);
    slope_before = signed_slope;
    last = *ray;
    rays_.push_back(last);
    if (std::abs(last.off_m) > kFamilyReach * sigma) return;
    const double wanted = kFamilyStep * sigma;
    const double next = 2 * wanted / (slope + std::sqrt(slope * slope + 2 * bend * wanted));
    const double most = halvings + first_halvings > 0 ? std::abs(step) : 2 * std::abs(step);
    step = std::copysign(std::min({next, most, kWidestFamilyStep}), step);
  }
}

bool RayFamily::holds(const Eigenray& path) const {
  return !path.diffuse && bounces_of(path) == bounces_ && path.launch_angle_rad >= from() &&
         path.launch_angle_rad <= to();
}

std::size_t RayFamily::fold_between(const Eigenray& a, const Eigenray& b) const {
  std::size_t first = 0;
  while (first + 1 < rays_.size() && rays_[first].theta < a.launch_angle_rad) ++first;
  std::size_t furthest = first;
  for (std::size_t i = first; i < rays_.size() && rays_[i].theta <= b.launch_angle_rad; ++i) {
    if (std::abs(rays_[i].off_m) > std::abs(rays_[furthest].off_m)) furthest = i;
  }
  return furthest;
}

// The fold is where the parabola through the furthest ray and the two beside it turns, so that what the two
// paths have changes without steps as the rays of the family move.
double RayFamily::integral_to_fold(const Eigenray& a, const Eigenray& b) const {
  const std::size_t i = fold_between(a, b);
  if (i == 0 || i + 1 >= rays_.size()) return sums_[i];
  const double side = rays_[i].off_m > 0 ? 1 : -1;
  const auto distance = [&](std::size_t ray) { return side * rays_[ray].off_m; };
  const double before = rays_[i].theta - rays_[i - 1].theta, after = rays_[i + 1].theta - rays_[i].theta;
  const double rise = (distance(i) - distance(i - 1)) / before;
  const double fall = (distance(i) - distance(i + 1)) / after;
  if (!(rise + fall > 0)) return sums_[i];
  // The slopes `rise` and -`fall` hold in the middles of the two steps.
  const double turn = 0.5 * (rise * after - fall * before) / (rise + fall);
  const double share = std::clamp(turn / (turn < 0 ? before : after), -1.0, 1.0);
  return sums_[i] + std::abs(share) * (sums_[share < 0 ? i - 1 : i + 1] - sums_[i]);
}

double RayFamily::bend_at(double theta) const {
  std::size_t next = 1;
  while (next + 1 < rays_.size() && rays_[next].theta <= theta) ++next;
  // The chord beside the ray that is the least steep: one of them may span a kink of the profile.
  std::size_t end = next;
  for (std::size_t i = std::max<std::size_t>(next, 2) - 1; i <= std::min(next + 1, rays_.size() - 1); ++i) {
    if (std::abs(slope_between(rays_[i - 1], rays_[i])) < std::abs(slope_between(rays_[end - 1], rays_[end])))
      end = i;
  }
  const FamilyRay &a = rays_[end - 1], &b = rays_[end];
  const double slope = slope_between(a, b), middle = 0.5 * (a.theta + b.theta);
  double bend = 0;
  for (const FamilyRay& ray : rays_) {
    const double straight = slope * (ray.theta - middle);
    if (std::abs(straight) > kBendReach * sigma_m_ || &ray == &a || &ray == &b) continue;
    const double away = std::abs(ray.off_m - 0.5 * (a.off_m + b.off_m) - straight);
    bend = std::max(bend, away * 2 * sigma_m_ / std::max(straight * straight, 1e-12));
  }
  return bend;
}

double RayFamily::share_beyond_folds(double sigma_m, double frequency_hz, double receiver_mps) const {
  double all = 0, beyond = 0;
  for (std::size_t i = 1; i + 1 < rays_.size(); ++i) {
    const FamilyRay &a = rays_[i - 1], &b = rays_[i], &c = rays_[i + 1];
    const double power = sums_[i + 1] - sums_[i - 1], width = c.theta - a.theta;
    // The sine may turn between the three rays, where zeta does not: the slopes on both sides count.
    const double before = (b.sine - a.sine) / (b.theta - a.theta);
    const double after = (c.sine - b.sine) / (c.theta - b.theta);
    const Fold fold{2 * (slope_between(b, c) - slope_between(a, b)) / width,
                    std::sqrt(0.5 * (before * before + after * after)) / receiver_mps};
    all += power;
    if (fold.slowness_slope == 0) continue;
    const double lengths = sigma_m / std::max(fold.length_m(frequency_hz), kLeastLength);
    beyond += power * std::clamp((lengths - kFoldStays) / (kFoldGone - kFoldStays), 0.0, 1.0);
  }
  return all > 0 ? beyond / all : 0;
}

}  // namespace halocline::acoustics
