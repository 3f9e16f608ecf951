// SPDX-License-Identifier: BSD-3-Clause
#include "tests/acoustics/rays/brute_fan.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "acoustics/rays/eigenray.h"
#include "tests/acoustics/rays/brute_ray.h"

namespace halocline::acoustics {
namespace {

using std::numbers::pi;

constexpr double kMinStep = 1e-12;     // rad: neighbours of different histories
constexpr double kMinTurnStep = 1e-6;  // rad: neighbours that turned in different layers

BruteEigenray eigenray_of(const BruteTracer& tracer, const RayLink& link, const BruteRay& ray) {
  const double off = link.receiver_depth_m - ray.z;
  const double phase = pi * ray.surface + ray.bottom_phase_rad + pi / 2 * ray.caustics;
  // A^2 = c_r cos_s / (c_s r |q|), Jensen and others 2011, equation 3.65.
  const double spread =
      std::sqrt(ray.speed * std::cos(ray.theta) / (tracer.source_speed() * link.range_m * std::abs(ray.q)));
  return {ray.time_s + ray.sine / ray.speed * off,
          ray.factor * spread,
          phase - 2 * pi * std::floor(phase / (2 * pi)),
          ray.theta,
          std::atan2(ray.sine, ray.cosine),
          ray.surface,
          ray.bottom,
          ray.caustics};
}

class BruteFan {
 public:
  BruteFan(const BruteSea& sea, const RayLink& link)
      : tracer_(sea, link.source_depth_m, link.range_m), link_(link) {}

  std::vector<BruteEigenray> run(double steepest, int count) {
    const std::vector<double> angles = fan(steepest, count);
    BruteRay before = tracer_.trace(angles.front());
    for (std::size_t i = 1; i < angles.size(); ++i) {
      const BruteRay next = tracer_.trace(angles[i]);
      search(before, next);
      before = next;
    }
    return found_;
  }

 private:
  std::vector<double> fan(double steepest, int count) const {
    std::vector<double> angles;
    for (int i = 0; i <= count; ++i) angles.push_back(-steepest + 2 * steepest * (i + 0.137) / count);
    for (const double graze : tracer_.grazing_angles()) {
      for (double off = 1e-3; off > 1e-13; off *= 0.5) {
        for (const double side : {-off, off}) {
          angles.push_back(graze + side);
          angles.push_back(-graze + side);
        }
      }
    }
    for (double near = 1e-3; near > 1e-9; near *= 0.7) angles.insert(angles.end(), {near, -near});
    std::erase_if(angles, [steepest](double a) { return std::abs(a) > steepest || a == 0; });
    std::sort(angles.begin(), angles.end());
    return angles;
  }

  bool is_above(const BruteRay& ray) const { return ray.z < link_.receiver_depth_m; }

  void search(const BruteRay& a, const BruteRay& b) {
    const double width = b.theta - a.theta, middle = 0.5 * (a.theta + b.theta);
    if (!a.arrived && !b.arrived) return;
    const bool alike = a.arrived && b.arrived && a.bounces == b.bounces;
    if (!alike || (a.turns != b.turns && width > kMinTurnStep)) {
      if (width < kMinStep || middle <= a.theta || middle >= b.theta) return;
      const BruteRay between = tracer_.trace(middle);
      search(a, between);
      search(between, b);
      return;
    }
    if (is_above(a) != is_above(b)) {
      bisect(a, b);
      return;
    }
    // Does the depth turn towards the receiver between them?
    const double toward = is_above(a) ? 1 : -1;
    if (a.slope * toward > 0 && b.slope * toward < 0) seek_turn(a, b, toward);
  }

  void seek_turn(const BruteRay& a, const BruteRay& b, double toward) {
    BruteRay low = a, high = b;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low.theta + high.theta);
      if (middle <= low.theta || middle >= high.theta) return;
      const BruteRay between = tracer_.trace(middle);
      if (!between.arrived || between.bounces != a.bounces) return;
      if (is_above(between) != is_above(a)) {
        bisect(a, between);
        bisect(between, b);
        return;
      }
      (between.slope * toward > 0 ? low : high) = between;
    }
  }

  void bisect(const BruteRay& a, const BruteRay& b) {
    double low = a.theta, high = b.theta;
    BruteRay ray = a;
    for (;;) {
      const double middle = 0.5 * (low + high);
      if (middle <= low || middle >= high) break;
      const BruteRay between = tracer_.trace(middle);
      if (!between.arrived || between.bounces != a.bounces) return search_again(a, between, b);
      ray = between;
      (is_above(between) == is_above(a) ? low : high) = middle;
      if (std::abs(ray.z - link_.receiver_depth_m) < 1e-9) break;
    }
    if (std::abs(ray.z - link_.receiver_depth_m) < 1e-3) note(ray);
  }

  void search_again(const BruteRay& a, const BruteRay& between, const BruteRay& b) {
    search(a, between);
    search(between, b);
  }

  void note(const BruteRay& ray) { found_.push_back(eigenray_of(tracer_, link_, ray)); }

  BruteTracer tracer_;
  RayLink link_;
  std::vector<BruteEigenray> found_;
};

}  // namespace

std::vector<BruteEigenray> brute_eigenrays(const BruteSea& sea, const RayLink& link, double steepest_rad,
                                           int count) {
  return BruteFan(sea, link).run(steepest_rad, count);
}

std::optional<BruteEigenray> brute_eigenray(const BruteSea& sea, const RayLink& link, double launch_rad) {
  const BruteTracer tracer(sea, link.source_depth_m, link.range_m);
  const BruteRay ray = tracer.trace(launch_rad);
  if (!ray.arrived || std::abs(ray.z - link.receiver_depth_m) > 1e-3) return std::nullopt;
  return eigenray_of(tracer, link, ray);
}

}  // namespace halocline::acoustics
