// SPDX-License-Identifier: BSD-3-Clause
// Ranges of a ray, and their derivatives, through all layers of a profile at once for one Snell parameter xi.
//
// Model: acoustics/math/arc_math.h. With the sines s1, s2 of the ray's angle at the knots of a layer,
//   dr        = K xi / (s1 + s2),  K = h (c1 + c2),
//   d(dr)/dxi = K / ((s1 + s2) s1 s2).
// A ray keeps its xi from one bottom bounce to the next, so one column serves all layers in between. The
// layers are independent of one another, which lets compilers vectorise the loops.
//
// Between two bottom bounces two numbers describe a ray tube. E = d xi/d theta is constant. X, the offset in
// range at a fixed depth of the neighbouring ray, per radian of launch angle, grows by E d(dr)/dxi in each
// layer. Both follow from q and p of acoustics/rays/arc_tracer.h:
//   q = -sin X,  E = -(sin p + g xi^2 q).
//
// Thread rule: not shared between threads, because `set` overwrites the values that the accessors read.
#pragma once

#include <cstddef>
#include <vector>

#include "acoustics/sea/ray_water.h"

namespace halocline::acoustics {

class RayColumn {
 public:
  // Holds the layers down to the one that contains `deepest_m`. Excursions begin at the deepest knot that
  // does not lie below `shallowest_m`.
  RayColumn(const RayWater& water, double shallowest_m, double deepest_m);

  // Computes all layers for rays of Snell's invariant `xi`, s/m.
  void set(double xi);
  double xi() const { return xi_; }

  std::size_t last_knot() const { return sine_.size() - 1; }
  // Sine of the ray's angle at a knot, 0..1; 0 when the ray turns before it reaches the knot.
  double sine_at(std::size_t knot) const { return sine_[knot]; }
  // Range through a layer, m, and its derivative d range/d xi. Defined only where the sine is above 0 at both
  // knots of the layer.
  double range_through(std::size_t layer) const { return range_[layer]; }
  double range_slope_through(std::size_t layer) const { return slope_[layer]; }

  // The part of the ray from a knot up to the surface, or to an upper turning point, and back down to the
  // knot. The knot is one above which the bottom rises nowhere.
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
  std::vector<double> speed_, weight_;  // sound speed at each knot, m/s; K of each layer
  std::vector<double> sine_, range_, slope_;
  Excursion excursion_;
};

}  // namespace halocline::acoustics
