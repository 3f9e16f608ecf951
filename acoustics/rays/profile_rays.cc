#include "acoustics/rays/profile_rays.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "acoustics/math/fold_field.h"
#include "acoustics/math/hermite_cubic.h"
#include "acoustics/rays/fan_tracer.h"
#include "acoustics/rays/profile_path.h"
#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

using std::numbers::pi;

constexpr double kSteepest = 89.9 * pi / 180;  // rad: of rays that do not bounce
constexpr double kMinParting = 1e-10;          // rad: between the rays on both sides of a parting
constexpr double kNextToEachOther = 4e-9;      // rad: the two rays of a fan beside one that grazes a knot
constexpr int kDeepestHalving = 14;
constexpr int kDeepestEdgeHalving = 10;    // towards where rays become too faint or turn back
constexpr int kDeepestWindowHalving = 5;   // between rays that do not arrive
constexpr double kFinestGraze = 1e-7;      // rad: nearest to the ray that grazes
constexpr double kGrazeStep = 1.0 / 6;     // of the way to it
constexpr double kCubicTolerance = 0.015;  // of the water depth
constexpr double kShareBeforehand =
    0.3;  // of it that rays beside an interval may err for the interval to need no look
constexpr double kDepthTolerance = 1e-4;     // m before the last step of Newton
constexpr double kLastStepTolerance = 1e-5;  // m after it, as foreseen
constexpr double kTurnTolerance = 1e-6;      // m: how far zeta is at most from where it turns
// A cubic between two rays, whose error was found at one of them, errs between them by no more than this many times that;
// besides, a share of what it spans.
constexpr double kErrorReach = 2, kSpanReach = 0.2;
constexpr double kFaintDb =
    3;  // beyond what a path may lose: no path lies between two such rays of one history
constexpr double kUnknownError = std::numeric_limits<double>::infinity();
constexpr double kFoldTolerance =
    2e-3;  // of a length of Airy: how far a fold is at most from where zeta turns
constexpr int kMaxTurnSteps = 40;
constexpr int kMaxTraces = 200'000;  // of one link: a guard against water of endless detail

class Search {
 public:
  explicit Search(const ArcTracer& tracer)
      : tracer_(tracer),
        fan_(tracer),
        images_(tracer),
        folds_(tracer),
        depth_(tracer.bottom_at_receiver_m()),
        faint_db_(kFaintDb - 20 * elementary::log10(tracer.sea().options.min_boundary_factor)) {}

  // Rays launched between the first and the last of `angles`, finished; none within `core_edge` of the
  // horizontal, which is one of the angles, as is its opposite.
  std::vector<Arrival> run(const std::vector<double>& angles, double core_edge);

 private:
  FanRay traced(double theta, std::size_t enough_events = FanTracer::kAllEvents);
  std::optional<std::size_t> parting(const FanRay& a, const FanRay& b) const;
  bool shares_event(const FanRay& ray, const FanRay& other, std::size_t event) const;
  bool meets_bottom_at(const FanRay& ray, std::size_t event) const;
  // All rays between two; what is traced for it is forgotten. `error`: of a cubic, at one of the two.
  void scan(const FanRay& a, const FanRay& b, int depth, double error = kUnknownError);
  void look_between(const FanRay& a, const FanRay& b, int depth, double error);
  void part(const FanRay& a, const FanRay& b, std::size_t event, int depth);
  // From a ray to one at the edge of its family. Rays that all but graze the bottom there change the faster the
  // less they bounce: they are looked at in steps that shrink towards the edge.
  void scan_to_edge(const FanRay& from, const FanRay& edge, bool grazing, int depth);
  void solve(const FanRay& a, const FanRay& b);
  // Rays between two between which zeta is monotone.
  void solve_monotone(const FanRay& a, const FanRay& b);
  void polish(const FanRay& a, const FanRay& b, double target);
  // Whether an image has a share of the field about `turn`, as rays beside it show.
  bool seek_turn(const FanRay& a, const FanRay& b, FanRay& turn);
  // How far a cubic through two rays is off where one between them arrives; infinite where their histories differ.
  double error_at(const FanRay& a, const FanRay& middle, const FanRay& b) const;
  // Whether it is no more than a share of the tolerance.
  bool is_predicted(double error, const FanRay& a, const FanRay& b, double share) const {
    return error <= share * (kCubicTolerance * depth_ + 0.01 * std::abs(b.zeta - a.zeta));
  }
  // Beyond what any ray of its history that is a path may lose.
  bool is_faint(const FanRay& ray) const { return ray.loss_db > faint_db_; }
  bool may_pass_image(const FanRay& a, const FanRay& b, double error) const;

  const ArcTracer& tracer_;
  FanTracer fan_;
  Images images_;
  ProfileFolds folds_;
  double depth_, faint_db_;
  int traces_ = 0;
  std::vector<ProfilePath> paths_;
};

// The first event at which two rays differ; empty when one history begins with the other.
std::optional<std::size_t> Search::parting(const FanRay& a, const FanRay& b) const {
  const auto one = fan_.events_of(a), other = fan_.events_of(b);
  const std::size_t common = std::min(one.size(), other.size());
  for (std::size_t i = 0; i < common; ++i) {
    if (!(one[i] == other[i])) return i;
  }
  return std::nullopt;
}

