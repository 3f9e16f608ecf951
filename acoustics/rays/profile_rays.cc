// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/rays/profile_rays.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "acoustics/rays/traced_eigenray.h"
#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

using std::numbers::pi;

// Radians between the rays on both sides of a change of bounce sequence.
constexpr double kMinParting = 1e-10;
constexpr double kNextToEachOther = 4e-9;  // rad: distance of two rays of a fan beside one that grazes a knot
constexpr int kDeepestHalving = 14;
constexpr int kDeepestEdgeHalving = 10;   // towards rays that are too faint or turn back
constexpr int kDeepestWindowHalving = 5;  // between rays that do not arrive
constexpr double kFinestGraze = 1e-7;     // rad: closest approach to the ray that grazes
constexpr double kGrazeStep = 1.0 / 6;    // factor on the distance to it, per step
// Share of the tolerance that the predictions of both rays of an interval may err by for the interval not to
// be halved.
constexpr double kShareBeforehand = 0.3;
constexpr int kMaxTraces = 200'000;  // per link: a guard against profiles of endless detail
// Sum of the prediction errors between neighbours in the fan, in water depths, beyond which a bottom counts
// as rough.
constexpr double kRough = 28;
// Limits over a rough bottom.
constexpr double kNarrowWindow = 3e-5;  // times depth over range, rad: narrower windows are not divided
// Radians: narrower windows are not divided when the rays beside them are weak.
constexpr double kWeakWindow = 2e-3;
// Share of the energy flux that the strongest path is assumed to have until one is found.
constexpr double kMinStrongest = 3e-3;

}  // namespace

std::vector<double> launch_angles(const ArcTracer& tracer) {
  std::vector<double> angles = {-kSteepestRay};
  for (const double theta : fan_angles(tracer, kSteepestRay)) {
    if (theta < kSteepestRay) angles.push_back(theta);
  }
  angles.push_back(kSteepestRay);
  return angles;
}

std::vector<FanRay> ProfileSearch::traced(const std::vector<double>& angles) {
  std::vector<FanRay> fan;
  fan.reserve(angles.size());
  for (const double theta : angles) fan.push_back(branch_.traced(theta));
  return fan;
}

std::vector<bool> ProfileSearch::predicted(const std::vector<FanRay>& fan) const {
  std::vector<bool> predicted;
  for (std::size_t i = 0; i < fan.size(); ++i)
    predicted.push_back(i > 0 && i + 1 < fan.size() && is_predicted(fan[i - 1], fan[i], fan[i + 1]));
  return predicted;
}

void ProfileSearch::take_monotone(const FanRay& a, const FanRay& b) {
  if (collected_ == nullptr) return branch_.solve_monotone(a, b);
  const auto [low, high] = std::minmax(a.zeta, b.zeta);
  collected_->push_back({a, b, true, low, high});
}

void ProfileSearch::take(const FanRay& a, const FanRay& b) {
  if (collected_ == nullptr) return branch_.solve(a, b);
  const auto [low, high] = cubic_of(a, b).extremes();
  collected_->push_back({a, b, false, low, high});
}

std::optional<std::vector<Branch>> ProfileSearch::branches(const std::vector<double>& angles) {
  const std::vector<FanRay> fan = traced(angles);
  if (tracer_.sea().options.diffuse_below_db > 0 && is_rough(fan)) return std::nullopt;
  std::vector<Branch> all;
  collected_ = &all;
  search(fan, predicted(fan), /*core_edge=*/0);
  collected_ = nullptr;
  return all;
}

std::vector<Eigenray> ProfileSearch::run(const std::vector<double>& angles, double core_edge) {
  const std::vector<FanRay> fan = traced(angles);
  const std::vector<bool> predicted = this->predicted(fan);
  if (tracer_.sea().options.diffuse_below_db <= 0 || !is_rough(fan)) {
    search(fan, predicted, core_edge);
    return branch_.finished();
  }
  double flux = 0;
  for (std::size_t i = 1; i < fan.size(); ++i) flux += windows_.energy_flux(fan[i - 1], fan[i]);
  windows_.set_reference(kMinStrongest * flux);
  if (const double below_db = tracer_.sea().options.diffuse_below_flux_db; below_db > 0)
    windows_.raise_least(elementary::exp10(-below_db / 10) * flux);
  branch_.give_weak_paths_to(&windows_);
  narrow_window_ = kNarrowWindow * tracer_.bottom_at_receiver_m() / tracer_.range_m();
  search(fan, predicted, core_edge);
  std::vector<Eigenray> paths = branch_.finished();
  const std::vector<Eigenray> diffuse = windows_.eigenrays(cache_);
  const auto middle = paths.insert(paths.end(), diffuse.begin(), diffuse.end());
  std::inplace_merge(paths.begin(), middle, paths.end(),
                     [](const Eigenray& a, const Eigenray& b) { return a.delay_s < b.delay_s; });
  return paths;
}

