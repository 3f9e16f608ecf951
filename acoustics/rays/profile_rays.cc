// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/rays/profile_rays.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <utility>

#include "acoustics/rays/branch_solver.h"
#include "acoustics/rays/diffuse_windows.h"
#include "acoustics/rays/fan_tracer.h"
#include "acoustics/rays/profile_path.h"

namespace halocline::acoustics {
namespace {

using std::numbers::pi;

constexpr double kSteepest = 89.9 * pi / 180;  // rad: of rays that do not bounce
constexpr double kMinParting = 1e-10;          // rad: between the rays on both sides of a parting
constexpr double kNextToEachOther = 4e-9;      // rad: the two rays of a fan beside one that grazes a knot
constexpr int kDeepestHalving = 14;
constexpr int kDeepestEdgeHalving = 10;   // towards where rays become too faint or turn back
constexpr int kDeepestWindowHalving = 5;  // between rays that do not arrive
constexpr double kFinestGraze = 1e-7;     // rad: nearest to the ray that grazes
constexpr double kGrazeStep = 1.0 / 6;    // of the way to it
constexpr double kShareBeforehand =
    0.3;  // of the tolerance that rays beside an interval may err for the interval to need no look
constexpr int kMaxTraces = 200'000;  // of one link: a guard against water of endless detail
constexpr double kRough =
    28;  // of the depth, sum of how far neighbours in the fan are apart: more makes a bottom rough
// Over a rough bottom.
constexpr double kNarrowWindow = 3e-5;    // times depth over range, rad: windows are not divided below
constexpr double kWeakWindow = 2e-3;      // rad: nor these where the rays beside them are weak
constexpr double kLeastStrongest = 3e-3;  // of the energy flux: that of the strongest path until one is found

class Search {
 public:
  explicit Search(const ArcTracer& tracer) : tracer_(tracer), branch_(tracer), windows_(tracer) {}

  // Rays launched between the first and the last of `angles`, finished; none within `core_edge` of the
  // horizontal, which is one of the angles, as is its opposite.
  std::vector<Arrival> run(const std::vector<double>& angles, double core_edge);
  // After that: whether paths are weak by their own pressure rather than beside the strongest.
  bool is_weak_by_pressure() const { return windows_.is_by_pressure(); }

 private:
  // Of three neighbours in the fan, whether the one in the middle is where a cubic through the others has it; one right beside
  // another says nothing.
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
  // From a ray to one at the edge of its family. Rays that all but graze the bottom there change the faster the
  // less they bounce: they are looked at in steps that shrink towards the edge.
  void scan_to_edge(const FanRay& from, const FanRay& edge, bool grazing, int depth);

  const ArcTracer& tracer_;
  BranchSolver branch_;
  DiffuseWindows windows_;
  double narrow_window_ = 0;  // rad; 0: the bottom is smooth
};

std::vector<Arrival> Search::run(const std::vector<double>& angles, double core_edge) {
  std::vector<FanRay> fan;
  fan.reserve(angles.size());
  for (const double theta : angles) fan.push_back(branch_.traced(theta));
  std::vector<bool> predicted;  // by the rays on both sides
  for (std::size_t i = 0; i < fan.size(); ++i)
    predicted.push_back(i > 0 && i + 1 < fan.size() && is_predicted(fan[i - 1], fan[i], fan[i + 1]));
  if (tracer_.sea().options.diffuse_below_db <= 0 || !is_rough(fan)) {
    search(fan, predicted, core_edge);
    return branch_.finished();
  }
  double flux = 0;
  for (std::size_t i = 1; i < fan.size(); ++i) flux += windows_.mixed_power(fan[i - 1], fan[i]);
  windows_.set_reference(kLeastStrongest * flux);
  branch_.give_weak_paths_to(&windows_);
  narrow_window_ = kNarrowWindow * tracer_.bottom_at_receiver_m() / tracer_.range_m();
  search(fan, predicted, core_edge);
  std::vector<Arrival> paths = branch_.finished();
  const std::vector<Arrival> diffuse = windows_.arrivals();
  const auto middle = paths.insert(paths.end(), diffuse.begin(), diffuse.end());
  std::inplace_merge(paths.begin(), middle, paths.end(),
                     [](const Arrival& a, const Arrival& b) { return a.delay_s < b.delay_s; });
  return paths;
}

void Search::search(const std::vector<FanRay>& fan, const std::vector<bool>& predicted, double core_edge) {
  std::vector<std::size_t> order;
  for (std::size_t i = 1; i < fan.size(); ++i) order.push_back(i);
  // What is strong comes first, so that more is known to be weak.
  if (narrow_window_ > 0) {
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return std::abs(fan[a - 1].theta + fan[a].theta) < std::abs(fan[b - 1].theta + fan[b].theta);
    });
  }
  for (const std::size_t i : order) {
    if (fan[i - 1].theta < 0 && fan[i].theta > 0 && fan[i].theta <= core_edge) continue;
    windows_.begin_cell(i);
    if (predicted[i - 1] && predicted[i]) {
      branch_.solve(fan[i - 1], fan[i]);
    } else {
      scan(fan[i - 1], fan[i], 0);
    }
  }
}

