// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/rays/range_fan.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "acoustics/math/hermite_cubic.h"
#include "acoustics/rays/profile_rays.h"
#include "acoustics/rays/traced_eigenray.h"
#include "core/check.h"
#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

using std::numbers::pi;

constexpr double kCoarseness = 0.1;  // spacing of the fan, relative to the first fan of a search
// Share of the ranges: if the bounce sequences of two rays differ at more, others lie between the two.
constexpr double kDiffering = 0.3;
constexpr int kHalvings = 2;         // halvings of an interval of the fan
constexpr double kSameRange = 1e-3;  // m
constexpr double kMinSlope = 1;      // m: lower bound of a ray on a caustic
constexpr double kMinBend = 0.2;     // lower bound of a slope, relative to those of the neighbouring rays
// Share of zeta between two rays by which it may differ from where their slopes lead.
constexpr double kGoesOn = 0.3;
// Radians between the phases of two rays, beyond which the nearer ray's phase is taken.
constexpr double kTurned = 1;

// Linear interpolation from `a` to `b`.
double mixed(double a, double b, double share) { return a + share * (b - a); }

// The slope of a ray tube, at least that at the fold. tube_slope(0)^6 = 0.25 d2u^4 / (omega dp)^2 tells
// without roots when the slope is clearly greater.
double held_wide(double slope, const Fold& fold, double frequency_hz) {
  const double square = slope * slope, bent = fold.curvature * fold.curvature;
  const double turned = 2 * pi * frequency_hz * fold.slowness_slope;
  if (square * square * square * turned * turned > bent * bent) return slope;
  return std::max(slope, fold.tube_slope(0, frequency_hz));
}

// True when zeta is continuous between two rays: they may differ by turns, but not by bounces.
bool are_alike(const Eigenray& a, const Eigenray& b) {
  return a.surface_bounces == b.surface_bounces && a.bottom_bounces == b.bottom_bounces;
}

bool lies_between(double value, double a, double b) { return (value - a) * (value - b) <= 0; }

}  // namespace

RangeFan::RangeFan(std::vector<double> ranges_m) : ranges_m_(std::move(ranges_m)) {
  require(std::is_sorted(ranges_m_.begin(), ranges_m_.end()), "ranges along a bearing rise");
}

RangeFan::Traced RangeFan::traced(const ArcTracer& tracer, double theta) const {
  Traced traced{theta, {}, {}};
  tracer.trace_past(theta, ranges_m_, [&](std::size_t at, const RayTrace& ray, const TraceDetails& details) {
    const double cosine = std::sqrt(1 - ray.sine * ray.sine);
    const double orientation = (ray.surface_bounces + ray.bottom_bounces) % 2 == 0 ? 1 : -1;
    traced.places.push_back({ray.zeta, orientation, ray.zeta - orientation * ray.z, Before::kNone});
    traced.rays.push_back({ray.zeta_slope, orientation * ray.sine * ray.xi / cosine,
                           eigenray_of(tracer, ray, details, {ranges_m_[at], ray.zeta, cosine})});
  });
  return traced;
}

void RangeFan::halve(const ArcTracer& tracer, std::vector<Traced>& fan, Traced next, int halvings) const {
  const std::vector<Ray>&one = fan.back().rays, &other = next.rays;
  const std::size_t common = std::min(one.size(), other.size());
  std::size_t differing = 0;
  for (std::size_t at = 0; at < common; ++at)
    differing += one[at].path.identity == other[at].path.identity ? 0 : 1;
  if (halvings > 0 && static_cast<double>(differing) > kDiffering * static_cast<double>(common)) {
    halve(tracer, fan, traced(tracer, 0.5 * (fan.back().theta + next.theta)), halvings - 1);
    halve(tracer, fan, std::move(next), halvings - 1);
  } else {
    fan.push_back(std::move(next));
  }
}

