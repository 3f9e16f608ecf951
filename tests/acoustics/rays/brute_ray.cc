// SPDX-License-Identifier: BSD-3-Clause
#include "tests/acoustics/rays/brute_ray.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "acoustics/sea/bottom_profile.h"
#include "acoustics/sea/boundary_reflection.h"
#include "acoustics/sea/sound_speed_profile.h"

namespace halocline::acoustics {
namespace {

constexpr double kFar = 1e8;         // m
constexpr double kTouching = 1e-10;  // m: a bottom at the depth of a knot is met there

void note(std::uint64_t& history, std::uint64_t what) {
  history = (history ^ (what + 1)) * 0x9E3779B97F4A7C15ULL;
  history ^= history >> 29;
}

}  // namespace

struct BruteTracer::State {
  double r, z, sine, cosine, c, g;
  double q, p;
  std::size_t layer;
  std::size_t left = SIZE_MAX;  // the facet it was reflected by and has not left
  std::size_t facet = 0;
  double sign = 1;  // flips at each reflection
};

BruteTracer::BruteTracer(const BruteSea& sea, double source_m, double range_m)
    : sea_(sea), source_(source_m), range_(range_m) {
  std::vector<ProfiledDepth> points = sea.bottom;
  points.insert(points.begin(), {-kFar, points.front().depth_m});
  points.push_back({kFar, points.back().depth_m});
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const auto &a = points[i], &b = points[i + 1];
    const double slope = (b.depth_m - a.depth_m) / (b.range_m - a.range_m), angle = std::atan(slope);
    shallowest_ = std::min({shallowest_, a.depth_m, b.depth_m});
    facets_.push_back({a.range_m, b.range_m, a.depth_m, slope, angle, angle, angle});
  }
  for (std::size_t i = 2; sea.curved && i + 1 < facets_.size(); ++i) {
    facets_[i - 1].angle1 = facets_[i].angle0 = (facets_[i - 1].angle + facets_[i].angle) / 2;
  }
  sea_.knots.push_back({sea_.knots.back().depth_m + 10, sea_.knots.back().sound_speed_mps});
  std::size_t i = 0;
  while (sea_.knots[i + 1].depth_m < source_) ++i;
  const SpeedRow &a = sea_.knots[i], &b = sea_.knots[i + 1];
  source_speed_ = a.sound_speed_mps +
                  (b.sound_speed_mps - a.sound_speed_mps) * (source_ - a.depth_m) / (b.depth_m - a.depth_m);
}

std::vector<double> BruteTracer::grazing_angles() const {
  std::vector<double> angles;
  for (const SpeedRow& knot : sea_.knots) {
    if (knot.sound_speed_mps > source_speed_)
      angles.push_back(std::acos(source_speed_ / knot.sound_speed_mps));
  }
  return angles;
}

// Depth of the arc `x` further on: the sine falls evenly with range.
double BruteTracer::depth_after(const State& s, double x, double* sine_there) {
  const double xi = s.cosine / s.c, sine = std::clamp(s.sine - xi * s.g * x, -1.0, 1.0);
  const double cosine = std::sqrt(1 - sine * sine);
  if (sine_there != nullptr) *sine_there = sine;
  return s.z + x * (s.sine + sine) / (s.cosine + cosine);
}

