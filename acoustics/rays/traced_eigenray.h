// SPDX-License-Identifier: BSD-3-Clause
// Turns one traced ray over a bottom profile into an eigenray, gives the launch angles of a search's first
// fan, and lays out the course of an eigenray as a polyline for drawings.
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
#include "acoustics/rays/eigenray.h"
#include "acoustics/rays/ray_trace.h"

namespace halocline::acoustics {

// Steepest launch angle that is traced, rad.
inline constexpr double kSteepestRay = 89.9 * std::numbers::pi / 180;
// Share of the water depth: a turn of zeta this near to an image is located exactly.
inline constexpr double kNearFold = 0.06;

// Image sources seen from the receiver: its images in unfolded depth, +-z + 2 H k, with H the depth of the
// bottom at the receiver and k any whole number.
class ImageSources {
 public:
  explicit ImageSources(const ArcTracer& tracer)
      : z_(tracer.receiver_depth_m()), period_(2 * tracer.bottom_at_receiver_m()) {}

  // Distance from `zeta` to the nearest image, m.
  double off_nearest(double zeta) const {
    return std::min(std::abs(std::remainder(zeta - z_, period_)),
                    std::abs(std::remainder(zeta + z_, period_)));
  }
  // True when an image lies within [low, high].
  bool any_between(double low, double high) const {
    return std::ceil((low - z_) / period_) * period_ + z_ <= high ||
           std::ceil((low + z_) / period_) * period_ - z_ <= high;
  }
  // True when an image lies in the field of a fold caustic whose unfolded depth turns at `zeta`, or within
  // `more` metres of that field. `length` is the caustic's Airy length, m; 0 for no field.
  bool any_in_fold(double zeta, bool is_greatest, double length, double more) const {
    if (length <= 0) return false;
    const double lit = kLitFold * length + more, dark = -kDarkFold * length + more;
    return is_greatest ? any_between(zeta - lit, zeta + dark) : any_between(zeta - dark, zeta + lit);
  }

 private:
  double z_, period_;
};

// A traced ray that passes an image of the receiver: its eigenray, and how the search finds it again.
struct ImageHit {
  Eigenray eigenray;
  double target;             // image of the receiver, m of unfolded depth
  double zeta_slope = 0;     // d zeta / d theta of the ray, m/rad
  std::uint64_t family = 0;  // eigenray family of the ray
};
// The end of a ray tube: the horizontal range, the image of the receiver in unfolded depth, and the width |q|
// of the tube there per radian of launch angle, all in metres.
struct TubeEnd {
  double range_m, target_m, tube_m;
};
// The eigenray of a traced ray, with the amplitude A of the ray tube: A^2 = c_r cos_s / (c_s r |q|).
Eigenray eigenray_of(const ArcTracer& tracer, const RayTrace& ray, const TraceDetails& details,
                     const TubeEnd& end);
// The path of the ray launched at `theta`, which passes the image `target` of the receiver within a few
// millimetres of unfolded depth; empty when the options exclude it.
std::optional<ImageHit> image_hit(const ArcTracer& tracer, double theta, double target);

// Identity of the diffuse path of a window of launch angles around `theta`, the one numbered `window` in
// its link. No eigenray has such an identity.
PathIdentity diffuse_identity(double theta, std::size_t window);
// The ray that represents such a window: the ray launched at `theta`, which arrives at any depth at the
// receiver's range, as an eigenray without an amplitude.
struct DiffuseRay {
  Eigenray eigenray;
  double xi;  // Snell's invariant at the receiver's range, s/m
};
// The ray launched at `theta` that represents a window; empty when it does not arrive.
std::optional<DiffuseRay> diffuse_ray(const ArcTracer& tracer, double theta, std::size_t window);

// The fold caustics of one search, and the paths with the caustics' fields applied.
class ProfileFolds {
 public:
  // Refers to the tracer, which has to outlive this.
  explicit ProfileFolds(const ArcTracer& tracer) : tracer_(tracer) {}

  // Airy length of a fold, m, as the rays around it show it, with a margin. It is limited to the length at
  // which turns of zeta are still located exactly; 0 without RayOptions::airy_folds.
  double length_m(const Fold& fold) const;
  // Notes a fold: unfolded depth turns at the ray launched at `theta`, near an image of the receiver.
  void note(double theta);
  // Returns all eigenrays, after finish() of eigenray.h. A receiver on the shadow side of a fold or close to
  // it gets a single path; one further on the illuminated side gets two, with the fold's field.
  std::vector<Eigenray> finished(const std::vector<ImageHit>& paths) const;

 private:
  struct Found {
    Eigenray path;       // the path of the fold itself
    double target, x;    // x of acoustics/math/fold_field.h
    double to_rays_rad;  // launch angle between the fold and either of its two rays, to first order
  };

  const ArcTracer& tracer_;
  RayTrace before_, after_;  // scratch buffers
  std::vector<Found> found_;
};

// Launch angles from -limit to limit, rising, rad. They are close together near the horizontal, where rays
// are many and far apart in range. `coarseness` (above 0) scales their spacing relative to that of
// fan_angles().
std::vector<double> even_angles(double limit, double coarseness);
// Launch angles in (-steepest, steepest], rising, rad: even_angles(), and pairs just to both sides of each
// angle at which a ray grazes a knot of the profile on its first leg. With water that changes along the link,
// only the surface and the deepest knot count.
std::vector<double> fan_angles(const ArcTracer& tracer, double steepest);

// Removes the launch angles of rays that nowhere exceed the sound speed of the channel's core, and inserts
// the two angles at its edges. Returns the angle of the edge, rad; 0 where there is no core.
double leave_out_core(const ArcTracer& tracer, std::vector<double>& angles);

// The course of an eigenray between the ends of `link`, found by any solver for the same sea: points from the
// source to the receiver with rising ranges, at most `max_points` (2 or more). The ray is traced again from
// its launch angle and ends at the receiver. A ray that cannot be traced again (steeper than 89.9 degrees, or
// along the core of a channel) is drawn by straight lines from bounce to bounce. Points are left out as by
// simplified().
std::vector<RayPoint> polyline(const ProfiledSea& sea, const RayLink& link, const Eigenray& path,
                               std::size_t max_points);

// Reduces a polyline of rising ranges to at most `max_points` points (2 or more). It keeps the ends, then
// repeatedly adds the point furthest above or below the line through the points kept, until all lie within
// 0.05 m of that line.
std::vector<RayPoint> simplified(const std::vector<RayPoint>& points, std::size_t max_points);

}  // namespace halocline::acoustics
