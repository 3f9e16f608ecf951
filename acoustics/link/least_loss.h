// SPDX-License-Identifier: BSD-3-Clause
// Lower bound of the transmission loss over a range, whatever terrain and water lie between the ends. Links
// that cannot matter are recognised by it before anything of them is computed.
//
// The bound is
//   TL(r) >= spreading(r) + min over D of alpha_min(D) l(D, r) - gain,
// alpha_min(D) the least absorption at the centre frequency between the surface and the depth D.
// - Straight path (acoustics/link/link_budget.h): spreading = k 10 log10 r; l = r; D is the depth of the
//   deepest end. Exact except for alpha_min(D).
// - All rays together: the images of a source between lossless walls a distance H apart stand on two vertical
//   lattices of spacing 2 H. The sum of a function with one maximum over a lattice is at most its integral
//   over the spacing plus that maximum, so the powers 1 / (r^2 + z^2) of all images add to at most
//     I(r) <= pi / (H r) + 2 / r^2,  spreading = -10 log10 I.
//   A path down to the depth D has at least the length l = sqrt(r^2 + (2 (D - deepest end))^2).
//   H is kChannelThickness. In deeper water spreading is greater. In shallower water and in ducts it is less,
//   yet the bound holds. Over a bottom that takes kappa sin(angle) nepers a bounce (Weston 1971)
//     I = sqrt(2 pi / (kappa H)) r^(-3/2),
//   which for sand (kappa = 0.5) in 5 m of water is the smaller from 0.6 km on. A duct of thickness h that
//   traps angles up to theta = sqrt(2 g h / c), g the gradient of sound speed, gives
//     I = 2 theta / (h r),
//   the smaller unless g > 0.7 h (m and s: 2 m that change sound speed by 3 m/s).
// - Water known to be at least H0 deep, over a known bottom: each ray also loses at the bottom. Launched at
//   theta it meets the bottom at least r tan(theta) / (2 H0) - 1 times, so with the magnitude R of one
//   reflection
//     I(r) <= 2 / r^2 + 2 / (H0 r) integral over 0..pi/2 of R(theta)^(2 (r tan(theta) / (2 H0) - 1)) dtheta
//             + sum over ducts of the integral of 2 dtheta / (h r);
//   in deeper water spreading is greater. In a duct the ray that has the angle theta at the axis stays within
//   a thickness h: it either misses the bottom, or, where sound is slowest at the bottom, meets it at too low
//   an angle to lose much. The lesser of both bounds counts.
// - gain: the increase by focusing (kFocusingGain, at caustics and convergence zones), and what the caller
//   adds for its own way of summing paths.
// Left out: beams, which the caller adds; bottoms without any loss in water shallower than H, unless the
// depth is known.
//
// With a field of temperature and salinity (Environment::field), alpha_min(D) is the least over all water of
// the field down to D, at any place and time, and only the first bound on the spreading of rays is used,
// which needs no profile.
//
// The bound rises with range. Immutable: calls may overlap between threads. Construction takes a millisecond.
#pragma once

#include <vector>

#include "acoustics/sea/boundary_reflection.h"
#include "acoustics/sea/environment.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "core/units.h"

namespace halocline::acoustics {

inline constexpr double kChannelThickness = 50;  // H, m
inline constexpr Decibels kFocusingGain{3};      // for all rays together, our choice
// Once around the Earth, m; greater ranges are not bounded.
inline constexpr double kMaxBoundedRange = 4e7;

// Known limits of the water at every place: the least and the greatest depth, m, and the bottom, which is
// used when `least_depth_m` is above 0.
struct WaterLimits {
  double least_depth_m = 0, greatest_depth_m = kDeepestWater;  // 0..kDeepestWater, ascending
  FluidBottom bottom = {};
};

// Bound of the transmission loss as a function of range.
class LeastLoss {
 public:
  // Bound for the straight path between ends no deeper than `deepest_end_m`, >= 0.
  static LeastLoss of_straight_path(const Environment& environment, double frequency_hz,
                                    double deepest_end_m);
  // Bound for all rays together. `gain` >= 0 is added to that of focusing.
  static LeastLoss of_rays(const Environment& environment, double frequency_hz, double deepest_end_m,
                           Decibels gain, const WaterLimits& column = {});

  // Bound at `range_m` > 0; below 1 m that of 1 m. It may be negative, down to minus the gain and 8 dB.
  Decibels at(double range_m) const;
  // The range beyond which every link loses more than `loss`; 0..kMaxBoundedRange.
  double range_of(Decibels loss) const;

 private:
  // Paths that descend to one depth: their least absorption, and the vertical detour, twice the distance from
  // the deepest end to that depth.
  struct Depth {
    double absorption_db_per_km, detour_m;
  };
  // Rays at equidistant grazing angles: the tangent of the angle, and the logarithm of the pressure
  // reflection coefficient of the bottom.
  struct Reflection {
    double tangent, log_magnitude;
  };
  LeastLoss() = default;
  // Upper bound of the intensity of all rays, re 1 m, without absorption.
  double greatest_intensity(double range_m) const;

  double power_law_exponent_ = 0;  // 0 for rays
  Decibels gain_{0};
  std::vector<Depth> depths_;
  double least_depth_m_ = 0;  // 0 when unknown
  std::vector<Reflection> reflections_;
  double ducts_ = 0;  // sum over ducts of the integral of 2 dtheta / h, 1/m
};

}  // namespace halocline::acoustics
