// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/rays/layered_eigenray.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "acoustics/math/arc_math.h"
#include "acoustics/math/fold_field.h"
#include "acoustics/sea/boundary_reflection.h"
#include "core/check.h"
#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

using std::numbers::pi;

// Distance that ends are kept off the boundaries, so that a ray that meets a boundary right at the receiver
// has a direction before and after it. It changes delays by at most 1e-9 s.
constexpr double kOffBoundary = 1e-6;  // m

// Spacing, relative to a bracket, of the rays that give the curvature of a fold.
constexpr double kFoldStep = 1e-6;
constexpr double kFoldTolerance = 1e-2;  // m: error of the range
constexpr int kMaxFoldSteps = 30;

// Lower bound of |dr/dxi|, m^2/s: a ray on a caustic, to rounding.
constexpr double kMinRangeSlope = 1;

// Counts of a ray's bounces and of its turns in the water.
struct Bounces {
  int surface, bottom, upper_turns, lower_turns;
};

Bounces bounces_of(const LayeredLegs& legs, const LayeredRay& ray) {
  const int above = ray.cycles + (ray.family.up ? 1 : 0), below = ray.cycles + (ray.family.down ? 1 : 0);
  return {legs.meets_surface() ? above : 0, legs.meets_bottom() ? below : 0, legs.meets_surface() ? 0 : above,
          legs.meets_bottom() ? 0 : below};
}

// Corrections to the touches of a ray at the two boundaries.
struct Touches {
  BoundaryTouch top, bottom;
};

// Number of caustics that a ray has touched. A ray of m turns has touched m - 1, and one more when dr/dxi is
// positive; the result is -1 where reflection at grazing acts like a turn.
int caustics_of(const Bounces& bounces, double range_slope) {
  const int turns = bounces.upper_turns + bounces.lower_turns;
  if (turns + bounces.surface + bounces.bottom == 0) return 0;
  return turns - 1 + (range_slope > 0 ? 1 : 0);
}

// Signed angle, positive down, rad, of a ray whose sine has the magnitude `sine` >= 0.
double angle(bool down, double sine, double speed, double xi) {
  return (down ? 1 : -1) * angle_of(sine, xi * speed);
}

void set_directions(const LayeredLink& link, const LayeredLegs& legs, const LayeredRay& ray, double xi,
                    Eigenray& path) {
  // A ray from the upper end leaves downwards unless it begins with U; a ray from the lower end leaves
  // downwards only when it begins with D.
  const bool leaves_down = link.source_is_upper ? !ray.family.up : ray.family.down;
  const bool comes_down = link.source_is_upper ? !ray.family.down : ray.family.up;
  path.launch_angle_rad =
      angle(leaves_down, legs.sine_at(link.source_speed_mps, ray.sine), link.source_speed_mps, xi);
  path.arrival_angle_rad =
      angle(comes_down, legs.sine_at(link.receiver_speed_mps, ray.sine), link.receiver_speed_mps, xi);
  path.launch_slowness_spm = path.range_slowness_spm = xi;
  path.identity.launched_up = !leaves_down;
}

// Loss of one touch of the surface, dB.
double surface_loss_of(const LayeredLink& link, const LegSums& sums, const BoundaryTouch& touch,
                       bool reflects) {
  const RaySurface& surface = link.sea.surface;
  const double frequency = link.sea.options.frequency_hz;
  const bool is_open = !surface.ice.covers();
  if (surface.model == SurfaceModel::kFlat && is_open) return 0;
  if (touch.inverse_sine > 0 && surface.model == SurfaceModel::kAplBubbles && is_open)
    return SurfaceLoss(surface, frequency).db_at_sine(1) * touch.inverse_sine;
  if (!reflects) return 0;
  const double grazing = elementary::atan2(sums.sine_top, sums.xi * link.surface_speed_mps);
  const double factor = surface_magnitude(surface, grazing, frequency);
  return factor < 1 ? -20 * elementary::log10(factor) : 0;
}

// Sets losses, phase and the boundary part of the amplitude. Returns false when the bounces leave less than
// RayOptions::min_boundary_factor.
bool set_boundaries(const LayeredLink& link, const LegSums& sums, const Bounces& bounces,
                    const Touches& touches, Eigenray& path) {
  const RayOptions& options = link.sea.options;
  double factor = 1, phase = pi * (bounces.surface % 2);
  if (bounces.bottom > 0) {
    const Reflection one =
        bottom_reflection_at_sine(link.sea.bottom, sums.sine_bottom, link.bottom_speed_mps);
    factor *= elementary::pow(one.magnitude, bounces.bottom);
    phase += one.phase_rad * bounces.bottom;
    path.bottom_loss_db = bounces.bottom * one.loss_db();
  }
  const int touched = bounces.surface + bounces.upper_turns;
  path.surface_loss_db =
      touched > 0 ? touched * surface_loss_of(link, sums, touches.top, bounces.surface > 0) : 0;
  if (path.surface_loss_db > 0) factor *= elementary::exp10(-path.surface_loss_db / 20);
  phase += 2 * touched * touches.top.phase_rad +
           2 * (bounces.bottom + bounces.lower_turns) * touches.bottom.phase_rad;
  path.amplitude = factor;
  path.phase_rad = phase;
  return factor >= options.min_boundary_factor;
}

