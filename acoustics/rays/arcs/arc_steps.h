// SPDX-License-Identifier: BSD-3-Clause
// The step of a ray through one layer and its intersection with a bottom profile: geometry common to both ray
// tracers.
//
// Model: acoustics/rays/arc_tracer.h. A step ends at the next knot of the sound speed profile or, when the
// ray turns within the layer, back at the depth at which the step began. Before its end the ray may meet the
// bottom. Ray tubes are not treated here.
//
// The functions are free and act on values, so threads may call them at the same time.
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>

#include "acoustics/sea/bottom_profile.h"
#include "acoustics/sea/ray_water.h"

namespace halocline::acoustics {

inline constexpr double kMinSine = 1e-9;    // lower bound of a grazing angle's sine, for divisions by it
inline constexpr double kMinCosine = 1e-3;  // a steeper ray (beyond 89.94 degrees) counts as turned back

// A point on a ray: range `r` and depth `z`, m; the sine of the ray's angle, positive down; Snell's invariant
// xi = cos(angle) / c, s/m; the sound speed c = cos(angle) / xi, m/s. Depth, sine and speed have to agree
// with one another.
struct ArcPoint {
  double r, z, sine, xi, c;
  double per_xi;  // 1 / xi
  std::size_t layer, facet;
  bool on_facet = false;  // the ray was just reflected by `facet`
};

// One step of a ray: its length in range `dr`, m, and the depth `z`, m, and the sine at its end. `turns`: the
// step passes a turning point; `down`: the ray first descends.
struct ArcStep {
  double dr, z, sine;
  bool turns, down;
};

// An intersection with the bottom, `dr` metres of range from the start of the step, on the facet of index
// `facet`.
struct ArcHit {
  double dr;
  std::size_t facet;
};

// The step from `s` to the next knot, or through a turning point back to the depth of `s`. It is infinite in
// range when the ray is horizontal in a layer of constant speed.
inline ArcStep next_step(const RayWater& water, const ArcPoint& s) {
  const double g = water.gradients_per_s()[s.layer];
  const bool down = s.sine > 0 || (s.sine == 0 && g <= 0);
  const std::size_t knot = down ? s.layer + 1 : s.layer;
  const double c = water.speeds_mps()[knot], z = water.depths_m()[knot];
  // Snell's law gives the cosine at the knot, cos = xi c. With speeds c1, c2 and sines s1, s2 at the ends of
  // the step, the range to the knot is
  //   dr = |dz| xi (c1 + c2) / (s1 + s2),
  // and through a turning point, on a circular arc of radius 1 / (xi |g|),
  //   dr = 2 s1 / (xi |g|).
  const double cosine = s.xi * c, steep = std::abs(s.sine);
  if (cosine < 1 && (steep > 0 || g != 0)) {
    const double sine = std::sqrt((1 - cosine) * (1 + cosine));
    const double dr = std::abs(z - s.z) * s.xi * (s.c + c) / (steep + sine);
    return {dr, z, down ? sine : -sine, false, down};
  }
  if (g == 0 || steep == 0) return {std::numeric_limits<double>::infinity(), s.z, s.sine, false, down};
  return {2 * steep * s.per_xi / std::abs(g), s.z, -s.sine, true, down};
}

// The curvature of the ray within its layer, d(angle) / d(arc length) = -xi g, rad/m. It is constant within a
// layer, where rays are circular arcs.
inline double curvature_of(const RayWater& water, const ArcPoint& at) {
  return -at.xi * water.gradients_per_s()[at.layer];
}

// Returns true when the ray meets the bottom within `until` metres of range, before the end of `step`, along
// an arc of the given curvature; `hit` is then the point of intersection.
[[nodiscard]] bool find_hit(double curvature, const BottomProfile& profile, const ArcPoint& at,
                            const ArcStep& step, double until, ArcHit& hit);

// The reflection of a ray at a facet. The reflecting slope is the facet's own or, on a bent facet, the bent
// slope, unless a ray reflected by the bent slope would enter the facet.
struct FacetBounce {
  double sine, cosine;          // grazing angle to the reflecting slope
  double out_sine, out_cosine;  // angle at which the ray leaves, positive down
  double facet_sine;            // sine of the grazing angle to the facet itself
  double bend_per_m;            // change of the reflecting slope's angle along the facet; 0: not bent
};
FacetBounce bounce_off(const Facet& facet, const ArcPoint& at);

}  // namespace halocline::acoustics