bool Search::is_predicted(const FanRay& a, const FanRay& middle, const FanRay& b) const {
  const double nearest = std::min(middle.theta - a.theta, b.theta - middle.theta);
  return nearest > kNextToEachOther &&
         branch_.is_predicted(branch_.error_at(a, middle, b), a, b, kShareBeforehand);
}

// Between neighbours of one history, by how much of the depth their depths and the mean of their slopes disagree: at most by
// all of it, as those that part.
bool Search::is_rough(const std::vector<FanRay>& fan) const {
  double apart = 0;
  for (std::size_t i = 1; i < fan.size(); ++i) {
    const FanRay &a = fan[i - 1], &b = fan[i];
    const double width = b.theta - a.theta;
    if (width < kNextToEachOther || !a.arrived || !b.arrived) continue;
    const double off = b.zeta - a.zeta - 0.5 * width * (a.zeta_slope + b.zeta_slope);
    apart += branch_.parting(a, b) ? 1 : std::min(std::abs(off) / tracer_.bottom_at_receiver_m(), 1.0);
  }
  return apart > kRough;
}

void Search::scan(const FanRay& a, const FanRay& b, int depth, double error) {
  const std::size_t before = branch_.kept_events();
  look_between(a, b, depth, error);
  branch_.forget_since(before);
}

void Search::look_between(const FanRay& a, const FanRay& b, int depth, double error) {
  if (narrow_window_ > 0) return look_into_window(a, b, depth, error);
  if (b.theta - a.theta < 4 * kMinParting || branch_.traces() > kMaxTraces) return;
  const bool both = a.arrived && b.arrived, neither = !a.arrived && !b.arrived;
  const auto event = branch_.parting(a, b);
  if (!event && branch_.is_faint(a) && branch_.is_faint(b)) return;
  if (neither) {
    // Over steep bottoms rays that arrive come through windows between others that turn back. Two rays that were given
    // up with the same history have none between them, as a rule.
    const bool alike = !event && a.events == b.events;
    if (alike || depth >= kDeepestWindowHalving) return;
  } else {
    if (depth == 0 && b.theta - a.theta < kNextToEachOther) {
      if (!event && both) branch_.solve_monotone(a, b);
      return;
    }
    if (event) return part(a, b, *event, depth);
    if (both && !branch_.may_pass_image(a, b, error)) return;
    if (depth >= (both ? kDeepestHalving : kDeepestEdgeHalving)) {
      if (both) branch_.solve(a, b);
      return;
    }
  }
  const FanRay middle = branch_.traced(0.5 * (a.theta + b.theta));
  const double found_error = branch_.error_at(a, middle, b);
  if (branch_.is_predicted(found_error, a, b, 1)) {
    branch_.solve(a, middle);
    branch_.solve(middle, b);
  } else {
    scan(a, middle, depth + 1, found_error);
    scan(middle, b, depth + 1, found_error);
  }
}

