// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/rays/branch_solver.h"

#include <utility>

#include "acoustics/math/fold_field.h"
#include "acoustics/math/hermite_cubic.h"
#include "acoustics/rays/ray_trace.h"
#include "core/elementary.h"

namespace halocline::acoustics {
namespace {

constexpr double kCubicTolerance = 0.015;    // relative to the water depth
constexpr double kDepthTolerance = 1e-4;     // m: error before the last step of Newton's method
constexpr double kLastStepTolerance = 1e-5;  // m: predicted error after it
constexpr double kTurnTolerance = 1e-6;      // m: greatest distance of zeta from its turn
// Bound of a cubic's error anywhere between two rays: kErrorReach times its error found at one of them, plus
// kSpanReach times the interval of depths that it spans.
constexpr double kErrorReach = 2, kSpanReach = 0.2;
// Margin on what a path may lose: no path lies between two rays of one bounce sequence that both exceed it.
constexpr double kFaintDb = 3;
// Greatest distance of a fold from the turn of zeta, relative to the Airy length.
constexpr double kFoldTolerance = 2e-3;
constexpr int kMaxTurnSteps = 40;

}  // namespace

BranchSolver::BranchSolver(const ArcTracer& tracer, FanTracer& fan)
    : tracer_(tracer),
      fan_(fan),
      image_sources_(tracer),
      folds_(tracer),
      depth_(tracer.bottom_at_receiver_m()),
      faint_db_(kFaintDb - 20 * elementary::log10(tracer.sea().options.min_boundary_factor)) {}

std::optional<std::size_t> BranchSolver::parting(const FanRay& a, const FanRay& b) const {
  const auto one = fan_.events_of(a), other = fan_.events_of(b);
  const std::size_t common = std::min(one.size(), other.size());
  for (std::size_t i = 0; i < common; ++i) {
    if (!(one[i] == other[i])) return i;
  }
  return std::nullopt;
}

bool BranchSolver::shares_event(const FanRay& ray, const FanRay& other, std::size_t event) const {
  if (ray.events <= event) return false;
  const auto first = parting(ray, other);
  return !first || *first > event;
}

bool BranchSolver::meets_bottom_at(const FanRay& ray, std::size_t event) const {
  return fan_.events_of(ray)[event].event == RayEvent::kBottom;
}

FanRay BranchSolver::traced(double theta, std::size_t enough_events) {
  ++traces_;
  return cache_ != nullptr ? cache_->traced(theta, enough_events) : fan_.trace(theta, enough_events);
}

double BranchSolver::error_at(const FanRay& a, const FanRay& middle, const FanRay& b) const {
  if (!(a.arrived && b.arrived && middle.arrived) || parting(a, middle) || parting(middle, b)) {
    return kUnknownError;
  }
  const double width = b.theta - a.theta, t = (middle.theta - a.theta) / width;
  return cubic_of(a, b).error_at(t, middle.zeta, middle.zeta_slope, width);
}

bool BranchSolver::is_predicted(double error, const FanRay& a, const FanRay& b, double share) const {
  return error <= share * (kCubicTolerance * depth_ + 0.01 * std::abs(b.zeta - a.zeta));
}

bool BranchSolver::may_pass_image(const FanRay& a, const FanRay& b, double error) const {
  if (error == kUnknownError) return true;
  const auto [low, high] = cubic_of(a, b).extremes();
  const double beyond = kErrorReach * error + kSpanReach * (high - low);
  double dark_low = 0, dark_high = 0;
  if (a.zeta_slope * b.zeta_slope < 0)
    (a.zeta_slope > 0 ? dark_high : dark_low) = -kDarkFold * folds_.length_m(fold_between(a, b));
  return image_sources_.any_between(low - std::max(beyond, dark_low), high + std::max(beyond, dark_high));
}

void BranchSolver::solve(const FanRay& a, const FanRay& b) {
  if (is_faint(a) && is_faint(b)) return;
  const HermiteCubic cubic = cubic_of(a, b);
  const HermiteCubic::Turns turns = cubic.turns();
  FanRay from = a;
  for (const double t : turns) {
    const double theta = a.theta + t * (b.theta - a.theta);
    if (theta <= from.theta) continue;
    FanRay turn;
    if (turns.count > 1 || image_sources_.off_nearest(cubic(t)) < kNearFold * depth_) {
      turn = traced(theta);
      if (!turn.arrived) continue;
      if (image_sources_.off_nearest(cubic(t)) < kNearFold * depth_ && seek_turn(from, b, turn))
        folds_.note(turn.theta);
      // This ray separates the images on both sides as well as the ray at the turn.
    } else {
      turn.theta = theta;
      turn.zeta = cubic(t);
    }
    solve_monotone(from, turn);
    from = turn;
  }
  solve_monotone(from, b);
}

// Moves `turn`, a guess between two rays, to where the slope of zeta is 0; leaves it where there is no such
// place. False position after Anderson and Bjoerck (1973): the value at an end that stays is reduced at each
// step, so both ends close in. Every third step bisects when that is slow.
bool BranchSolver::seek_turn(const FanRay& a, const FanRay& b, FanRay& turn) {
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
    // Bound of the distance of zeta from its turn: along the slope up to the other end, and by the curvature,
    // slope^2 / bend.
    const double bend = std::min(bend_between(low, turn), bend_between(turn, high));
    const double left =
        std::min(std::abs(slope) * (beside_low ? high.theta - turn.theta : turn.theta - low.theta),
                 bend > 0 ? slope * slope / bend : kUnknownError);
    const double length = is_faint(turn) ? 0 : folds_.length_m(fold_at(low, turn, high));
    // Done when clear of all images, and when the fold's place is known well enough for its field, if it has
    // one.
    const bool is_field = image_sources_.any_in_fold(turn.zeta, is_greatest, length, 2 * left);
    const bool is_clear =
        image_sources_.off_nearest(turn.zeta) > 2 * left && (!is_field || left < kFoldTolerance * length);
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

// Calls visit(image) for each image with low <= target < high.
template <class Visit>
void BranchSolver::visit_images(const FanRay& a, const FanRay& b, const Visit& visit) const {
  const double low = std::min(a.zeta, b.zeta), high = std::max(a.zeta, b.zeta), period = 2 * depth_;
  for (const double sign : {1.0, -1.0}) {
    const double image = sign * tracer_.receiver_depth_m();
    for (double k = std::ceil((low - image) / period); image + k * period < high; ++k)
      visit(ReceiverImage{sign, k, image + k * period});
  }
}

void BranchSolver::solve_monotone(const FanRay& a, const FanRay& b) {
  if (windows_ != nullptr && windows_->is_weak_branch(a, b)) {
    int images = 0;
    visit_images(a, b, [&](const ReceiverImage&) { ++images; });
    return windows_->add_branch(a, b, images);
  }
  visit_images(a, b, [&](const ReceiverImage& image) { polish(a, b, image); });
}

void BranchSolver::polish(const FanRay& a, const FanRay& b, const ReceiverImage& image) {
  std::optional<ImageHit> path;
  if (cache_ != nullptr) path = cache_->chains().between(a, b, image);
  if (!path) {
    path = traced_path(a, b, image.target);
    if (path && cache_ != nullptr) cache_->chains().keep(*path, image);
  }
  if (!path) return;
  if (windows_ != nullptr) windows_->note(path->eigenray);
  paths_.push_back(std::move(*path));
}

std::optional<ImageHit> BranchSolver::traced_path(const FanRay& a, const FanRay& b, double target) {
  const bool rising = b.zeta > a.zeta;
  double low = a.theta, high = b.theta;
  double theta = low + cubic_of(a, b).crossing(target) * (high - low);
  const std::size_t before = fan_.kept_events();
  for (int i = 0; i < 60; ++i) {
    const FanRay ray = fan_.trace(theta);
    fan_.forget_since(before);
    if (!ray.arrived) return std::nullopt;
    const double off = ray.zeta - target;
    ((off > 0) == rising ? high : low) = theta;
    const double next = ray.zeta_slope != 0 ? theta - off / ray.zeta_slope : low - 1;
    const bool inside = next > low && next < high;
    // The error that a Newton step leaves is half of the curvature times the step's square.
    const double bend = std::max(bend_between(a, ray), bend_between(ray, b)), step = next - theta;
    if (std::abs(off) < kDepthTolerance || (inside && 0.5 * bend * step * step < kLastStepTolerance)) {
      // Not where rounding dominates.
      if (inside) theta = next;
      break;
    }
    theta = inside ? next : 0.5 * (low + high);
    if (high - low < 1e-15) break;
  }
  return image_hit(tracer_, theta, target);
}

}  // namespace halocline::acoustics
