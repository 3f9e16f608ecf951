#include "acoustics/profile_rays.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "acoustics/hermite_cubic.h"
#include "acoustics/profile_path.h"

namespace halocline::acoustics {
namespace {

using std::numbers::pi;

constexpr double kSteepest = 89.9 * pi / 180;  // rad: of rays that do not bounce
constexpr double kLeastParting = 1e-11;        // rad: between the rays on both sides of a parting
constexpr int kDeepestHalving = 14;
constexpr int kDeepestEdgeHalving = 7;    // towards where rays become too faint
constexpr double kCubicTolerance = 0.02;  // of the water depth
constexpr double kNearFold = 0.15;  // of the water depth: a turn nearer to an image is sought out exactly
constexpr double kDepthTolerance = 1e-4;  // m before the last step of Newton
constexpr int kMostTraces = 200'000;      // of one link: a guard against water of endless detail

class Search {
 public:
  Search(const ProfiledSea& sea, const RayLink& link)
      : tracer_(sea, link), depth_(tracer_.bottom_at_receiver_m()) {}

  std::vector<Arrival> run();

 private:
  TracedRay traced(double theta);
  void scan(const TracedRay& a, const TracedRay& b, int depth);
  void part(const TracedRay& a, const TracedRay& b, std::size_t event, int depth);
  void solve(const TracedRay& a, const TracedRay& b);
  void solve_monotone(const TracedRay& a, const TracedRay& b, double fold_theta);
  void polish(const TracedRay& a, const TracedRay& b, double target, double fold_theta);
  TracedRay turn_between(const TracedRay& a, const TracedRay& b);
  double off_nearest_image(double zeta) const;

  ArcTracer tracer_;
  double depth_;
  int traces_ = 0;
  std::vector<Arrival> paths_;
};

HermiteCubic cubic_of(const TracedRay& a, const TracedRay& b) {
  return {a.zeta, a.zeta_slope, b.zeta, b.zeta_slope, b.theta - a.theta};
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

TracedRay Search::traced(double theta) {
  TracedRay ray;
  tracer_.trace(theta, ray);
  ++traces_;
  return ray;
}

std::vector<Arrival> Search::run() {
  TracedRay before = traced(-kSteepest);
  for (const double theta : fan_angles(tracer_, kSteepest)) {
    const TracedRay next = traced(theta);
    scan(before, next, 0);
    before = next;
  }
  finish(paths_, tracer_.sea().options);
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
    const TracedRay middle = traced(0.5 * (low.theta + high.theta));
    (shares_event(middle, a, event) ? low : high) = middle;
  }
  scan(a, low, std::max(0, depth - 4));
  scan(high, b, std::max(0, depth - 4));
}

double Search::off_nearest_image(double zeta) const {
  const double period = 2 * depth_, z = tracer_.receiver_depth_m();
  return std::min(std::abs(std::remainder(zeta - z, period)), std::abs(std::remainder(zeta + z, period)));
}

void Search::solve(const TracedRay& a, const TracedRay& b) {
  const HermiteCubic cubic = cubic_of(a, b);
  TracedRay from = a;
  double fold_theta = kNoFold;
  for (const double t : cubic.turns()) {
    const double theta = a.theta + t * (b.theta - a.theta), reach = 0.25 * (b.theta - a.theta);
    TracedRay turn = traced(theta);
    if (off_nearest_image(cubic(t)) < kNearFold * depth_) {
      turn = turn_between(traced(std::max(a.theta, theta - reach)), traced(std::min(b.theta, theta + reach)));
    }
    if (!turn.arrived || turn.theta <= from.theta) continue;
    solve_monotone(from, turn, turn.theta);
    fold_theta = turn.theta;
    from = turn;
  }
  solve_monotone(from, b, fold_theta);
}

TracedRay Search::turn_between(const TracedRay& a, const TracedRay& b) {
  TracedRay low = a, high = b, middle = a;
  if ((low.zeta_slope > 0) == (high.zeta_slope > 0)) return traced(0.5 * (a.theta + b.theta));
  for (int i = 0; i < 40; ++i) {
    const double share = low.zeta_slope / (low.zeta_slope - high.zeta_slope);
    const double bounded = i % 3 == 2 ? 0.5 : std::clamp(share, 0.01, 0.99);
    middle = traced(low.theta + bounded * (high.theta - low.theta));
    if (!middle.arrived || std::abs(middle.zeta_slope) * (high.theta - low.theta) < 1e-9) break;
    ((middle.zeta_slope > 0) == (low.zeta_slope > 0) ? low : high) = middle;
  }
  return middle;
}

void Search::solve_monotone(const TracedRay& a, const TracedRay& b, double fold_theta) {
  const double low = std::min(a.zeta, b.zeta), high = std::max(a.zeta, b.zeta), period = 2 * depth_;
  for (const double image : {tracer_.receiver_depth_m(), -tracer_.receiver_depth_m()}) {
    for (double k = std::ceil((low - image) / period); image + k * period < high;
         ++k) {  // low <= target < high
      polish(a, b, image + k * period, fold_theta);
    }
  }
}

void Search::polish(const TracedRay& a, const TracedRay& b, double target, double fold_theta) {
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
  append_profile_arrival(tracer_, theta, fold_theta, target, paths_);
}

}  // namespace

std::vector<Arrival> profile_rays(const ProfiledSea& sea, const RayLink& link) {
  validate(sea.options);
  return Search(sea, link).run();
}

}  // namespace halocline::acoustics
