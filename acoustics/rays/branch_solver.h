// SPDX-License-Identifier: BSD-3-Clause
// Finds the eigenrays between two neighbouring rays of a fan that have the same bounce sequence.
//
// Between the two, the unfolded depth zeta(theta) at the receiver's range is smooth apart from kinks of the
// sound speed profile. Every image of the receiver, +-z + 2 H k, that lies between them is a bracket of an
// eigenray. A turn of zeta (a fold caustic) is located first and splits the bracket. Newton's method with the
// ray tube gives the eigenray (acoustics/rays/profile_rays.h).
//
// The object keeps the rays' events and the paths found: one per search, not shared between threads.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "acoustics/rays/arc_tracer.h"
#include "acoustics/rays/depth_fan.h"
#include "acoustics/rays/diffuse_windows.h"
#include "acoustics/rays/eigenray.h"
#include "acoustics/rays/fan_tracer.h"
#include "acoustics/rays/traced_eigenray.h"

namespace halocline::acoustics {

class BranchSolver {
 public:
  static constexpr double kUnknownError = std::numeric_limits<double>::infinity();

  // Refers to both tracers, which have to outlive this object. With `windows`, weak paths are added to it;
  // with `cache`, rays are shared with searches for receivers at other depths.
  BranchSolver(const ArcTracer& tracer, FanTracer& fan);
  void give_weak_paths_to(DiffuseWindows* windows) { windows_ = windows; }
  void share(DepthFanCache* cache) { cache_ = cache; }

  // Traces the ray launched at `theta`, as FanTracer::trace(), through the cache when there is one.
  FanRay traced(double theta, std::size_t enough_events = FanTracer::kAllEvents);
  // Number of rays traced so far, without those of Newton's method.
  int traces() const { return traces_; }
  // Functions of FanTracer; forget_since() does not drop events that the cache keeps.
  std::size_t kept_events() const { return fan_.kept_events(); }
  void forget_since(std::size_t kept_events) {
    fan_.forget_since(cache_ != nullptr ? std::max(kept_events, cache_->kept_events()) : kept_events);
  }

  // Index of the first event at which two rays differ; empty when one bounce sequence begins with the other.
  std::optional<std::size_t> parting(const FanRay& a, const FanRay& b) const;
  bool shares_event(const FanRay& ray, const FanRay& other, std::size_t event) const;
  bool meets_bottom_at(const FanRay& ray, std::size_t event) const;

  // Error of the cubic through rays `a` and `b` at a ray between them; infinite when their bounce sequences
  // differ.
  double error_at(const FanRay& a, const FanRay& middle, const FanRay& b) const;
  // True when `error` is at most `share` times the tolerance.
  bool is_predicted(double error, const FanRay& a, const FanRay& b, double share) const;
  // True when the ray has lost more than a path of its bounce sequence may lose.
  bool is_faint(const FanRay& ray) const { return ray.loss_db > faint_db_; }
  // True when an image may lie between the depths at which two rays of one bounce sequence arrive, or within
  // the field of a fold beyond them.
  bool may_pass_image(const FanRay& a, const FanRay& b, double error) const;

  // True when an image may lie within an interval of zeta, m, between two rays whose zeta is a cubic.
  bool may_pass_image(double low, double high) const {
    return image_sources_.any_between(low - kNearFold * depth_, high + kNearFold * depth_);
  }

  // Finds all paths between two rays of one bounce sequence.
  void solve(const FanRay& a, const FanRay& b);
  // Finds the paths between two rays of one bounce sequence between which zeta is monotone.
  void solve_monotone(const FanRay& a, const FanRay& b);

  // Returns all paths found, after finish() of eigenray.h.
  std::vector<Eigenray> finished() const { return folds_.finished(paths_); }

 private:
  template <class Visit>
  void visit_images(const FanRay& a, const FanRay& b, const Visit& visit) const;
  // Adds the path to one image, interpolated from the cache or traced.
  void polish(const FanRay& a, const FanRay& b, const ReceiverImage& image);
  // The path of the ray between `a` and `b` that passes the image at `target`.
  std::optional<ImageHit> traced_path(const FanRay& a, const FanRay& b, double target);
  // Moves `turn` to where zeta turns. Returns true when an image lies in the fold's field, as the rays beside
  // it show.
  bool seek_turn(const FanRay& a, const FanRay& b, FanRay& turn);

  const ArcTracer& tracer_;
  FanTracer& fan_;
  ImageSources image_sources_;
  ProfileFolds folds_;
  double depth_, faint_db_;
  int traces_ = 0;
  std::vector<ImageHit> paths_;
  DiffuseWindows* windows_ = nullptr;
  DepthFanCache* cache_ = nullptr;
};

}  // namespace halocline::acoustics