bool Search::shares_event(const FanRay& ray, const FanRay& other, std::size_t event) const {
  if (ray.events <= event) return false;
  const auto first = parting(ray, other);
  return !first || *first > event;
}

bool Search::meets_bottom_at(const FanRay& ray, std::size_t event) const {
  return fan_.events_of(ray)[event].event == RayEvent::kBottom;
}

FanRay Search::traced(double theta, std::size_t enough_events) {
  ++traces_;
  return fan_.trace(theta, enough_events);
}

std::vector<Arrival> Search::run(const std::vector<double>& angles, double core_edge) {
  std::vector<FanRay> fan;
  fan.reserve(angles.size());
  for (const double theta : angles) fan.push_back(traced(theta));
  std::vector<bool> predicted;  // by the rays on both sides
  for (std::size_t i = 0; i < fan.size(); ++i) {
    predicted.push_back(
        i > 0 && i + 1 < fan.size() &&
        is_predicted(error_at(fan[i - 1], fan[i], fan[i + 1]), fan[i - 1], fan[i + 1], kShareBeforehand));
  }
  for (std::size_t i = 1; i < fan.size(); ++i) {
    if (fan[i - 1].theta < 0 && fan[i].theta > 0 && fan[i].theta <= core_edge) continue;
    if (predicted[i - 1] && predicted[i]) {
      solve(fan[i - 1], fan[i]);
    } else {
      scan(fan[i - 1], fan[i], 0);
    }
  }
  return folds_.finished(paths_);
}

double Search::error_at(const FanRay& a, const FanRay& middle, const FanRay& b) const {
  if (!(a.arrived && b.arrived && middle.arrived) || parting(a, middle) || parting(middle, b)) {
    return kUnknownError;
  }
  const double width = b.theta - a.theta, t = (middle.theta - a.theta) / width;
  return cubic_of(a, b).error_at(t, middle.zeta, middle.zeta_slope, width);
}

// Whether there may be an image between where two rays of one history arrive, or beyond in what sound reaches.
bool Search::may_pass_image(const FanRay& a, const FanRay& b, double error) const {
  if (error == kUnknownError) return true;
  const auto [low, high] = cubic_of(a, b).extremes();
  const double beyond = kErrorReach * error + kSpanReach * (high - low);
  double dark_low = 0, dark_high = 0;
  if (a.zeta_slope * b.zeta_slope < 0)
    (a.zeta_slope > 0 ? dark_high : dark_low) = -kDarkFold * folds_.length_m(fold_between(a, b));
  return images_.any_between(low - std::max(beyond, dark_low), high + std::max(beyond, dark_high));
}

void Search::scan(const FanRay& a, const FanRay& b, int depth, double error) {
  const std::size_t before = fan_.kept_events();
  look_between(a, b, depth, error);
  fan_.forget_since(before);
}

void Search::look_between(const FanRay& a, const FanRay& b, int depth, double error) {
  if (b.theta - a.theta < 4 * kMinParting || traces_ > kMaxTraces) return;
  const bool both = a.arrived && b.arrived, neither = !a.arrived && !b.arrived;
  const auto event = parting(a, b);
  if (!event && is_faint(a) && is_faint(b)) return;
  if (neither) {
    // Over steep bottoms rays that arrive come through windows between others that turn back. Two rays that were given
    // up with the same history have none between them, as a rule.
    const bool alike = !event && a.events == b.events;
    if (alike || depth >= kDeepestWindowHalving) return;
  } else {
    if (depth == 0 && b.theta - a.theta < kNextToEachOther) {
      if (!event && both) solve_monotone(a, b);
      return;
    }
    if (event) return part(a, b, *event, depth);
    if (both && !may_pass_image(a, b, error)) return;
    if (depth >= (both ? kDeepestHalving : kDeepestEdgeHalving)) {
      if (both) solve(a, b);
      return;
    }
  }
  const FanRay middle = traced(0.5 * (a.theta + b.theta));
  const double found_error = error_at(a, middle, b);
  if (is_predicted(found_error, a, b, 1)) {
    solve(a, middle);
    solve(middle, b);
  } else {
    scan(a, middle, depth + 1, found_error);
    scan(middle, b, depth + 1, found_error);
  }
}

void Search::part(const FanRay& a, const FanRay& b, std::size_t event, int depth) {
  FanRay low = a, high = b;
  while (high.theta - low.theta > kMinParting && traces_ <= kMaxTraces) {
    FanRay middle = traced(0.5 * (low.theta + high.theta), event + 1);
    std::swap(shares_event(middle, a, event) ? low : high, middle);
  }
  low = traced(low.theta);  // all the way
  high = traced(high.theta);
  const bool bounce_below = meets_bottom_at(a, event), bounce_above = meets_bottom_at(b, event);
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
      FanRay next = traced(edge.theta + off);
      scan_last(next);
      last = next;
    }
  }
  scan_last(edge);
}