void set_spreading(const LayeredLink& link, const LayeredLegs& legs, const LayeredRay& ray,
                   const LegSums& sums, const Bounces& bounces, Eigenray& path) {
  // Conservation of energy in the ray tube (Jensen and others 2011, section 3.3):
  //   A^2 = c_s c_r / ((r / xi) |dr/dxi| sin_s sin_r),  with dr/dtheta = dr/dxi dxi/dtheta
  // Each caustic shifts the phase by pi / 2.
  const RangeTerms terms = range_terms(sums, ray.family);
  const double q = terms.bq + ray.cycles * terms.xq, m = terms.bm + ray.cycles * terms.xm;
  const double sines =
      legs.sine_at(link.source_speed_mps, ray.sine) * legs.sine_at(link.receiver_speed_mps, ray.sine);
  const bool is_dark = ray.fold_slope > 0;
  const double tube = q * (is_dark ? ray.fold_slope : std::max(std::abs(m), kMinRangeSlope)) * sines;
  path.amplitude *= std::sqrt(link.source_speed_mps * link.receiver_speed_mps / tube);
  const int caustics = caustics_of(bounces, is_dark ? 0 : m);
  path.caustics = std::max(caustics, 0);
  // On a fold the phase is half way between its values before and after the caustic.
  path.phase_rad = positive_angle(path.phase_rad + (caustics + (is_dark ? 0.5 : 0)) * pi / 2);
}

void set_lengths(const LayeredLink& link, const LayeredLegs& legs, const LayeredRay& ray, double xi,
                 Eigenray& path) {
  const LegDetails one_way = legs.details(ray.sine, ray.cosine);
  const std::array<double, 3> times = {2.0 * (ray.cycles + (ray.family.up ? 1 : 0)), 2.0 * ray.cycles + 1,
                                       2.0 * (ray.cycles + (ray.family.down ? 1 : 0))};
  // tau = xi r + sum over the legs of (tau - xi r).
  path.delay_s = xi * link.range_m;
  for (std::size_t i = 0; i < times.size(); ++i) {
    path.delay_s += times[i] * one_way.intercept_s[i];
    path.path_length_m += times[i] * one_way.length_m[i];
    path.absorption_db += times[i] * one_way.absorption_db[i];
  }
}

}  // namespace

LayeredLink::LayeredLink(const FlatSea& flat_sea, const RayLink& link)
    : sea(flat_sea), range_m(link.range_m) {
  require_in_range(sea.bottom_depth_m, 0.1, kDeepestWater, "depth of the bottom", "m");
  require_in_range(link.source_depth_m, 0, sea.bottom_depth_m, "depth of the source", "m");
  require_in_range(link.receiver_depth_m, 0, sea.bottom_depth_m, "depth of the receiver", "m");
  require_in_range(link.range_m, 0, 1e7, "range", "m");
  const auto inside = [this](double z) {
    return std::clamp(z, kOffBoundary, sea.bottom_depth_m - kOffBoundary);
  };
  const double source = inside(link.source_depth_m);
  double receiver = inside(link.receiver_depth_m);
  // Depths that differ by less count as equal: a direct ray in a layer of constant speed is horizontal to
  // rounding.
  constexpr double kSameDepth = 1e-5;  // m
  if (std::abs(source - receiver) < kSameDepth) receiver = source;
  source_is_upper = source <= receiver;
  upper_m = std::min(source, receiver);
  lower_m = std::max(source, receiver);
  range_m = std::max(link.range_m, 1e-6);
  source_speed_mps = sea.water.speed_at(source);
  receiver_speed_mps = sea.water.speed_at(receiver);
  surface_speed_mps = sea.water.speed_at(0);
  bottom_speed_mps = sea.water.speed_at(sea.bottom_depth_m);
  log_min_factor = sea.options.min_boundary_factor > 0 ? elementary::log(sea.options.min_boundary_factor)
                                                       : -std::numeric_limits<double>::infinity();
}

