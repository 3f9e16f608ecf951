// SPDX-License-Identifier: BSD-3-Clause
// Turns one Snell ray of a flat sea, named by family and number of cycles, into an arrival.
//
// Equations: acoustics/rays/layered_rays.h.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "acoustics/rays/arcs/layered_legs.h"
#include "acoustics/rays/arrivals.h"
#include "acoustics/rays/layered_rays.h"

namespace halocline::acoustics {

// A family is whether the ray runs U and D once more than its n whole cycles.
struct Family {
  bool up, down;
};
inline constexpr std::array<Family, 4> kFamilies = {
    {{false, false}, {true, false}, {false, true}, {true, true}}};

// b and X of the equation b + n X = r in units of xi (q) and their derivatives (m).
struct RangeTerms {
  double bq, bm, xq, xm;
};

inline RangeTerms range_terms(const LegSums& s, Family family) {
  const double u = family.up ? 2 : 0, d = family.down ? 2 : 0;
  return {u * s.q[0] + s.q[1] + d * s.q[2], u * s.m[0] + s.m[1] + d * s.m[2], 2 * (s.q[0] + s.q[1] + s.q[2]),
          2 * (s.m[0] + s.m[1] + s.m[2])};
}

// What of a flat sea and a link stays the same for all of its rays.
struct LayeredLink {
  LayeredLink(const FlatSea& flat_sea, const RayLink& ray_link);

  // Factor that all bounces leave of the pressure: the bottom's alone, an upper bound.
  double bottom_factor(const LegSums& sums) const {
    return bottom_magnitude_at_sine(sea.bottom, sums.sine_bottom, bottom_speed_mps);
  }

  const FlatSea& sea;
  double upper_m, lower_m, range_m;
  bool source_is_upper;
  double source_speed_mps, receiver_speed_mps, surface_speed_mps, bottom_speed_mps;
  double log_min_factor;  // ln of RayOptions::min_boundary_factor, -infinity for 0
};

// A ray: where it is in the legs, by sine and cosine of the angle at the barrier.
struct LayeredRay {
  Family family;
  int cycles;
  double sine, cosine;
  double fold_slope = 0;  // |dr/dxi| in place of its own, of the path on the dark side of a fold; 0: its own
};

// Whether Newton's method has come to its ray: `off` what is missing of the range, m, before and now. Delays
// err by its square. Far away and near grazing, rounding may leave more: then what no longer shrinks is
// enough.
inline constexpr double kNotYet = 1e300;
inline bool is_settled(double off, double off_before) {
  constexpr double kSettled = 1e-6, kNearlySettled = 1e-4;
  return std::abs(off) < kSettled ||
         (std::abs(off) < kNearlySettled && std::abs(off) > 0.5 * std::abs(off_before));
}

// Angles at the barrier between which d range/d xi changes its sign, and one about where; sums of the first
// two.
struct FoldBracket {
  double low, high, guess;
  const LegSums &at_low, &at_high;
};
// Where the link lies on the dark side of the fold of the rays of so many cycles, and not too far: the ray of
// the path that it has there (acoustics/math/fold_field.h).
[[nodiscard]] bool find_dark_ray(const LayeredLink& link, const LayeredLegs& legs, const FoldBracket& bracket,
                                 LayeredRay& ray, LegSums& sums);

// Which side of a fold a ray is on, and the phase that it has beside a ray that turns in place of its
// bounces.
struct Passed {
  int touched = 0;
  double phase_rad = 0;
};
// Appends the arrival unless the options exclude it; `sums` are those of the ray.
Passed append_arrival(const LayeredLink& link, const LayeredLegs& legs, const LayeredRay& ray,
                      const LegSums& sums, std::vector<Arrival>& paths);

}  // namespace halocline::acoustics
