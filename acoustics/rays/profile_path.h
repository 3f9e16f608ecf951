// SPDX-License-Identifier: BSD-3-Clause
// Turns one traced ray over a bottom profile into an arrival, gives the launch angles that a search begins
// with, and the way of a path that was found, for drawings.
//
// Equations: acoustics/rays/profile_rays.h.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <vector>

#include "acoustics/math/fold_field.h"
#include "acoustics/rays/arc_tracer.h"
#include "acoustics/rays/arrivals.h"
#include "acoustics/rays/traced_ray.h"

namespace halocline::acoustics {

inline constexpr double kSteepestRay = 89.9 * std::numbers::pi / 180;  // rad: of rays that do not bounce
inline constexpr double kNearFold = 0.06;  // of the water depth: a turn nearer to an image is sought out

// The images of a receiver in unfolded depth, +-z + 2 H k.
class Images {
 public:
  explicit Images(const ArcTracer& tracer)
      : z_(tracer.receiver_depth_m()), period_(2 * tracer.bottom_at_receiver_m()) {}

  double off_nearest(double zeta) const {
    return std::min(std::abs(std::remainder(zeta - z_, period_)),
                    std::abs(std::remainder(zeta + z_, period_)));
  }
  bool any_between(double low, double high) const {
    return std::ceil((low - z_) / period_) * period_ + z_ <= high ||
           std::ceil((low + z_) / period_) * period_ - z_ <= high;
  }
  // Within `more` of the field of a fold that turns at `zeta`, its length of Airy `length` or 0 for no field.
  bool any_in_fold(double zeta, bool is_greatest, double length, double more) const {
    if (length <= 0) return false;
    const double lit = kLitFold * length + more, dark = -kDarkFold * length + more;
    return is_greatest ? any_between(zeta - lit, zeta + dark) : any_between(zeta - dark, zeta + lit);
  }

 private:
  double z_, period_;
};

// An arrival and what it is found again by.
struct ProfilePath {
  Arrival arrival;
  double target;             // image of the receiver, m of unfolded depth
  double zeta_slope = 0;     // d zeta / d theta of the ray
  std::uint64_t family = 0;  // of the ray
};
// Where a ray arrives: the horizontal range, the image of the receiver in unfolded depth, the width of the
// ray's tube there, |q|, m.
struct ArrivalPlace {
  double range_m, target_m, tube_m;
};
Arrival arrival_of(const ArcTracer& tracer, const TracedRay& ray, const TracedDetails& details,
                   const ArrivalPlace& place);
// Of the ray of `theta`, which passes the image `target` of the receiver within a few millimetres of unfolded
// depth; empty when the options exclude it.
std::optional<ProfilePath> profile_path(const ArcTracer& tracer, double theta, double target);

// Of a window of diffuse sound launched at `theta`, the one of this number in its link: none that a path has.
PathIdentity diffuse_identity(double theta, std::size_t window);
// What stands for such a window: the ray of `theta`, which arrives somewhere at the receiver's range, as an
// arrival without an amplitude. Empty when the ray does not arrive.
struct DiffuseRay {
  Arrival arrival;
  double xi;  // Snell's, at the receiver's range, s/m
};
std::optional<DiffuseRay> diffuse_ray(const ArcTracer& tracer, double theta, std::size_t window);

// The folds of one search, and what they make of its paths.
class ProfileFolds {
 public:
  // Refers to the tracer, which has to outlive this.
  explicit ProfileFolds(const ArcTracer& tracer) : tracer_(tracer) {}

  // Of Airy, m, of a fold as rays about it show it, with a margin; at most so long that turns are sought out,
  // and 0 without RayOptions::airy_folds.
  double length_m(const Fold& fold) const;
  // Unfolded depth turns at the ray of `theta`, near an image of the receiver.
  void note(double theta);
  // All arrivals, finished: one on the dark side of a fold and about it, two with its field beyond.
  std::vector<Arrival> finished(const std::vector<ProfilePath>& paths) const;

 private:
  struct Found {
    Arrival path;        // the one that the fold makes by itself
    double target, x;    // x of acoustics/math/fold_field.h
    double to_rays_rad;  // from the fold's launch angle to those of its rays, to first order
  };

  const ArcTracer& tracer_;
  TracedRay before_, after_;  // buffers
  std::vector<Found> found_;
};

// Launch angles from -limit to limit, rising, rad: close near the horizontal, where rays are many and far
// apart in range; `coarseness` (above 0) times as far apart as those of fan_angles().
std::vector<double> even_angles(double limit, double coarseness);
// Launch angles above -steepest and up to `steepest`, rising, rad: even_angles() and those just on both sides
// of the angles at which rays graze a knot of the water on their first leg; of a section, one where the
// gradient jumps by 0.01 1/s or more.
std::vector<double> fan_angles(const ArcTracer& tracer, double steepest);

// Takes the launch angles out within which rays nowhere go faster than the core's speed, and puts those of
// its edges in. The angle of the edge; 0 where there is no core.
double leave_out_core(const ArcTracer& tracer, std::vector<double>& angles);

// The way of a path found between the ends of `link` by any solver of the same sea, from the source to the
// receiver, ranges rising, at most `max_points` (2 or more). The ray is traced again from its launch angle
// and ends at the receiver; one that cannot be (steeper than 89.9 degrees, along the core of a channel) goes
// by straight lines from bounce to bounce. Where points have to be left out, those that change the way most
// stay (simplified()).
std::vector<RayPoint> polyline(const ProfiledSea& sea, const RayLink& link, const Arrival& path,
                               std::size_t max_points);

// At most `max_points` (2 or more) of points of rising range: the ends, and one after the other the point
// that lies furthest above or below the line through those kept, until all lie within 0.05 m of it.
std::vector<RayPoint> simplified(const std::vector<RayPoint>& points, std::size_t max_points);

}  // namespace halocline::acoustics