void Search::look_into_window(const FanRay& a, const FanRay& b, int depth, double error) {
  if (branch_.traces() > kMaxTraces) return windows_.add_mixed(a, b);
  const bool both = a.arrived && b.arrived, neither = !a.arrived && !b.arrived;
  const auto event = branch_.parting(a, b);
  if (!event && branch_.is_faint(a) && branch_.is_faint(b)) return;
  if (neither && ((!event && a.events == b.events) || depth >= kDeepestWindowHalving)) return;
  const double width = b.theta - a.theta;
  const bool is_branch = both && !event;
  if (is_branch && width < kNextToEachOther) return branch_.solve_monotone(a, b);
  if (is_branch && !branch_.may_pass_image(a, b, error)) return;
  if (width < narrow_window_ || (width < kWeakWindow && windows_.is_weak_beside(a, b)) ||
      windows_.is_weak_together(a, b))
    return windows_.add_mixed(a, b);
  const FanRay middle = branch_.traced(0.5 * (a.theta + b.theta));
  const double found_error = branch_.error_at(a, middle, b);
  if (branch_.is_predicted(found_error, a, b, 1)) {
    branch_.solve(a, middle);
    branch_.solve(middle, b);
  } else {
    scan(a, middle, depth + 1, found_error);
    scan(middle, b, depth + 1, found_error);
  }
}

void Search::part(const FanRay& a, const FanRay& b, std::size_t event, int depth) {
  FanRay low = a, high = b;
  while (high.theta - low.theta > kMinParting && branch_.traces() <= kMaxTraces) {
    FanRay middle = branch_.traced(0.5 * (low.theta + high.theta), event + 1);
    std::swap(branch_.shares_event(middle, a, event) ? low : high, middle);
  }
  low = branch_.traced(low.theta);  // all the way
  high = branch_.traced(high.theta);
  const bool bounce_below = branch_.meets_bottom_at(a, event),
             bounce_above = branch_.meets_bottom_at(b, event);
  depth = std::max(0, depth - 4);
  scan_to_edge(a, low, bounce_below && !bounce_above, depth);
  scan_to_edge(b, high, bounce_above && !bounce_below, depth);
}

void Search::scan_to_edge(const FanRay& from, const FanRay& edge, bool grazing, int depth) {
  FanRay last = from;
  const auto scan_last = [&](const FanRay& next) {
    if (last.theta < next.theta) {
      scan(last, next, depth);
    } else {
      scan(next, last, depth);
    }
  };
  if (grazing) {
    for (double off = kGrazeStep * (from.theta - edge.theta); std::abs(off) > kFinestGraze;
         off *= kGrazeStep) {
      FanRay next = branch_.traced(edge.theta + off);
      scan_last(next);
      last = next;
    }
  }
  scan_last(edge);
}

}  // namespace

std::vector<Arrival> profile_rays(const ProfiledSea& sea, const RayLink& link) {
  validate(sea.options);
  const ArcTracer tracer(sea, link);
  std::vector<double> angles = {-kSteepest};
  for (const double theta : fan_angles(tracer, kSteepest)) {
    if (theta < kSteepest) angles.push_back(theta);
  }
  angles.push_back(kSteepest);
  const double core_edge = leave_out_core(tracer, angles);
  Search search(tracer);
  std::vector<Arrival> paths = search.run(angles, core_edge);
  // The last path is not given up for a window, unless it is weak by itself.
  if (!paths.empty() && !search.is_weak_by_pressure() &&
      std::all_of(paths.begin(), paths.end(), [](const Arrival& path) { return path.diffuse; })) {
    ProfiledSea all = sea;
    all.options.diffuse_below_db = 0;
    return profile_rays(all, link);
  }
  return paths;
}

}  // namespace halocline::acoustics