void ProfileSearch::search(const std::vector<FanRay>& fan, const std::vector<bool>& predicted,
                           double core_edge) {
  std::vector<std::size_t> order;
  for (std::size_t i = 1; i < fan.size(); ++i) order.push_back(i);
  // The strong paths near the horizontal come first, so that more of the later ones are known to be weak.
  if (narrow_window_ > 0) {
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return std::abs(fan[a - 1].theta + fan[a].theta) < std::abs(fan[b - 1].theta + fan[b].theta);
    });
  }
  for (const std::size_t i : order) {
    if (fan[i - 1].theta < 0 && fan[i].theta > 0 && fan[i].theta <= core_edge) continue;
    windows_.begin_cell(i);
    if (predicted[i - 1] && predicted[i]) {
      take(fan[i - 1], fan[i]);
    } else {
      scan(fan[i - 1], fan[i], 0);
    }
  }
}

bool ProfileSearch::is_predicted(const FanRay& a, const FanRay& middle, const FanRay& b) const {
  const double nearest = std::min(middle.theta - a.theta, b.theta - middle.theta);
  return nearest > kNextToEachOther &&
         branch_.is_predicted(branch_.error_at(a, middle, b), a, b, kShareBeforehand);
}

// Sums over the neighbours how far the difference of their depths departs from the mean of their slopes, in
// water depths. Each pair counts at most 1, as do pairs of different bounce sequences.
bool ProfileSearch::is_rough(const std::vector<FanRay>& fan) const {
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

void ProfileSearch::scan(const FanRay& a, const FanRay& b, int depth, double error) {
  const std::size_t before = branch_.kept_events();
  look_between(a, b, depth, error);
  branch_.forget_since(before);
}

void ProfileSearch::look_between(const FanRay& a, const FanRay& b, int depth, double error) {
  if (narrow_window_ > 0) return look_into_window(a, b, depth, error);
  if (b.theta - a.theta < 4 * kMinParting || branch_.traces() > kMaxTraces) return;
  const bool both = a.arrived && b.arrived, neither = !a.arrived && !b.arrived;
  const auto event = branch_.parting(a, b);
  if (!event && branch_.is_faint(a) && branch_.is_faint(b)) return;
  if (neither) {
    // Over steep bottoms, rays that arrive come through windows between others that turn back. As a rule no
    // such window lies between two rays that stopped with the same bounce sequence.
    const bool alike = !event && a.events == b.events;
    if (alike || depth >= kDeepestWindowHalving) return;
  } else {
    if (depth == 0 && b.theta - a.theta < kNextToEachOther) {
      if (!event && both) take_monotone(a, b);
      return;
    }
    if (event) return part(a, b, *event, depth);
    if (both && is_without_path(a, b, error)) return;
    if (depth >= (both ? kDeepestHalving : kDeepestEdgeHalving)) {
      if (both) take(a, b);
      return;
    }
  }
  const FanRay middle = branch_.traced(0.5 * (a.theta + b.theta));
  const double found_error = branch_.error_at(a, middle, b);
  if (branch_.is_predicted(found_error, a, b, 1)) {
    take(a, middle);
    take(middle, b);
  } else {
    scan(a, middle, depth + 1, found_error);
    scan(middle, b, depth + 1, found_error);
  }
}

void ProfileSearch::look_into_window(const FanRay& a, const FanRay& b, int depth, double error) {
  if (branch_.traces() > kMaxTraces) return windows_.add_energy_flux(a, b);
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
    return windows_.add_energy_flux(a, b);
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

void ProfileSearch::part(const FanRay& a, const FanRay& b, std::size_t event, int depth) {
  FanRay low = a, high = b;
  while (high.theta - low.theta > kMinParting && branch_.traces() <= kMaxTraces) {
    FanRay middle = branch_.traced(0.5 * (low.theta + high.theta), event + 1);
    std::swap(branch_.shares_event(middle, a, event) ? low : high, middle);
  }
  low = branch_.traced(low.theta);  // traced to the receiver's range
  high = branch_.traced(high.theta);
  const bool bounce_below = branch_.meets_bottom_at(a, event),
             bounce_above = branch_.meets_bottom_at(b, event);
  depth = std::max(0, depth - 4);
  scan_to_edge(a, low, bounce_below && !bounce_above, depth);
  scan_to_edge(b, high, bounce_above && !bounce_below, depth);
}

void ProfileSearch::scan_to_edge(const FanRay& from, const FanRay& edge, bool grazing, int depth) {
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

std::vector<Eigenray> profile_rays(const ArcTracer& tracer, FanTracer& fan, std::vector<double> angles,
                                   DepthFanCache* cache) {
  const double core_edge = leave_out_core(tracer, angles);
  ProfileSearch search(tracer, fan);
  search.share(cache);
  std::vector<Eigenray> paths = search.run(angles, core_edge);
  // If only diffuse windows are left, the search is repeated without them, unless paths count as weak by
  // their own pressure: a link that has a path keeps at least one.
  if (!paths.empty() && !search.is_weak_by_pressure() &&
      std::all_of(paths.begin(), paths.end(), [](const Eigenray& path) { return path.diffuse; })) {
    ProfiledSea all = tracer.sea();
    all.options.diffuse_below_db = 0;
    return profile_rays(all, {tracer.source_depth_m(), tracer.receiver_depth_m(), tracer.range_m()});
  }
  return paths;
}

std::vector<Eigenray> profile_rays(const ProfiledSea& sea, const RayLink& link) {
  validate(sea.options);
  const ArcTracer tracer(sea, link);
  FanTracer fan(tracer);
  return profile_rays(tracer, fan, launch_angles(tracer), /*cache=*/nullptr);
}

}  // namespace halocline::acoustics
