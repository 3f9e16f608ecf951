// SPDX-License-Identifier: BSD-3-Clause
// Every ray between two points of layered water over a bottom that changes with range.
//
// Method: a fan of exactly traced rays (acoustics/rays/arc_tracer.h). Between two neighbours of the same
// history the unfolded depth zeta(theta) at the receiver's range is smooth but for bends of the water's
// profile; each cell is halved until a cubic through values and slopes predicts its middle. Every image of
// the receiver, +-z + 2 H k, that lies between two rays is a bracket; a turn of zeta (a fold) is sought first
// and split at. Histories that part (a ray that grazes the surface or a crest, or meets the other side of a
// corner) part the cell there, by bisection; between rays that do not arrive it is halved five times where
// their histories differ. Newton with the ray tube polishes; what is left of the depth is taken off the
// delay to first order, so delays err by its square. Amplitude A^2 = c_r cos_s / (c_s r |q|) times the
// bounces; at a fold the field is that of acoustics/math/fold_field.h.
//
// Accuracy: exact for knots and facets given. Left out: rays that turn back, slopes across the link,
// diffraction but that of caustics.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "acoustics/rays/arc_tracer.h"
#include "acoustics/rays/arrivals.h"
#include "acoustics/rays/branch_solver.h"
#include "acoustics/rays/column_rays.h"
#include "acoustics/rays/diffuse_windows.h"
#include "acoustics/rays/fan_tracer.h"
#include "acoustics/rays/traced_ray.h"

namespace halocline::acoustics {

// All rays of `link`; depths between the surface and the bottom at both ends (at a boundary: a micrometre off
// it).
std::vector<Arrival> profile_rays(const ProfiledSea& sea, const RayLink& link);
// The same between the ends of the tracer, with a fan of launch_angles(). With a cache, rays are
// shared with the searches for receivers at other depths of the place.
std::vector<Arrival> profile_rays(const ArcTracer& tracer, FanTracer& fan, std::vector<double> angles,
                                  ColumnCache* cache);

// Launch angles of the first fan, rising, rad.
std::vector<double> launch_angles(const ArcTracer& tracer);

// Two rays of one history between which zeta is their cubic.
struct Branch {
  FanRay a, b;
  bool is_monotone;
  double low, high;  // of zeta between them
};

// Which parts of a fan hold paths: between neighbours the unfolded depth is halved until it is a cubic; such
// branches are solved by branch_solver.h, for one receiver or collected for many. One for each search, not
// shared between threads.
class ProfileSearch {
 public:
  // Refers to both, which have to outlive this.
  ProfileSearch(const ArcTracer& tracer, FanTracer& fan)
      : tracer_(tracer), branch_(tracer, fan), windows_(tracer) {}

  // Rays are shared with searches for receivers at other depths.
  void share(ColumnCache* cache) {
    branch_.share(cache);
    cache_ = cache;
  }
  // Rays launched between the first and the last of `angles`, finished; none within `core_edge` of the
  // horizontal, which is one of the angles, as is its opposite.
  std::vector<Arrival> run(const std::vector<double>& angles, double core_edge);
  // All branches between them, wherever the receiver is; empty over a rough bottom.
  std::optional<std::vector<Branch>> branches(const std::vector<double>& angles);
  // After that: whether paths are weak by their own pressure rather than beside the strongest.
  bool is_weak_by_pressure() const { return windows_.is_by_pressure(); }

 private:
  std::vector<FanRay> traced(const std::vector<double>& angles);
  // Of each ray of the fan, whether those on both sides tell where it arrives.
  std::vector<bool> predicted(const std::vector<FanRay>& fan) const;
  // Of three neighbours in the fan, whether the one in the middle is where a cubic through the others has it;
  // one right beside another says nothing.
  bool is_predicted(const FanRay& a, const FanRay& middle, const FanRay& b) const;
  // Whether rays diverge so much that each search for them would find others between.
  bool is_rough(const std::vector<FanRay>& fan) const;
  // Between neighbours of the fan; `predicted`: those are that lie on a cubic through the rays on both sides.
  void search(const std::vector<FanRay>& fan, const std::vector<bool>& predicted, double core_edge);
  // All rays between two; what is traced for it is forgotten. `error`: of a cubic, at one of the two.
  void scan(const FanRay& a, const FanRay& b, int depth, double error = BranchSolver::kUnknownError);
  void look_between(const FanRay& a, const FanRay& b, int depth, double error);
  // The same over a rough bottom: to where a window is narrow, or what lies in it weak.
  void look_into_window(const FanRay& a, const FanRay& b, int depth, double error);
  void part(const FanRay& a, const FanRay& b, std::size_t event, int depth);
  // From a ray to one at the edge of its family. Rays that all but graze the bottom there change the faster
  // the less they bounce: they are looked at in steps that shrink towards the edge.
  void scan_to_edge(const FanRay& from, const FanRay& edge, bool grazing, int depth);
  // A branch without a turn, or any: solved, or collected.
  void take_monotone(const FanRay& a, const FanRay& b);
  void take(const FanRay& a, const FanRay& b);
  bool is_without_path(const FanRay& a, const FanRay& b, double error) const {
    return collected_ == nullptr && !branch_.may_pass_image(a, b, error);
  }

  const ArcTracer& tracer_;
  BranchSolver branch_;
  DiffuseWindows windows_;
  double narrow_window_ = 0;  // rad; 0: the bottom is smooth
  std::vector<Branch>* collected_ = nullptr;
  ColumnCache* cache_ = nullptr;
};

}  // namespace halocline::acoustics
