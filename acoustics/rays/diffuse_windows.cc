// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/rays/diffuse_windows.h"

#include <cmath>
#include <limits>
#include <optional>

#include "acoustics/rays/traced_eigenray.h"
#include "acoustics/sea/ray_water.h"
#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

constexpr double kMinTurnSine = 0.02;  // lower bound of the sine in p, where a ray turns
constexpr double kBesideMargin = 8;    // in power
constexpr double kDepthStep = 50;      // m: spacing of depths at which the absorption is evaluated
constexpr double kManyImages = 4;      // images of the receiver within a window
constexpr double kMaxFocusing = 4;     // greatest power of all paths of mixed rays over its mean
// Greatest field of a fold over that of a single ray at the edge of its shadow, in power:
// Ai(-1.02)^2 / Ai(0)^2.
constexpr double kFoldPeak = 2.3;

// Lower bound of the power of a path of that received pressure, with its absorption removed: a path is at
// least as long as the range, and its absorption per metre is at least the least one above the deepest
// bottom.
double power_without_absorption(const ArcTracer& tracer, double pressure) {
  if (pressure <= 0) return 0;
  const RayWater& water = tracer.sea().water;
  const double deepest = tracer.sea().profile.deepest_m();
  double least_db_per_m = std::numeric_limits<double>::infinity();
  for (double depth = 0;; depth = std::min(depth + kDepthStep, deepest)) {
    least_db_per_m = std::min(least_db_per_m, water.absorption_db_per_m(depth));
    if (depth >= deepest) break;
  }
  return pressure * pressure * elementary::exp10(least_db_per_m * tracer.range_m() / 10);
}

}  // namespace

DiffuseWindows::DiffuseWindows(const ArcTracer& tracer)
    : tracer_(tracer),
      receiver_speed_(tracer.water_at_receiver().speed_at(tracer.receiver_depth_m())),
      max_loss_db_(-20 * elementary::log10(tracer.sea().options.min_boundary_factor)),
      weak_(elementary::exp10(-tracer.sea().options.diffuse_below_db / 10)),
      least_(power_without_absorption(tracer, tracer.sea().options.diffuse_below_pressure)) {}

void DiffuseWindows::begin_cell(std::size_t cell) {
  cell_ = cell;
  if (cells_.size() <= cell) cells_.resize(cell + 1);
}

// Near a caustic the tube is too narrow to tell the strength of the path, so the pressure is limited to that
// of spherical spreading.
void DiffuseWindows::note(const Eigenray& path) {
  const double spherical = elementary::exp10(-path.bounce_loss_db() / 20) / path.path_length_m;
  const double pressure = std::min(path.amplitude, spherical);
  strongest_ = std::max(strongest_, pressure * pressure);
}

double DiffuseWindows::strength(const FanRay& ray) const {
  if (!ray.arrived || ray.loss_db > max_loss_db_) return 0;
  // xi_r = sqrt(1 / c_r^2 - s^2), s the vertical slowness at the receiver; the result is f^2 xi_s / (xi_r r).
  const double xi_s = elementary::cos(ray.theta) / tracer_.source_speed_mps(), s = ray.slowness;
  const double xi_r = std::sqrt(std::max(1 / (receiver_speed_ * receiver_speed_) - s * s,
                                         kMinCosine * kMinCosine / (receiver_speed_ * receiver_speed_)));
  return elementary::exp10(-ray.loss_db / 10) * xi_s / (xi_r * tracer_.range_m());
}

bool DiffuseWindows::is_weak_branch(const FanRay& a, const FanRay& b) const {
  if (!a.arrived || !b.arrived) return false;
  const double most = std::max(strength(a), strength(b));
  if (a.zeta_slope * b.zeta_slope > 0)
    return most * (b.theta - a.theta) < weak_power() * cubic_of(a, b).least_slope();
  // The bound covers both rays of the fold and the field around it.
  const double tube = fold_between(a, b).tube_slope(0, tracer_.sea().options.frequency_hz);
  return most * kFoldPeak < weak_power() * tube;
}

bool DiffuseWindows::is_weak_beside(const FanRay& a, const FanRay& b) const {
  const auto is_weak = [&](const FanRay& ray) {
    return !ray.arrived || kBesideMargin * strength(ray) < weak_power() * std::abs(ray.zeta_slope);
  };
  return is_weak(a) && is_weak(b);
}

