// SPDX-License-Identifier: BSD-3-Clause
// The rays of one bearing, traced once for receivers at many ranges and depths: for maps, whose links need
// not be exact one by one.
//
// Method: one even fan, ten times as close as that a search begins with, is traced past all ranges. The paths
// of a receiver are interpolated between the two rays of one history on both sides of each of its images in
// unfolded depth zeta (acoustics/rays/arc_tracer.h): launch angle and delay by cubics of zeta with the slopes
// of both rays,
//   d theta / d zeta = 1 / (d zeta / d theta),  d delay / d zeta = +-sin / c,
// the spreading by the slope of the former, 1 / A^2 ~ |d zeta / d theta|, at least a fifth and at most five
// times that between the two rays; all else is linear. Where two neighbours differ in their history, each
// serves the images within one step of it on the side of the other.
//
// Left out: paths that lie between rays further apart, windows of diffuse sound, waves beyond folds. Water
// that changes along the link is not known to it: such links are searched one by one, as are those at ranges
// that it was not made for. Error beside profile_rays(): tests/acoustics/rays/bearings/bearing_rays_test.cc.
#pragma once

#include <cstddef>
#include <vector>

#include "acoustics/math/fold_field.h"
#include "acoustics/rays/arc_tracer.h"
#include "acoustics/rays/arrivals.h"
#include "acoustics/rays/traced_ray.h"

namespace halocline::acoustics {

class BearingRays : public SharedRays {
 public:
  // Horizontal ranges of the receivers, m, rising, above 0.
  explicit BearingRays(std::vector<double> ranges_m);

  std::vector<Arrival> at(const ProfiledSea& sea, const RayLink& link) override;

 private:
  enum class Before {
    kNone,
    kAlike,
    kOther
  };  // the ray of the launch angle before: lost, of the same history, of another
  // Of a ray at one range, what tells whether it passes an image: zeta = orientation z + base.
  struct Place {
    double zeta, orientation, base;
    Before before;
  };
  struct Ray {
    double zeta_slope;  // d zeta / d theta
    double slowness;    // d delay / d zeta, s/m
    Arrival path;       // its amplitude that of a tube of slope 1
  };
  // Of one launch angle, at the ranges that it reaches.
  struct Traced {
    double theta;
    std::vector<Place> places;
    std::vector<Ray> rays;
  };
  // All rays that reach it, by launch angle.
  struct Range {
    std::vector<Place> places;
    std::vector<Ray> rays;
  };
  struct Fan {
    RayOptions options;
    std::vector<Range> ranges;
  };

  const Fan& fan_of(const ProfiledSea& sea, double source_depth_m);
  Traced traced(const ArcTracer& tracer, double theta) const;
  // Appends to `fan` rays between its last and `next`, and that.
  void halve(const ArcTracer& tracer, std::vector<Traced>& fan, Traced next, int halvings) const;
  static Fold fold_between(const Ray& one, const Ray& other);
  static Arrival mean_of(const Ray& one, const Ray& other, double share);
  static Arrival between(const Range& range, std::size_t b, double target, double frequency_hz);
  static void add_fold(const Range& range, std::size_t b, double target, double frequency_hz,
                       std::vector<Arrival>& paths);
  static Arrival beside(const Range& range, std::size_t i, double target);

  std::vector<double> ranges_m_;
  std::vector<Fan> fans_;  // one for each options
};

}  // namespace halocline::acoustics