void Search::solve(const FanRay& a, const FanRay& b) {
  if (is_faint(a) && is_faint(b)) return;
  const HermiteCubic cubic = cubic_of(a, b);
  const HermiteCubic::Turns turns = cubic.turns();
  FanRay from = a;
  for (const double t : turns) {
    const double theta = a.theta + t * (b.theta - a.theta);
    if (theta <= from.theta) continue;
    FanRay turn;
    if (turns.count > 1 || images_.off_nearest(cubic(t)) < kNearFold * depth_) {
      turn = traced(theta);
      if (!turn.arrived) continue;
      if (images_.off_nearest(cubic(t)) < kNearFold * depth_ && seek_turn(from, b, turn))
        folds_.note(turn.theta);
    } else {  // this ray separates the images on both sides as well as the one that turns
      turn.theta = theta;
      turn.zeta = cubic(t);
    }
    solve_monotone(from, turn);
    from = turn;
  }
  solve_monotone(from, b);
}

// Moves `turn`, a guess between two rays, to where the slope of zeta is 0; leaves it where there is no such place. False
// position after Anderson and Bjoerck (1973): the value of an end that stays is taken smaller each time, so both ends
// close in; every third step halves where that does not.
bool Search::seek_turn(const FanRay& a, const FanRay& b, FanRay& turn) {
  const auto rises = [](const FanRay& ray) { return ray.zeta_slope > 0; };
  const bool before = rises(a) != rises(turn);
  if (!before && rises(turn) == rises(b)) return false;
  FanRay low = before ? a : turn, high = before ? turn : b;
  double at_low = low.zeta_slope, at_high = high.zeta_slope, width = high.theta - low.theta;
  const bool is_greatest = rises(low);
  for (int i = 1; i <= kMaxTurnSteps; ++i) {
    const double span = high.theta - low.theta;
    const bool slow = i % 3 == 0 && span > 0.25 * std::exchange(width, span);
    const double share = slow ? 0.5 : std::clamp(at_low / (at_low - at_high), 1e-3, 1 - 1e-3);
    FanRay middle = traced(low.theta + share * span);
    if (!middle.arrived) return false;
    turn = middle;
    const double slope = turn.zeta_slope;
    const bool beside_low = rises(turn) == is_greatest;
    // What is left of zeta to where it turns, at most: along the slope up to the other end; and by how it bends.
    const double bend = std::min(bend_between(low, turn), bend_between(turn, high));
    const double left =
        std::min(std::abs(slope) * (beside_low ? high.theta - turn.theta : turn.theta - low.theta),
                 bend > 0 ? slope * slope / bend : kUnknownError);
    const double length = is_faint(turn) ? 0 : folds_.length_m(fold_at(low, turn, high));
    // Clear of all images; and known well enough for the field of the fold, if that has one.
    const bool is_field = images_.any_in_fold(turn.zeta, is_greatest, length, 2 * left);
    const bool is_clear =
        images_.off_nearest(turn.zeta) > 2 * left && (!is_field || left < kFoldTolerance * length);
    if (left < kTurnTolerance || is_clear) return is_field;
    FanRay& end = beside_low ? low : high;
    double &replaced = beside_low ? at_low : at_high, &kept = beside_low ? at_high : at_low;
    const double scale = 1 - slope / replaced;
    kept *= scale > 0 ? scale : 0.5;
    replaced = slope;
    end = turn;
  }
  return false;
}

void Search::solve_monotone(const FanRay& a, const FanRay& b) {
  const double low = std::min(a.zeta, b.zeta), high = std::max(a.zeta, b.zeta), period = 2 * depth_;
  for (const double image : {tracer_.receiver_depth_m(), -tracer_.receiver_depth_m()}) {
    for (double k = std::ceil((low - image) / period); image + k * period < high;
         ++k) {  // low <= target < high
      polish(a, b, image + k * period);
    }
  }
}

void Search::polish(const FanRay& a, const FanRay& b, double target) {
  const bool rising = b.zeta > a.zeta;
  double low = a.theta, high = b.theta;
  double theta = low + cubic_of(a, b).crossing(target) * (high - low);
  for (int i = 0; i < 60; ++i) {
    const FanRay ray = fan_.trace(theta);
    if (!ray.arrived) return;
    const double off = ray.zeta - target;
    ((off > 0) == rising ? high : low) = theta;
    const double next = ray.zeta_slope != 0 ? theta - off / ray.zeta_slope : low - 1;
    const bool inside = next > low && next < high;
    // What the step leaves, by how much the slope changes to either side.
    const double bend = std::max(bend_between(a, ray), bend_between(ray, b)), step = next - theta;
    if (std::abs(off) < kDepthTolerance || (inside && 0.5 * bend * step * step < kLastStepTolerance)) {
      if (inside) theta = next;  // none where rounding rules
      break;
    }
    theta = inside ? next : 0.5 * (low + high);
    if (high - low < 1e-15) break;
  }
  if (auto path = profile_path(tracer_, theta, target)) paths_.push_back(std::move(*path));
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
  return Search(tracer).run(angles, core_edge);
}

}  // namespace halocline::acoustics
