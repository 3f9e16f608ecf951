#include "acoustics/profile_rays.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "acoustics/hermite_cubic.h"
#include "acoustics/profile_path.h"

namespace halocline::acoustics {
namespace {

using std::numbers::pi;

constexpr double kSteepest = 89.9 * pi / 180;  // rad: of rays that do not bounce
constexpr double kLeastParting = 1e-11;        // rad: between the rays on both sides of a parting
constexpr int kDeepestHalving = 14;
constexpr int kDeepestEdgeHalving = 7;    // towards where rays become too faint
constexpr double kFinestGraze = 1e-7;     // rad: nearest to the ray that grazes
constexpr double kGrazeStep = 1.0 / 6;    // of the way to it
constexpr double kCubicTolerance = 0.02;  // of the water depth
constexpr double kNearFold = 0.15;  // of the water depth: a turn nearer to an image is sought out exactly
constexpr double kDepthTolerance = 1e-4;  // m before the last step of Newton
constexpr double kTurnTolerance = 1e-6;   // m: how far zeta is at most from where it turns
constexpr double kFoldZone = 0.01;  // of the water depth: further from all images a turn need not be exact
constexpr int kMostTurnSteps = 40;
constexpr int kMostTraces = 200'000;  // of one link: a guard against water of endless detail

class Search {
 public:
  explicit Search(const ArcTracer& tracer) : tracer_(tracer), depth_(tracer.bottom_at_receiver_m()) {}

  // Rays launched between the first and the last of `angles`, as they are found.
  std::vector<Arrival> run(const std::vector<double>& angles);

 private:
  TracedRay traced(double theta);
  void scan(const TracedRay& a, const TracedRay& b, int depth);
  void part(const TracedRay& a, const TracedRay& b, std::size_t event, int depth);
  // From a ray to one at the edge of its family. Rays that all but graze the bottom there change the faster the
  // less they bounce: they are looked at in steps that shrink towards the edge.
  void scan_to_edge(const TracedRay& from, const TracedRay& edge, bool grazing, int depth);
  void solve(const TracedRay& a, const TracedRay& b);
  // Rays between two between which zeta is monotone; `fold` is one of them or none.
  void solve_monotone(const TracedRay& a, const TracedRay& b, const Fold& fold);
  void polish(const TracedRay& a, const TracedRay& b, double target, const Fold& fold);
  bool seek_turn(const TracedRay& a, const TracedRay& b, TracedRay& turn);
  double off_nearest_image(double zeta) const;

