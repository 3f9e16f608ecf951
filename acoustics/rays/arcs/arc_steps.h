// SPDX-License-Identifier: BSD-3-Clause
// One step of a ray within layered water, and where it meets a bottom profile: what both ray tracers share.
//
// Model: acoustics/rays/arc_tracer.h. A step goes to the next knot of the water or through a turn back to the
// same depth; before that the ray may meet the bottom. Nothing here knows of ray tubes.
//
// Free functions on values: calls may overlap between threads.
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>

#include "acoustics/sea/bottom_profile.h"
#include "acoustics/sea/ray_water.h"

namespace halocline::acoustics {

inline constexpr double kMinSine = 1e-9;    // where 1 / sin is taken
inline constexpr double kMinCosine = 1e-3;  // steeper than 89.94 degrees a ray counts as turned back

// A ray at one point: range and depth, m; sine of its angle, positive down; Snell's xi = cos / c, s/m. Depth,
// sine and c = cos / xi belong together.
struct ArcPoint {
  double r, z, sine, xi, c;
  double per_xi;  // 1 / xi
  std::size_t layer, facet;
  bool on_facet = false;  // just reflected by `facet`
};

// How far along range, m, to depth `z` and `sine` there; `turns`: through a turn; `down`: towards the bottom
// at first.
struct ArcStep {
  double dr, z, sine;
  bool turns, down;
};

// The bottom is met `dr` m further, at `facet`.
struct ArcHit {
  double dr;
  std::size_t facet;
};

inline ArcStep next_step(const RayWater& water, const ArcPoint& s) {
  const double g = water.gradients_per_s()[s.layer];
  const bool down = s.sine > 0 || (s.sine == 0 && g <= 0);
  const std::size_t knot = down ? s.layer + 1 : s.layer;
  const double c = water.speeds_mps()[knot], z = water.depths_m()[knot];
  // Snell: cos = xi c at the knot. To it dr = |dz| xi (c1 + c2) / (s1 + s2); through a turn dr = 2 s1 / (xi
  // |g|) (arc of a circle of radius 1 / (xi |g|)).
  const double cosine = s.xi * c, steep = std::abs(s.sine);
  if (cosine < 1 && (steep > 0 || g != 0)) {
    const double sine = std::sqrt((1 - cosine) * (1 + cosine));
    const double dr = std::abs(z - s.z) * s.xi * (s.c + c) / (steep + sine);
    return {dr, z, down ? sine : -sine, false, down};
  }
  if (g == 0 || steep == 0) return {std::numeric_limits<double>::infinity(), s.z, s.sine, false, down};
  return {2 * steep * s.per_xi / std::abs(g), s.z, -s.sine, true, down};
}

// The change of a ray's angle along its way within its layer, rad/m: an arc of a circle has the same
// throughout.
inline double curvature_of(const RayWater& water, const ArcPoint& at) {
  return -at.xi * water.gradients_per_s()[at.layer];
}

// Whether the bottom is met within `until` m of range, before `step` along an arc of that curvature ends;
// where, if so.
[[nodiscard]] bool find_hit(double curvature, const BottomProfile& profile, const ArcPoint& at,
                            const ArcStep& step, double until, ArcHit& hit);

// What a ray does at a facet. The direction that reflects is the facet's own or, where it is bent and that
// throws no ray into it, the bent one; `bend_per_m` is its change along the facet.
struct FacetBounce {
  double sine, cosine;          // of the grazing angle to what reflects
  double out_sine, out_cosine;  // of the angle in which the ray leaves
  double facet_sine;            // of the grazing angle to the facet itself
  double bend_per_m;
};
FacetBounce bounce_off(const Facet& facet, const ArcPoint& at);

}  // namespace halocline::acoustics