bool find_dark_ray(const LayeredLink& link, const LayeredLegs& legs, const FoldBracket& bracket,
                   LayeredRay& ray, LegSums& sums) {
  const auto range_slope = [&ray](const LegSums& at) {
    const RangeTerms t = range_terms(at, ray.family);
    return t.bm + ray.cycles * t.xm;
  };
  const auto slope_at = [&](double theta) {
    ray.sine = elementary::sin(theta);
    ray.cosine = elementary::cos(theta);
    sums = legs.sums(ray.sine, ray.cosine);
    return range_slope(sums);
  };
  double low = bracket.low, high = bracket.high, theta = bracket.guess;
  double at_low = range_slope(bracket.at_low), at_high = range_slope(bracket.at_high);
  if (at_low * at_high > 0) {  // f turned near an end: the fold may lie beyond it
    const double wider = 0.5 * (high - low);
    low = std::max(low - wider, 0.5 * low);
    high += wider;
    at_low = slope_at(low);
    at_high = slope_at(high);
  }
  if (!(at_low * at_high < 0)) return false;
  // False position after Anderson and Bjoerck (1973): the value at an end that stays is reduced at each step.
  const double xi_per_angle = std::abs(bracket.at_high.xi - bracket.at_low.xi) / (bracket.high - bracket.low);
  for (int i = 0; i < kMaxFoldSteps; ++i) {
    const double slope = slope_at(theta);
    if (std::abs(slope) * (high - low) * xi_per_angle < kFoldTolerance) break;
    const bool beside_low = slope * at_low > 0;
    double &replaced = beside_low ? at_low : at_high, &kept = beside_low ? at_high : at_low;
    const double scale = 1 - slope / replaced;
    kept *= scale > 0 ? scale : 0.5;
    replaced = slope;
    (beside_low ? low : high) = theta;
    theta = low + std::clamp(at_low / (at_low - at_high), 1e-3, 1 - 1e-3) * (high - low);
  }
  const double step = kFoldStep * (bracket.high - bracket.low), frequency = link.sea.options.frequency_hz;
  const double before = slope_at(theta - step), xi_before = sums.xi;
  const double after = slope_at(theta + step), xi_after = sums.xi;
  slope_at(theta);
  const RangeTerms t = range_terms(sums, ray.family);
  const double beyond = link.range_m - sums.xi * (t.bq + ray.cycles * t.xq);
  // The fold in the coordinate u = range, with the slowness p = xi and rays named by xi, so that dp = 1.
  const Fold fold{(after - before) / (xi_after - xi_before), 1};
  const double x = beyond / std::copysign(fold.length_m(frequency), fold.curvature);
  if (!(x <= 0 && x > kDarkFold)) return false;
  ray.fold_slope = fold.tube_slope(x, frequency);
  return true;
}

Passed append_eigenray(const LayeredLink& link, const LayeredLegs& legs, const LayeredRay& ray,
                       const LegSums& sums, std::vector<Eigenray>& paths) {
  const Bounces bounces = bounces_of(legs, ray);
  const RayOptions& options = link.sea.options;
  const double top = sums.sine_top * sums.sine_top, base = sums.sine_bottom * sums.sine_bottom;
  const double scattered = options.scattering.nepers(bounces.surface * top, bounces.bottom * base);
  if (bounces.surface + bounces.bottom > options.max_bounces ||
      options.scattering.leaves_none(bounces.surface + bounces.bottom, scattered))
    return {};
  const Touches touches{legs.touch(Leg::kUp, ray.sine), legs.touch(Leg::kDown, ray.sine)};
  Eigenray path;
  if (!set_boundaries(link, sums, bounces, touches, path)) return {};
  set_spreading(link, legs, ray, sums, bounces, path);
  set_directions(link, legs, ray, sums.xi, path);
  set_lengths(link, legs, ray, sums.xi, path);
  path.surface_bounces = path.identity.surface_bounces = bounces.surface;
  path.surface_sine_squares = bounces.surface * top;
  path.bottom_sine_squares = bounces.bottom * base;
  path.bottom_bounces = path.identity.bottom_bounces = bounces.bottom;
  path.identity.upper_turns = bounces.upper_turns;
  path.identity.lower_turns = bounces.lower_turns;
  paths.push_back(path);
  const RangeTerms terms = range_terms(sums, ray.family);
  const int above = bounces.surface + bounces.upper_turns, below = bounces.bottom + bounces.lower_turns;
  return {above + below + (terms.bm + ray.cycles * terms.xm > 0 ? 1 : 0),
          2 * (above * touches.top.turned_rad + below * touches.bottom.turned_rad)};
}

}  // namespace halocline::acoustics