bool DiffuseWindows::is_weak_together(const FanRay& a, const FanRay& b) const {
  const double images = std::min(std::abs(a.zeta_slope), std::abs(b.zeta_slope)) * (b.theta - a.theta) /
                        tracer_.bottom_at_receiver_m();
  return a.arrived && b.arrived && images > kManyImages && kMaxFocusing * energy_flux(a, b) < weak_power();
}

void DiffuseWindows::weigh(Cell& cell, const FanRay& ray, double power) const {
  if (power <= cell.most) return;
  cell.most = power;
  cell.theta = ray.theta;
}

// Each image contributes strength / |slope|, with |slope| = |zeta_b - zeta_a| / (theta_b - theta_a); the two
// rays contribute half each.
void DiffuseWindows::add_branch(const FanRay& a, const FanRay& b, int images) {
  const double apart = std::abs(b.zeta - a.zeta), width = b.theta - a.theta;
  if (images == 0 || !(apart > 0)) return;
  Cell& cell = cells_[cell_];
  for (const FanRay* ray : {&a, &b}) {
    const double power = 0.5 * images * strength(*ray) * width / apart;
    cell.branch += power;
    weigh(cell, *ray, power);
  }
}

void DiffuseWindows::add_energy_flux(const FanRay& a, const FanRay& b) {
  Cell& cell = cells_[cell_];
  for (const FanRay* ray : {&a, &b}) {
    const double flux = 0.5 * strength(*ray) * (b.theta - a.theta);
    cell.mixed += flux;
    weigh(cell, *ray, flux / tracer_.bottom_at_receiver_m());
  }
}

// The power strength p dtheta with the mean density p = 1 / H over the water depth H at the receiver.
double DiffuseWindows::energy_flux(const FanRay& a, const FanRay& b) const {
  return 0.5 * (strength(a) + strength(b)) * (b.theta - a.theta) / tracer_.bottom_at_receiver_m();
}

// Half a cycle is the integral of cot(angle) dz over the part of the water column that the ray reaches. Per
// layer,
//   dr = h xi (c1 + c2) / (s1 + s2),  or s / (xi |g|) up to a turn.
double DiffuseWindows::density(double xi) const {
  const auto square = [xi](double speed) { return 1 - xi * xi * speed * speed; };
  const RayWater& water = tracer_.water_at_receiver();
  const double bottom = tracer_.bottom_at_receiver_m(), here = square(receiver_speed_);
  if (here <= 0) return 0;
  double half = 0;
  for (std::size_t i = 0; i + 1 < water.depths_m().size() && water.depths_m()[i] < bottom; ++i) {
    const double top = water.depths_m()[i], end = std::min(water.depths_m()[i + 1], bottom);
    const double c1 = water.speeds_mps()[i], g = water.gradients_per_s()[i], c2 = c1 + g * (end - top);
    const double s1 = std::sqrt(std::max(square(c1), 0.0)), s2 = std::sqrt(std::max(square(c2), 0.0));
    if (s1 == 0 && s2 == 0) continue;
    half += s1 > 0 && s2 > 0 ? (end - top) * xi * (c1 + c2) / (s1 + s2) : (s1 + s2) / (xi * std::abs(g));
  }
  return xi * receiver_speed_ / std::max(std::sqrt(here), kMinTurnSine) / half;
}

std::vector<Eigenray> DiffuseWindows::eigenrays(DepthFanCache* cache) const {
  std::vector<Eigenray> all;
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const Cell& cell = cells_[i];
    if (!(cell.most > 0)) continue;
    std::optional<DiffuseRay> ray =
        cache != nullptr ? cache->diffuse(cell.theta, i) : diffuse_ray(tracer_, cell.theta, i);
    if (!ray) continue;
    const double power = cell.branch + cell.mixed * density(ray->xi);
    if (!(power > 0)) continue;
    ray->eigenray.amplitude = std::sqrt(power);
    all.push_back(ray->eigenray);
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Eigenray& a, const Eigenray& b) { return a.delay_s < b.delay_s; });
  return all;
}

}  // namespace halocline::acoustics