const RangeFan::Fan& RangeFan::fan_of(const ProfiledSea& sea, double source_depth_m) {
  ProfiledSea wide = sea;
  wide.options = widened(sea.options);
  const auto known =
      std::find_if(fans_.begin(), fans_.end(), [&](const Fan& one) { return one.options == wide.options; });
  if (known != fans_.end()) return *known;
  const ArcTracer tracer(wide, {source_depth_m, 0, ranges_m_.back()});
  std::vector<Traced> all;
  for (const double theta : even_angles(kSteepestRay, kCoarseness)) {
    Traced next = traced(tracer, theta);
    if (all.empty()) {
      all.push_back(std::move(next));
    } else {
      halve(tracer, all, std::move(next), kHalvings);
    }
  }
  Fan fan{wide.options, std::vector<Range>(ranges_m_.size())};
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t at = 0; at < all[i].rays.size(); ++at) {
      Place place = all[i].places[at];
      if (i > 0 && at < all[i - 1].rays.size()) {
        const bool alike = are_alike(all[i - 1].rays[at].path, all[i].rays[at].path);
        place.before = alike ? Before::kAlike : Before::kOther;
      }
      fan.ranges[at].places.push_back(place);
      fan.ranges[at].rays.push_back(all[i].rays[at]);
    }
  }
  fans_.push_back(std::move(fan));
  return fans_.back();
}

Fold RangeFan::fold_between(const Ray& one, const Ray& other) {
  const double width = other.path.launch_angle_rad - one.path.launch_angle_rad;
  return {(other.zeta_slope - one.zeta_slope) / width, (other.slowness - one.slowness) / width};
}

// The path to an image beside the ray `i`.
Eigenray RangeFan::beside(const Range& range, std::size_t i, double target) {
  const Ray& ray = range.rays[i];
  Eigenray path = ray.path;
  const double off = target - range.places[i].zeta;
  path.delay_s += ray.slowness * off;
  path.launch_angle_rad += off / ray.zeta_slope;
  path.amplitude /= std::sqrt(std::max(std::abs(ray.zeta_slope), kMinSlope));
  return path;
}

// The mean of two eigenrays, `share` of the way from one to the other, for all fields that are interpolated
// linearly.
Eigenray RangeFan::mean_of(const Ray& one, const Ray& other, double share) {
  Eigenray path = share < 0.5 ? one.path : other.path;
  const auto mix = [&](double Eigenray::*field) {
    path.*field = mixed(one.path.*field, other.path.*field, share);
  };
  for (const auto field :
       {&Eigenray::amplitude, &Eigenray::arrival_angle_rad, &Eigenray::launch_angle_rad,
        &Eigenray::launch_slowness_spm, &Eigenray::range_slowness_spm, &Eigenray::path_length_m,
        &Eigenray::absorption_db, &Eigenray::surface_loss_db, &Eigenray::bottom_loss_db,
        &Eigenray::surface_sine_squares, &Eigenray::bottom_sine_squares})
    mix(field);
  const double turned = std::remainder(other.path.phase_rad - one.path.phase_rad, 2 * pi);
  if (std::abs(turned) < kTurned) path.phase_rad = positive_angle(one.path.phase_rad + share * turned);
  return path;
}

// The path to an image between the rays `b` - 1 and `b`, between which zeta does not turn.
Eigenray RangeFan::between(const Range& range, std::size_t b, double target, double frequency_hz) {
  const Ray &one = range.rays[b - 1], &other = range.rays[b];
  const double zeta = range.places[b - 1].zeta, height = range.places[b].zeta - zeta;
  const double width = other.path.launch_angle_rad - one.path.launch_angle_rad;
  const double share = (target - zeta) / height, mean_slope = height / width;
  const HermiteCubic angle(one.path.launch_angle_rad, 1 / one.zeta_slope, other.path.launch_angle_rad,
                           1 / other.zeta_slope, height);
  const HermiteCubic delay(one.path.delay_s, one.slowness, other.path.delay_s, other.slowness, height);
  const double along = (angle(share) - one.path.launch_angle_rad) / width;
  const double bend = angle.slope(share) / width;
  // A cubic that does not rise as the angles do indicates structure between the two rays that they do not
  // show.
  const bool is_smooth = along > 0 && along < 1 && bend > kMinBend;
  double slope = std::abs(is_smooth ? mean_slope / bend : mean_slope);
  slope = std::max(slope, kMinBend * std::min(std::abs(one.zeta_slope), std::abs(other.zeta_slope)));
  slope = held_wide(slope, fold_between(one, other), frequency_hz);
  Eigenray path = mean_of(one, other, is_smooth ? along : share);
  path.delay_s = delay(share);
  path.amplitude /= std::sqrt(slope);
  return path;
}