bool BruteTracer::first_meeting(const State& s, double reach, double& x, std::size_t& index) const {
  for (std::size_t i = s.facet; i < facets_.size() && facets_[i].r0 < s.r + reach; ++i) {
    const Facet& f = facets_[i];
    const double from = std::max(f.r0 - s.r, 0.0), to = std::min(f.r1 - s.r, reach);
    if (to < from) continue;
    const auto below = [&](double at) {
      return depth_after(s, at, nullptr) + kTouching - f.z0 - f.slope * (s.r + at - f.r0);
    };
    double parallel = from;  // where the arc runs along the facet
    if (s.g != 0) {
      const double sine = f.slope / std::sqrt(1 + f.slope * f.slope);
      parallel = std::clamp((s.sine - sine) * s.c / (s.cosine * s.g), from, to);
    }
    double low = from, high = from;
    const bool leaving = i == s.left;
    if (below(parallel) > 0 && !(leaving && parallel == from)) {
      high = parallel;
    } else if (below(to) > 0) {
      low = parallel;
      high = to;
      if (leaving && s.g == 0) continue;
      if (leaving && parallel == from) continue;
    } else {
      continue;
    }
    // The secant where it helps, halves otherwise.
    double at_low = below(low), at_high = below(high);
    for (int k = 0; high - low > 1e-12 * (1 + std::abs(high)); ++k) {
      const double share = std::clamp(at_low / (at_low - at_high), 1e-3, 1 - 1e-3);
      const double middle = low + (k % 3 == 2 || !(at_low < 0) ? 0.5 : share) * (high - low);
      if (middle <= low || middle >= high) break;
      const double off = below(middle);
      (off > 0 ? high : low) = middle;
      (off > 0 ? at_high : at_low) = off;
      if (std::abs(off) < 1e-13) {
        low = high = middle;
        break;
      }
    }
    x = 0.5 * (low + high);
    index = i;
    return true;
  }
  return false;
}

void BruteTracer::advance(State& s, BruteRay& ray, double dx, double z, double sine) const {
  const double xi = s.cosine / s.c, cosine = std::sqrt(1 - sine * sine), c = cosine / xi;
  const double chord = std::hypot(dx, z - s.z);
  ray.time_s += s.g == 0 ? chord / s.c
                         : 2 / std::abs(s.g) * std::asinh(std::abs(s.g) * chord / (2 * std::sqrt(s.c * c)));
  const double q = s.q + s.p * dx / xi;
  if ((q < 0) != (s.q < 0) && s.q != 0) ++ray.caustics;
  s.q = q;
  s.r += dx;
  s.z = z;
  s.sine = sine;
  s.cosine = cosine;
  s.c = c;
  if (dx > 0) s.left = SIZE_MAX;
  while (facets_[s.facet].r1 < s.r) ++s.facet;
}

void BruteTracer::cross(State& s, bool down) const {
  const auto gradient = [&](std::size_t i) {
    return (sea_.knots[i + 1].sound_speed_mps - sea_.knots[i].sound_speed_mps) /
           (sea_.knots[i + 1].depth_m - sea_.knots[i].depth_m);
  };
  s.layer = down ? s.layer + 1 : s.layer - 1;
  s.z = sea_.knots[down ? s.layer : s.layer + 1].depth_m;
  s.c = sea_.knots[down ? s.layer : s.layer + 1].sound_speed_mps;
  const double after = gradient(s.layer), change = down ? after - s.g : s.g - after;
  // A front bends where the gradient jumps: dp = -q cos^2 / (c^2 sin) dg, change taken along the ray.
  s.p -= s.q * (s.cosine * s.cosine) / (s.c * s.c) * change / std::abs(s.sine);
  s.g = after;
}

void BruteTracer::meet_surface(State& s, BruteRay& ray) {
  // An image of the water above: its gradient jumps by 2 g for a ray that goes up.
  s.p += 2 * s.q * (s.cosine * s.cosine) / (s.c * s.c) * s.g / s.sine;
  s.sine = -s.sine;
  s.sign = -s.sign;
  ++ray.surface;
  note(ray.bounces, 0);
}

