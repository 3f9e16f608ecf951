// SPDX-License-Identifier: BSD-3-Clause
// Turns one Snell ray of a flat sea, named by its family and its number of cycles, into an eigenray.
//
// Equations: acoustics/rays/layered_rays.h.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "acoustics/rays/arcs/layered_legs.h"
#include "acoustics/rays/eigenray.h"
#include "acoustics/rays/layered_rays.h"

namespace halocline::acoustics {

// Eigenray family: whether the ray runs the legs U and D, there and back, once more than its n whole cycles.
struct EigenrayFamily {
  bool up, down;
};
inline constexpr std::array<EigenrayFamily, 4> kEigenrayFamilies = {
    {{false, false}, {true, false}, {false, true}, {true, true}}};

// Terms of the range equation b + n X = r, with b the range of the incomplete cycle and X that of a whole
// cycle: divided by xi (q, m^2/s) and differentiated with respect to xi (m, m^2/s).
struct RangeTerms {
  double bq, bm, xq, xm;
};

inline RangeTerms range_terms(const LegSums& s, EigenrayFamily family) {
  const double u = family.up ? 2 : 0, d = family.down ? 2 : 0;
  return {u * s.q[0] + s.q[1] + d * s.q[2], u * s.m[0] + s.m[1] + d * s.m[2], 2 * (s.q[0] + s.q[1] + s.q[2]),
          2 * (s.m[0] + s.m[1] + s.m[2])};
}

// The quantities of a flat sea and a link that are common to all of its rays.
struct LayeredLink {
  LayeredLink(const FlatSea& flat_sea, const RayLink& ray_link);

  // Upper bound of the pressure factor of all bounces: that of one bottom bounce.
  double bottom_factor(const LegSums& sums) const {
    return bottom_magnitude_at_sine(sea.bottom, sums.sine_bottom, bottom_speed_mps);
  }

  const FlatSea& sea;
  double upper_m, lower_m, range_m;
  bool source_is_upper;
  double source_speed_mps, receiver_speed_mps, surface_speed_mps, bottom_speed_mps;
  double log_min_factor;  // ln of RayOptions::min_boundary_factor, -infinity for 0
};

// A ray, by the sine and cosine of its angle at the barrier.
struct LayeredRay {
  EigenrayFamily family;
  int cycles;
  double sine, cosine;
  double fold_slope = 0;  // |dr/dxi| of the path on the shadow side of a caustic; 0: the ray's own
};

// True when Newton's method has converged to the ray. `off` is the remaining error of the range, m, of this
// step, `off_before` that of the step before; delays err by its square. Far away and near grazing, rounding
// may leave a larger error, so an error that no longer shrinks is accepted too.
inline constexpr double kNotYet = 1e300;  // `off_before` of the first step
inline bool is_settled(double off, double off_before) {
  constexpr double kSettled = 1e-6, kNearlySettled = 1e-4;
  return std::abs(off) < kSettled ||
         (std::abs(off) < kNearlySettled && std::abs(off) > 0.5 * std::abs(off_before));
}

// A bracket of angles at the barrier between which d range/d xi changes its sign, with a first guess of the
// zero and the sums at both ends.
struct FoldBracket {
  double low, high, guess;
  const LegSums &at_low, &at_high;
};
// Finds the ray of the single path on the shadow side of a fold caustic (acoustics/math/fold_field.h) formed
// by the rays of `ray`'s family and cycles. Returns false when the link lies on the illuminated side or too
// far in the shadow.
[[nodiscard]] bool find_dark_ray(const LayeredLink& link, const LayeredLegs& legs, const FoldBracket& bracket,
                                 LayeredRay& ray, LegSums& sums);

// The number of a ray's turns and bounces, plus one behind a fold, which tells on which side of a fold it is;
// and its phase beyond that of a ray that turns at each of its bounces.
struct Passed {
  int touched = 0;
  double phase_rad = 0;
};
// Appends the eigenray unless the options exclude it. `sums` are the sums of `ray`.
Passed append_eigenray(const LayeredLink& link, const LayeredLegs& legs, const LayeredRay& ray,
                       const LegSums& sums, std::vector<Eigenray>& paths);

}  // namespace halocline::acoustics
