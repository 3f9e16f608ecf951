// SPDX-License-Identifier: BSD-3-Clause
// The least loss of level over a range, whatever lies between the ends: a bound, by which links that cannot
// matter are recognised before anything of them is computed.
//
// TL(r) >= spreading(r) + min over D of alpha_min(D) l(D, r) - gain
// - Straight path (acoustics/link/link_budget.h): spreading k 10 log r; l = r; D the deepest end. Exact but
//   for alpha_min(D), the least absorption at the centre frequency between the surface and the depth D.
// - All rays together: the images of a source between lossless walls a distance H apart stand on two vertical
//   lattices of spacing 2 H. The sum of a function with one maximum over a lattice is at most its integral
//   over the spacing and that maximum, so the powers 1 / (r^2 + z^2) of all images add to at most
//     I(r) <= pi / (H r) + 2 / r^2,  spreading = -10 log I.
//   A path down to the depth D is at least l = sqrt(r^2 + (2 (D - deepest end))^2) long.
//   H is kChannelThickness. Deeper water spreads more. Shallower water and ducts spread less and are bounded
//   all the same: over a bottom that takes kappa sin(angle) nepers a bounce, I = sqrt(2 pi / (kappa H))
//   r^(-3/2) (Weston 1971), which for sand (kappa = 0.5) in 5 m of water is the smaller from 0.6 km on; a
//   duct of thickness h that holds angles up to theta = sqrt(2 g h / c), g the gradient of sound speed, gives
//   2 theta / (h r), the smaller unless g > 0.7 h (m and s: 2 m that change sound speed by 3 m/s).
// - Where the water is known to be H0 deep or more, and what its bottom takes, each ray loses at the bottom
//   as well: launched at theta it meets it r tan(theta) / (2 H0) - 1 times or more, so with the magnitude R
//   of one reflection
//     I(r) <= 2 / r^2 + 2 / (H0 r) integral over 0..pi/2 of R(theta)^(2 (r tan(theta) / (2 H0) - 1)) dtheta
//             + sum over ducts of the integral of 2 dtheta / (h r);
//   deeper water spreads more. In a duct the ray of theta at its axis stays within a thickness h: off the
//   bottom, or above it where sound is slowest there, where it meets it at too low an angle to lose much. The
//   lesser of both counts.
// - gain: what focusing adds (kFocusingGain at caustics and convergence zones), and what the caller's way of
//   adding paths may.
// Left out: beams, which the caller adds; hard bottoms without any loss in water of less than H, unless it is
// known.
//
// In a field of temperature and salinity (Environment::field) alpha_min(D) is the least of all water of the
// field down to D, at any place and time, and of rays the first bound on spreading alone holds, which asks
// for no profile.
//
// It rises with range. Immutable: calls may overlap between threads. Making one costs a millisecond.
#pragma once

#include <vector>

#include "acoustics/sea/boundary_reflection.h"
#include "acoustics/sea/environment.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "core/units.h"

namespace halocline::acoustics {

inline constexpr double kChannelThickness = 50;  // H, m
inline constexpr Decibels kFocusingGain{3};      // of all rays together, our choice
// m, once around the Earth; what reaches further is not bounded.
inline constexpr double kGreatestBoundedRange = 4e7;

// What is known of the water wherever sound goes, m: no shallower and no deeper; its bottom, where the former
// is above 0.
struct WaterColumn {
  double least_depth_m = 0, greatest_depth_m = kDeepestWater;  // 0..kDeepestWater, rising
  FluidBottom bottom = {};
};

class LeastLoss {
 public:
  // Of the straight path between ends no deeper than `deepest_end_m`, >= 0.
  static LeastLoss of_straight_path(const Environment& environment, double frequency_hz,
                                    double deepest_end_m);
  // Of all rays together. `gain` beside that of focusing, >= 0.
  static LeastLoss of_rays(const Environment& environment, double frequency_hz, double deepest_end_m,
                           Decibels gain, const WaterColumn& column = {});

  // At `range_m` > 0; below 1 m that of 1 m. May be negative, down to minus the gain and 8 dB.
  Decibels at(double range_m) const;
  // All links that are longer lose more than `loss`; 0..kGreatestBoundedRange.
  double range_of(Decibels loss) const;

 private:
  // Paths that go down to a depth: what they absorb at least, and twice the way down to there from the
  // deepest end.
  struct Depth {
    double absorption_db_per_km, detour_m;
  };
  // Of rays at even angles: how steep they are, and the logarithm of what a reflection leaves of the
  // pressure.
  struct Reflection {
    double tangent, log_magnitude;
  };
  LeastLoss() = default;
  // Of all rays, re 1 m, without absorption.
  double greatest_intensity(double range_m) const;

  double power_law_exponent_ = 0;  // 0: rays
  Decibels gain_{0};
  std::vector<Depth> depths_;
  double least_depth_m_ = 0;  // 0: not known
  std::vector<Reflection> reflections_;
  double ducts_ = 0;  // sum over ducts of the integral of 2 dtheta / h, 1/m
};

}  // namespace halocline::acoustics
