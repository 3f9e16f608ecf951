// SPDX-License-Identifier: BSD-3-Clause
// The eigenrays along one bearing, from rays traced once for receivers at many ranges and depths. Meant for
// maps, whose links need not be exact individually.
//
// Method. One even fan, ten times as dense as the first fan of a search, is traced past all ranges. A
// receiver's paths are interpolated between two neighbouring rays of the same bounce sequence that lie to
// both sides of one of its images in unfolded depth zeta (acoustics/rays/arc_tracer.h). Launch angle and
// delay are cubics of zeta with the slopes of both rays,
//   d theta / d zeta = 1 / (d zeta / d theta),  d delay / d zeta = +-sin / c.
// The spreading follows from the slope of the former, 1 / A^2   |d zeta / d theta|, limited to between a
// fifth and five times the slope between the two rays; all else is linear. Where two neighbours differ in
// their bounce sequence, each yields the paths of the images on the other's side within one step of the fan.
//
// Neglected: paths between rays further apart, diffuse windows, wave fields beyond folds. Links through water
// that changes along them are searched one by one, as are links at other ranges than those given. Error
// relative to profile_rays(): tests/acoustics/rays/bearings/range_fan_test.cc.
#pragma once

#include <cstddef>
#include <vector>

#include "acoustics/math/fold_field.h"
#include "acoustics/rays/arc_tracer.h"
#include "acoustics/rays/eigenray.h"
#include "acoustics/rays/ray_trace.h"

namespace halocline::acoustics {

// Rays along one bearing, shared by its links.
class RangeFan : public SharedRays {
 public:
  // `ranges_m` are the horizontal ranges of the receivers, m, rising, above 0.
  explicit RangeFan(std::vector<double> ranges_m);

  std::vector<Eigenray> at(const ProfiledSea& sea, const RayLink& link) override;

 private:
  // The ray of the preceding launch angle: lost, of the same bounce sequence, or of another.
  enum class Before { kNone, kAlike, kOther };
  // A ray's arrival at one range, to tell whether it passes an image: zeta = orientation z + base.
  struct Place {
    double zeta, orientation, base;
    Before before;
  };
  struct Ray {
    double zeta_slope;  // d zeta / d theta, m/rad
    double slowness;    // d delay / d zeta, s/m
    Eigenray path;      // with the amplitude of a ray tube of slope 1
  };
  // A ray of one launch angle at the ranges that it reaches.
  struct Traced {
    double theta;
    std::vector<Place> places;
    std::vector<Ray> rays;
  };
  // The rays that reach one range, by launch angle.
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
  // Appends to `fan` rays between its last ray and `next`, and then `next`.
  void halve(const ArcTracer& tracer, std::vector<Traced>& fan, Traced next, int halvings) const;
  // The fold between two rays, the mean of their eigenrays, and the paths of an image that lies between two
  // rays, near a fold of zeta between them, or beside a ray.
  static Fold fold_between(const Ray& one, const Ray& other);
  static Eigenray mean_of(const Ray& one, const Ray& other, double share);
  static Eigenray between(const Range& range, std::size_t b, double target, double frequency_hz);
  static void add_fold(const Range& range, std::size_t b, double target, double frequency_hz,
                       std::vector<Eigenray>& paths);
  static Eigenray beside(const Range& range, std::size_t i, double target);

  std::vector<double> ranges_m_;
  std::vector<Fan> fans_;  // one for each set of options
};

}  // namespace halocline::acoustics
