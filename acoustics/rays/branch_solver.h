// SPDX-License-Identifier: BSD-3-Clause
// Finds the eigenrays between two neighbouring rays of a fan that have the same history.
//
// Between them the unfolded depth zeta(theta) at the receiver's range is smooth but for bends of the water's
// profile. Every image of the receiver, +-z + 2 H k, that lies between the two is a bracket; a turn of zeta
// (a fold) is sought first and split at. Newton with the ray tube polishes (acoustics/rays/profile_rays.h).
//
// Keeps the rays' events and what it has found: one for each search, not shared between threads.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "acoustics/rays/arc_tracer.h"
#include "acoustics/rays/arrivals.h"
#include "acoustics/rays/column_rays.h"
#include "acoustics/rays/diffuse_windows.h"
#include "acoustics/rays/fan_tracer.h"
#include "acoustics/rays/profile_path.h"

namespace halocline::acoustics {

class BranchSolver {
 public:
  static constexpr double kUnknownError = std::numeric_limits<double>::infinity();

  // Refers to both tracers, which have to outlive this. With `windows`, weak paths go there; with `cache`,
  // rays are shared with searches for receivers at other depths.
  BranchSolver(const ArcTracer& tracer, FanTracer& fan);
  void give_weak_paths_to(DiffuseWindows* windows) { windows_ = windows; }
  void share(ColumnCache* cache) { cache_ = cache; }

  FanRay traced(double theta, std::size_t enough_events = FanTracer::kAllEvents);
  // Rays traced so far, but those of polishing.
  int traces() const { return traces_; }
  // As FanTracer's.
  std::size_t kept_events() const { return fan_.kept_events(); }
  void forget_since(std::size_t kept_events) {
    fan_.forget_since(cache_ != nullptr ? std::max(kept_events, cache_->kept_events()) : kept_events);
  }

  // The first event at which two rays differ; empty when one history begins with the other.
  std::optional<std::size_t> parting(const FanRay& a, const FanRay& b) const;
  bool shares_event(const FanRay& ray, const FanRay& other, std::size_t event) const;
  bool meets_bottom_at(const FanRay& ray, std::size_t event) const;

  // How far a cubic through two rays is off where one between them arrives; infinite where their histories
  // differ.
  double error_at(const FanRay& a, const FanRay& middle, const FanRay& b) const;
  // Whether it is no more than a share of the tolerance.
  bool is_predicted(double error, const FanRay& a, const FanRay& b, double share) const;
  // Beyond what any ray of its history that is a path may lose.
  bool is_faint(const FanRay& ray) const { return ray.loss_db > faint_db_; }
  // Whether there may be an image between where two rays of one history arrive, or beyond in what sound
  // reaches.
  bool may_pass_image(const FanRay& a, const FanRay& b, double error) const;

  // The same of rays between which zeta is their cubic.
  bool may_pass_image(double low, double high) const {
    return images_.any_between(low - kNearFold * depth_, high + kNearFold * depth_);
  }

  // All paths between two rays of one history.
  void solve(const FanRay& a, const FanRay& b);
  // The same where zeta is monotone.
  void solve_monotone(const FanRay& a, const FanRay& b);

  // All paths found, finished.
  std::vector<Arrival> finished() const { return folds_.finished(paths_); }

 private:
  template <class Visit>
  void visit_images(const FanRay& a, const FanRay& b, const Visit& visit) const;
  void polish(const FanRay& a, const FanRay& b, const ReceiverImage& image);
  // Of the ray that passes the image between two.
  std::optional<ProfilePath> traced_path(const FanRay& a, const FanRay& b, double target);
  // Whether an image has a share of the field about `turn`, as rays beside it show.
  bool seek_turn(const FanRay& a, const FanRay& b, FanRay& turn);

  const ArcTracer& tracer_;
  FanTracer& fan_;
  Images images_;
  ProfileFolds folds_;
  double depth_, faint_db_;
  int traces_ = 0;
  std::vector<ProfilePath> paths_;
  DiffuseWindows* windows_ = nullptr;
  ColumnCache* cache_ = nullptr;
};

}  // namespace halocline::acoustics