bool BruteTracer::meet_bottom(State& s, BruteRay& ray, std::size_t index) const {
  const Facet& f = facets_[index];
  const double share = (s.r - f.r0) / (f.r1 - f.r0), own = std::atan2(s.sine, s.cosine);
  double tilt = f.angle0 + share * (f.angle1 - f.angle0);
  double bend = (f.angle1 - f.angle0) * std::cos(f.angle) / (f.r1 - f.r0);
  // A ray that the bent slope would not reflect upwards from the facet meets the facet itself.
  if (own - tilt <= 1e-9 || 2 * tilt - own >= f.angle - 1e-9) {
    tilt = f.angle;
    bend = 0;
  }
  const double grazing = own - tilt, out = tilt - grazing;
  if (std::cos(out) < 1e-3 || std::abs(out) > 1.6) return false;
  s.p += s.q / (s.c * s.c) * (s.g * (std::cos(own) + std::cos(out)) / std::tan(grazing)) +
         s.q * 2 * bend / (s.c * std::sin(grazing));
  const Reflection one = bottom_reflection_at_sine(sea_.sediment, std::sin(grazing), s.c);
  ray.factor *= one.magnitude;
  ray.bottom_phase_rad += one.phase_rad;
  s.sine = std::sin(out);
  s.cosine = std::cos(out);
  s.sign = -s.sign;
  s.left = index;
  ++ray.bottom;
  note(ray.bounces, sea_.curved ? 1 : 1 + index);
  return ray.factor >= sea_.min_factor;
}

BruteRay BruteTracer::trace(double theta) const {
  BruteRay ray;
  ray.theta = theta;
  State s{0, source_, std::sin(theta), std::cos(theta), source_speed_, 0, 0, 1 / source_speed_, 0};
  while (sea_.knots[s.layer + 1].depth_m < source_ ||
         (sea_.knots[s.layer + 1].depth_m == source_ && theta > 0)) {
    ++s.layer;
  }
  s.g = (sea_.knots[s.layer + 1].sound_speed_mps - sea_.knots[s.layer].sound_speed_mps) /
        (sea_.knots[s.layer + 1].depth_m - sea_.knots[s.layer].depth_m);
  while (facets_[s.facet].r1 <= 0) ++s.facet;
  for (int steps = 0; steps < 1'000'000; ++steps) {
    const bool down = s.sine > 0 || (s.sine == 0 && s.g < 0);
    const SpeedRow& knot = sea_.knots[down ? s.layer + 1 : s.layer];
    const double xi = s.cosine / s.c, cosine = xi * knot.sound_speed_mps;
    double dx = kFar, z = s.z, sine = -s.sine;
    const bool turns = cosine >= 1 && s.g != 0;
    if (turns) {
      dx = 2 * std::abs(s.sine) / (xi * std::abs(s.g));
    } else if (cosine < 1) {
      sine = (down ? 1 : -1) * std::sqrt((1 - cosine) * (1 + cosine));
      z = knot.depth_m;
      dx = (z - s.z) * (s.cosine + cosine) / (s.sine + sine);
    } else {
      sine = s.sine;
    }
    const double reach = std::min(dx, range_ - s.r);
    double x = 0;
    std::size_t facet = 0;
    const double deepest = turns && down ? s.z + (1 / xi - s.c) / s.g : std::max(s.z, z);
    if (deepest > shallowest_ - 1e-6 && first_meeting(s, reach, x, facet)) {
      double there = 0;
      depth_after(s, x, &there);
      if (s.sine > 0 && there < 0 && s.g > 0) note(ray.turns, s.layer);
      advance(s, ray, x, facets_[facet].z0 + facets_[facet].slope * (s.r + x - facets_[facet].r0), there);
      if (!meet_bottom(s, ray, facet)) return ray;
      continue;
    }
    if (dx >= range_ - s.r) {
      double there = 0;
      const double depth = depth_after(s, range_ - s.r, &there);
      advance(s, ray, range_ - s.r, depth, there);
      ray.arrived = true;
      ray.z = s.z;
      ray.sine = s.sine;
      ray.cosine = s.cosine;
      ray.speed = s.c;
      ray.q = s.q;
      ray.slope = s.sign * s.q / s.cosine;
      return ray;
    }
    if (turns) note(ray.turns, s.layer);
    advance(s, ray, dx, z, sine);
    if (turns) continue;
    if (!down && s.layer == 0) {
      meet_surface(s, ray);
    } else {
      cross(s, down);
    }
  }
  return ray;
}

}  // namespace halocline::acoustics