// Adds the paths to an image near the fold between the rays `b` - 1 and `b`, with zeta a parabola about its
// turn (acoustics/math/fold_field.h).
void RangeFan::add_fold(const Range& range, std::size_t b, double target, double frequency_hz,
                        std::vector<Eigenray>& paths) {
  const Ray &one = range.rays[b - 1], &other = range.rays[b];
  const double width = other.path.launch_angle_rad - one.path.launch_angle_rad;
  const Fold fold = fold_between(one, other);
  const double at_turn = -one.zeta_slope / fold.curvature;  // rad from the first ray
  const double turn = range.places[b - 1].zeta + 0.5 * one.zeta_slope * at_turn;
  const double x = (target - turn) / std::copysign(fold.length_m(frequency_hz), fold.curvature);
  if (x < kDarkFold) return;
  const auto add = [&](double after, double slope) {
    Eigenray path = mean_of(one, other, after / width);
    // Delay by the mean slowness between the nearer ray and the path.
    const Ray& nearer = after < 0.5 * width ? one : other;
    const double zeta = range.places[after < 0.5 * width ? b - 1 : b].zeta;
    path.delay_s =
        nearer.path.delay_s +
        0.5 * (nearer.slowness + mixed(one.slowness, other.slowness, after / width)) * (target - zeta);
    path.amplitude /= std::sqrt(slope);
    paths.push_back(path);
  };
  if (x < kMergedFold) return add(at_turn, fold.tube_slope(std::min(x, 0.0), frequency_hz));
  const double off = std::sqrt(2 * (target - turn) / fold.curvature);
  const double factor = x < kLitFold ? fold_share(x).factor : 1;
  for (const double after : {at_turn - off, at_turn + off}) {
    if (after < 0 || after > width) continue;
    add(after, std::abs(fold.curvature) * off / (factor * factor));
  }
}

std::vector<Eigenray> RangeFan::at(const ProfiledSea& sea, const RayLink& link) {
  const auto place = std::lower_bound(ranges_m_.begin(), ranges_m_.end(), link.range_m - kSameRange);
  if (sea.section != nullptr || place == ranges_m_.end() || *place > link.range_m + kSameRange)
    return profile_rays(sea, link);
  validate(sea.options);
  const Fan& fan = fan_of(sea, link.source_depth_m);
  const Range& range = fan.ranges[static_cast<std::size_t>(place - ranges_m_.begin())];
  std::vector<Eigenray> paths;
  for (std::size_t b = 1; b < range.places.size(); ++b) {
    const Place &before = range.places[b - 1], &after = range.places[b];
    if (after.before == Before::kNone) continue;
    const double target = before.orientation * link.receiver_depth_m + before.base;
    if (after.before == Before::kAlike) {
      if (range.rays[b - 1].zeta_slope * range.rays[b].zeta_slope < 0) {
        add_fold(range, b, target, sea.options.frequency_hz, paths);
      } else if (lies_between(target, before.zeta, after.zeta)) {
        paths.push_back(between(range, b, target, sea.options.frequency_hz));
      }
      continue;
    }
    const double step = range.rays[b].path.launch_angle_rad - range.rays[b - 1].path.launch_angle_rad;
    const double way = after.zeta - before.zeta;
    const double foreseen = 0.5 * (range.rays[b - 1].zeta_slope + range.rays[b].zeta_slope) * step;
    const bool goes_on = std::abs(way - foreseen) < kGoesOn * std::abs(way);
    const auto serve = [&](std::size_t i, double image) {
      const double reach = (goes_on ? 1 : 0.5) * step * std::abs(range.rays[i].zeta_slope);
      if (lies_between(image, before.zeta, after.zeta) && std::abs(image - range.places[i].zeta) < reach)
        paths.push_back(beside(range, i, image));
    };
    serve(b - 1, target);
    serve(b, after.orientation * link.receiver_depth_m + after.base);
  }
  drop_faint(paths, sea.options);
  finish(paths, std::vector<FoldMember>(paths.size()), sea.options);
  return paths;
}

}  // namespace halocline::acoustics
