// SPDX-License-Identifier: BSD-3-Clause
// Depths at which the rays of a flat sea arrive at one range, ray after ray, for a tenth of the cost of
// tracing them.
//
// Model: that of acoustics/rays/arcs/layered_legs.h in plain ray theory. A ray of Snell's invariant xi
// repeats one cycle, up from the source to a turn or the surface and down to a turn or the bottom. Its range
// to each knot of the profile on the way is summed once for a cycle; whole cycles are left out of the range.
//
// Accuracy: exact for the given knots, to 1e-7 m after 10 km.
//
// The object keeps the sums of the last ray: not shared between threads.
#pragma once

#include <cstddef>
#include <vector>

#include "acoustics/sea/ray_water.h"

namespace halocline::acoustics {

// A ray at the receiver's range.
struct RangeEnd {
  bool arrived = false;
  double depth_m = 0, sine = 0;  // sine of its angle there, positive down
  int surface_bounces = 0, bottom_bounces = 0;
};

class CycleRays {
 public:
  // The source lies within the water, 0..bottom_m; range above 0, m. Refers to nothing afterwards.
  CycleRays(const RayWater& water, double bottom_m, double source_m, double range_m);

  // The ray launched at `theta`, rad, less than pi / 2 from the horizontal, positive down.
  RangeEnd at(double theta);

 private:
  // A layer or a part of one, in the direction away from the source.
  struct CycleLayer {
    double height_m, c1, c2, gradient_per_s;  // (c2 - c1) / height_m
  };
  // The way from the source up or down, with the state at each knot for the present ray.
  struct Side {
    std::vector<CycleLayer> layers;
    std::vector<double> range_m, sine;  // at the start of each layer; `count` of them are reached
    std::size_t count = 0;
    double total_m = 0;
    bool bounces = false;
  };
  void march(Side& side, double xi, double sine) const;
  // Depth below the source's side of the ray `along_m` metres of range from the source, and its sine.
  static double height_at(const Side& side, double xi, double along_m, double& sine);

  Side up_, down_;
  double source_m_, source_mps_, range_m_;
};

}  // namespace halocline::acoustics
