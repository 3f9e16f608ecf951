// SPDX-License-Identifier: BSD-3-Clause
// Eigenrays between two points of layered water over a range-dependent bottom.
//
// Method. A fan of exactly traced rays (acoustics/rays/arc_tracer.h) brackets the eigenrays. Between two
// neighbours of the same bounce sequence the unfolded depth zeta(theta) at the receiver's range is smooth
// apart from kinks of the sound speed profile; each cell is halved until a cubic through values and slopes
// predicts its middle. Every image of the receiver, +-z + 2 H k, that lies between two rays is a bracket of
// an eigenray. A turn of zeta (a fold caustic) is located first and splits the cell.
//
// Where bounce sequences differ (a ray grazes the surface or a crest, or meets the other side of a corner),
// bisection finds the angle of the change and splits the cell there. Between rays that do not arrive a cell
// is halved five times when their sequences differ.
//
// Newton's method with the ray tube then gives the eigenray. The remaining error of the depth is taken off
// the delay to first order, so delays err by its square. The amplitude is
//   A^2 = c_r cos_s / (c_s r |q|)
// times the factors of the bounces; at a fold the field is that of acoustics/math/fold_field.h.
//
// Accuracy: exact for the given knots and facets. Neglected: rays that turn back towards the source, bottom
// slopes across the link, diffraction other than at caustics.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "acoustics/rays/arc_tracer.h"
#include "acoustics/rays/branch_solver.h"
#include "acoustics/rays/depth_fan.h"
#include "acoustics/rays/diffuse_windows.h"
#include "acoustics/rays/eigenray.h"
#include "acoustics/rays/fan_tracer.h"
#include "acoustics/rays/ray_trace.h"

namespace halocline::acoustics {

// Returns all eigenrays of `link`. Its depths lie between the surface and the bottom at both ends; an end at
// a boundary is moved off it by a micrometre.
std::vector<Eigenray> profile_rays(const ProfiledSea& sea, const RayLink& link);
// Returns all eigenrays between the ends of the tracer, with a first fan of `angles` such as launch_angles().
// With a cache, rays are shared with the searches for receivers at other depths of the same place.
std::vector<Eigenray> profile_rays(const ArcTracer& tracer, FanTracer& fan, std::vector<double> angles,
                                   DepthFanCache* cache);

// Launch angles of the first fan, rising, rad.
std::vector<double> launch_angles(const ArcTracer& tracer);

// Two rays of one bounce sequence, between which a cubic in the launch angle describes zeta.
struct Branch {
  FanRay a, b;
  bool is_monotone;
  double low, high;  // range of zeta between the two rays, m
};

// Search of a fan for the intervals that contain eigenrays. The interval between two neighbours is halved
// until the unfolded depth is a cubic; branch_solver.h then solves such branches for one receiver, or they
// are collected for many receivers. One object per search, not shared between threads.
class ProfileSearch {
 public:
  // Refers to tracer and fan, which have to outlive this object.
  ProfileSearch(const ArcTracer& tracer, FanTracer& fan)
      : tracer_(tracer), branch_(tracer, fan), windows_(tracer) {}

  // Shares rays with searches for receivers at other depths.
  void share(DepthFanCache* cache) {
    branch_.share(cache);
    cache_ = cache;
  }
  // The eigenrays, after finish(), of the rays launched between the first and the last of `angles`. Rays
  // within `core_edge` of the horizontal are left out; that angle and its negative are among `angles`.
  std::vector<Eigenray> run(const std::vector<double>& angles, double core_edge);
  // Returns all branches between the angles, independent of the receiver's depth; empty over a rough bottom.
  std::optional<std::vector<Branch>> branches(const std::vector<double>& angles);
  // To be called after run(): true when a path counts as weak by its own pressure, false when relative to the
  // strongest path.
  bool is_weak_by_pressure() const { return windows_.is_by_pressure(); }

 private:
  std::vector<FanRay> traced(const std::vector<double>& angles);
  // For each ray of the fan, true when its neighbours predict where it arrives.
  std::vector<bool> predicted(const std::vector<FanRay>& fan) const;
  // True when a cubic through rays `a` and `b` predicts the ray between them. A ray right beside another is
  // no test and gives false.
  bool is_predicted(const FanRay& a, const FanRay& middle, const FanRay& b) const;
  // True when rays diverge so strongly that any search between two of them would find others in between.
  bool is_rough(const std::vector<FanRay>& fan) const;
  // Searches between neighbours of the fan. `predicted` marks the rays that lie on a cubic through their
  // neighbours.
  void search(const std::vector<FanRay>& fan, const std::vector<bool>& predicted, double core_edge);
  // Searches between two rays and then forgets what was traced for it. `error` is that of a cubic at one of
  // the two.
  void scan(const FanRay& a, const FanRay& b, int depth, double error = BranchSolver::kUnknownError);
  void look_between(const FanRay& a, const FanRay& b, int depth, double error);
  // Searches between two rays over a rough bottom: halving ends where a window of launch angles is narrow or
  // its paths are weak.
  void look_into_window(const FanRay& a, const FanRay& b, int depth, double error);
  // Splits the interval at the angle at which the event of index `event` changes, and searches both parts.
  void part(const FanRay& a, const FanRay& b, std::size_t event, int depth);
  // Searches from a ray to one at the edge of its family. Rays that nearly graze the bottom there change the
  // faster the closer they are to grazing, so the steps shrink towards the edge.
  void scan_to_edge(const FanRay& from, const FanRay& edge, bool grazing, int depth);
  // Solve a branch, or collect it when run by branches(): one without a turn of zeta, and any branch.
  void take_monotone(const FanRay& a, const FanRay& b);
  void take(const FanRay& a, const FanRay& b);
  bool is_without_path(const FanRay& a, const FanRay& b, double error) const {
    return collected_ == nullptr && !branch_.may_pass_image(a, b, error);
  }

  const ArcTracer& tracer_;
  BranchSolver branch_;
  DiffuseWindows windows_;
  double narrow_window_ = 0;  // width below which a window is not divided, rad; 0: the bottom is smooth
  std::vector<Branch>* collected_ = nullptr;
  DepthFanCache* cache_ = nullptr;
};

}  // namespace halocline::acoustics
