// SPDX-License-Identifier: BSD-3-Clause
// All layers of a water at one Snell parameter at once: how far a ray goes through each, and how that
// changes.
//
// Model: acoustics/math/arc_math.h, dr = K xi / (s1 + s2), K = h (c1 + c2), s the sines of the ray's angle at
// the knots, and d(dr)/dxi = K / ((s1 + s2) s1 s2). A ray keeps its xi from one bounce at the bottom to the
// next, so one column serves all layers between them; each is independent of the others, which compilers turn
// into vector instructions. Within such a leg a ray tube is two numbers that are as simple: E = d xi/d theta
// stays, and X, by how far the neighbouring ray of launch angle 1 rad more is off in range at the same depth,
// grows by E d(dr)/dxi a layer. Both follow from q and p of acoustics/rays/arc_tracer.h: q = -sin X, E =
// -(sin p + g xi^2 q).
//
// Not shared between threads: `set` overwrites what is read.
#pragma once

#include <cstddef>
#include <vector>

#include "acoustics/sea/ray_water.h"

namespace halocline::acoustics {

class RayColumn {
 public:
  // Layers down to the one that holds `deepest_m`; excursions begin at the deepest knot not below
  // `shallowest_m`.
  RayColumn(const RayWater& water, double shallowest_m, double deepest_m);

  // To the rays of xi, s/m.
  void set(double xi);
  double xi() const { return xi_; }

  std::size_t last_knot() const { return sine_.size() - 1; }
  // Of the ray's angle at a knot, 0..1; 0: it turns back before.
  double sine_at(std::size_t knot) const { return sine_[knot]; }
  // Through a layer at both of whose knots the sine is above 0: range, m, and d range/d xi.
  double range_through(std::size_t layer) const { return range_[layer]; }
  double range_slope_through(std::size_t layer) const { return slope_[layer]; }

  // From a knot up to the surface, or to where the ray turns, and back down; the bottom is nowhere above that
  // knot.
  struct Excursion {
    double range_m = 0, range_slope = 0;
    bool turns = false;
  };
  std::size_t excursion_knot() const { return excursion_knot_; }
  const Excursion& excursion() const { return excursion_; }

 private:
  void sum_excursion();

  const RayWater& water_;
  std::size_t excursion_knot_;
  double xi_ = -1;
  std::vector<double> speed_, weight_;  // K of each layer
  std::vector<double> sine_, range_, slope_;
  Excursion excursion_;
};

}  // namespace halocline::acoustics
