// One step of a ray within layered water, and where it meets a bottom profile: what both ray tracers share.
//
// Model: acoustics/rays/arc_tracer.h. A step goes to the next knot of the water or through a turn back to the same
// depth; before that the ray may meet the bottom. Nothing here knows of ray tubes.
//
// Free functions on values: calls may overlap between threads.
#pragma once

#include <cstddef>

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

ArcStep next_step(const RayWater& water, const ArcPoint& at);

// Whether the bottom is met within `until` m of range, before `step` ends; where, if so.
[[nodiscard]] bool find_hit(const RayWater& water, const BottomProfile& profile, const ArcPoint& at,
                            const ArcStep& step, double until, ArcHit& hit);

// What a ray does at a facet. The direction that reflects is the facet's own or, where it is bent and that throws no
// ray into it, the bent one; `bend_per_m` is its change along the facet.
struct FacetBounce {
  double sine, cosine;          // of the grazing angle to what reflects
  double out_sine, out_cosine;  // of the angle in which the ray leaves
  double facet_sine;            // of the grazing angle to the facet itself
  double bend_per_m;
};
FacetBounce bounce_off(const Facet& facet, const ArcPoint& at);

}  // namespace halocline::acoustics