  const ArcTracer& tracer_;
  double depth_;
  int traces_ = 0;
  std::vector<Arrival> paths_;
};

HermiteCubic cubic_of(const TracedRay& a, const TracedRay& b) {
  return {a.zeta, a.zeta_slope, b.zeta, b.zeta_slope, b.theta - a.theta};
}

Fold fold_between(const TracedRay& turn, const TracedRay& other) {
  return {turn.theta, std::abs((other.zeta_slope - turn.zeta_slope) / (other.theta - turn.theta))};
}

// The first event at which two rays differ; empty when one history begins with the other.
std::optional<std::size_t> parting(const TracedRay& a, const TracedRay& b) {
  const std::size_t common = std::min(a.events.size(), b.events.size());
  const auto differ = std::mismatch(a.events.begin(), a.events.begin() + static_cast<std::ptrdiff_t>(common),
                                    b.events.begin());
  const auto index = static_cast<std::size_t>(differ.first - a.events.begin());
  return index < common ? std::optional(index) : std::nullopt;
}

bool shares_event(const TracedRay& ray, const TracedRay& other, std::size_t event) {
  return ray.events.size() > event &&
         std::equal(ray.events.begin(), ray.events.begin() + static_cast<std::ptrdiff_t>(event) + 1,
                    other.events.begin());
}

bool meets_bottom_at(const TracedRay& ray, std::size_t event) {
  return ray.events[event].event == RayEvent::kBottom;
}

TracedRay Search::traced(double theta) {
  TracedRay ray;
  tracer_.trace(theta, ray);
  ++traces_;
  return ray;
}

std::vector<Arrival> Search::run(const std::vector<double>& angles) {
  TracedRay before = traced(angles.front());
  for (std::size_t i = 1; i < angles.size(); ++i) {
    TracedRay next = traced(angles[i]);
    scan(before, next, 0);
    before = std::move(next);
  }
  return std::move(paths_);
}

void Search::scan(const TracedRay& a, const TracedRay& b, int depth) {
  if (!a.arrived && !b.arrived) return;
  if (b.theta - a.theta < 4 * kLeastParting || traces_ > kMostTraces) return;
  if (const auto event = parting(a, b)) return part(a, b, *event, depth);
  if (depth >= kDeepestHalving || (!(a.arrived && b.arrived) && depth >= kDeepestEdgeHalving)) {
    if (a.arrived && b.arrived) solve(a, b);
    return;
  }
  const TracedRay middle = traced(0.5 * (a.theta + b.theta));
  const bool whole = a.arrived && b.arrived && middle.arrived && !parting(a, middle) && !parting(middle, b);
  const double error =
      whole ? cubic_of(a, b).error_at_middle(middle.zeta, middle.zeta_slope, b.theta - a.theta) : 0;
  if (whole && error <= kCubicTolerance * depth_ + 0.01 * std::abs(b.zeta - a.zeta)) {
    solve(a, middle);
    solve(middle, b);
  } else {
    scan(a, middle, depth + 1);
    scan(middle, b, depth + 1);
  }
}

void Search::part(const TracedRay& a, const TracedRay& b, std::size_t event, int depth) {
  TracedRay low = a, high = b;
  while (high.theta - low.theta > kLeastParting && traces_ <= kMostTraces) {
    TracedRay middle = traced(0.5 * (low.theta + high.theta));
    std::swap(shares_event(middle, a, event) ? low : high, middle);
  }
  const bool bounce_below = meets_bottom_at(a, event), bounce_above = meets_bottom_at(b, event);
  depth = std::max(0, depth - 4);
  scan_to_edge(a, low, bounce_below && !bounce_above, depth);
  scan_to_edge(b, high, bounce_above && !bounce_below, depth);
}

void Search::scan_to_edge(const TracedRay& from, const TracedRay& edge, bool grazing, int depth) {
  TracedRay last = from;
  const auto scan_last = [&](const TracedRay& next) {
    last.theta < next.theta ? scan(last, next, depth) : scan(next, last, depth);
  };
  if (grazing) {
    for (double off = kGrazeStep * (from.theta - edge.theta); std::abs(off) > kFinestGraze;
         off *= kGrazeStep) {
      TracedRay next = traced(edge.theta + off);
      scan_last(next);
      last = std::move(next);
    }
  }
  scan_last(edge);
}

double Search::off_nearest_image(double zeta) const {
  const double period = 2 * depth_, z = tracer_.receiver_depth_m();
  return std::min(std::abs(std::remainder(zeta - z, period)), std::abs(std::remainder(zeta + z, period)));
}

void Search::solve(const TracedRay& a, const TracedRay& b) {
  const HermiteCubic cubic = cubic_of(a, b);
  TracedRay from = a;
  Fold before;
  for (const double t : cubic.turns()) {
    TracedRay turn = traced(a.theta + t * (b.theta - a.theta));
    if (!turn.arrived || turn.theta <= from.theta) continue;
    const bool folds = off_nearest_image(cubic(t)) < kNearFold * depth_ && seek_turn(from, b, turn);
    solve_monotone(from, turn, folds ? fold_between(turn, from) : Fold{});
    before = folds ? fold_between(turn, b) : Fold{};
    from = turn;
  }
  solve_monotone(from, b, before);
}

// Moves `turn`, a guess between two rays, to where the slope of zeta is 0; false when there is no such place. False
// position after Anderson and Bjoerck (1973): the value of an end that stays is taken smaller each time, so both ends
// close in; every third step halves where that does not.
bool Search::seek_turn(const TracedRay& a, const TracedRay& b, TracedRay& turn) {
  const auto rises = [](const TracedRay& ray) { return ray.zeta_slope > 0; };
  const bool before = rises(a) != rises(turn);
  if (!before && rises(turn) == rises(b)) return false;
  const TracedRay &first = before ? a : turn, &last = before ? turn : b;
  double low = first.theta, high = last.theta, at_low = first.zeta_slope, at_high = last.zeta_slope;
  const bool rises_at_low = rises(first);
  double width = high - low;
  for (int i = 1; i <= kMostTurnSteps; ++i) {
    const bool slow = i % 3 == 0 && high - low > 0.25 * std::exchange(width, high - low);
    const double share = slow ? 0.5 : std::clamp(at_low / (at_low - at_high), 1e-3, 1 - 1e-3);
    TracedRay middle = traced(low + share * (high - low));
    if (!middle.arrived) break;
    turn = std::move(middle);
    const double slope = turn.zeta_slope;
    const double left = std::abs(slope) * (high - low);
    if (left < kTurnTolerance || off_nearest_image(turn.zeta) > 2 * left + kFoldZone * depth_) break;
    const bool beside_low = rises(turn) == rises_at_low;
    double &replaced = beside_low ? at_low : at_high, &kept = beside_low ? at_high : at_low;
    const double scale = 1 - slope / replaced;
    kept *= scale > 0 ? scale : 0.5;
    replaced = slope;
    (beside_low ? low : high) = turn.theta;
  }
  return true;
}

void Search::solve_monotone(const TracedRay& a, const TracedRay& b, const Fold& fold) {
  const double low = std::min(a.zeta, b.zeta), high = std::max(a.zeta, b.zeta), period = 2 * depth_;
  for (const double image : {tracer_.receiver_depth_m(), -tracer_.receiver_depth_m()}) {
    for (double k = std::ceil((low - image) / period); image + k * period < high;
         ++k) {  // low <= target < high
      polish(a, b, image + k * period, fold);
    }
  }
}

void Search::polish(const TracedRay& a, const TracedRay& b, double target, const Fold& fold) {
  const bool rising = b.zeta > a.zeta;
  double low = a.theta, high = b.theta;
  double theta = low + cubic_of(a, b).crossing(target) * (high - low);
  TracedRay ray;
  for (int i = 0; i < 60; ++i) {
    tracer_.trace(theta, ray);
    if (!ray.arrived) return;
    const double off = ray.zeta - target;
    ((off > 0) == rising ? high : low) = theta;
    const double next = ray.zeta_slope != 0 ? theta - off / ray.zeta_slope : low - 1;
    if (std::abs(off) <
        kDepthTolerance) {  // the last step squares the error, or is none where rounding rules
      if (next > low && next < high) theta = next;
      break;
    }
    theta = next > low && next < high ? next : 0.5 * (low + high);
    if (high - low < 1e-15) break;
  }
  append_profile_arrival(tracer_, theta, fold, target, paths_);
}

}  // namespace

std::vector<Arrival> profile_rays(const ProfiledSea& sea, const RayLink& link) {
  validate(sea.options);
  const ArcTracer tracer(sea, link);
  std::vector<Arrival> paths = profile_rays_between(tracer, -kSteepest, kSteepest);
  finish(paths, sea.options);
  return paths;
}

std::vector<Arrival> profile_rays_between(const ArcTracer& tracer, double from, double to) {
  std::vector<double> angles = {std::max(from, -kSteepest)};
  for (const double theta : fan_angles(tracer, kSteepest)) {
    if (theta > from && theta < to) angles.push_back(theta);
  }
  angles.push_back(std::min(to, kSteepest));
  return Search(tracer).run(angles);
}

}  // namespace halocline::acoustics
