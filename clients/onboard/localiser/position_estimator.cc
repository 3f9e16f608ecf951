// SPDX-License-Identifier: BSD-3-Clause
#include "clients/onboard/localiser/position_estimator.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Dense>

#include "core/check.h"
#include "core/elementary.h"

namespace halocline::clients {
namespace {

// Outliers are taken to be 1 in 100 ranges, by echoes that are late by up to some hundreds of metres.
constexpr double kOutlierShare = 0.01, kOutlierDensityPerM = 1.0 / 500;
// Minimum sine of the angle between the directions to two beacons for a start: about 6 degrees.
constexpr double kMinSine = 0.1;
constexpr double kUnknownM = 1000;  // standard deviation at a start, before its two ranges are used
constexpr int kIterations = 4;      // iterations of an update; each squares the error of the linearisation
constexpr std::size_t kMaxWaiting = 16;  // ranges kept for a start

double gaussian(double normalised_square, double variance) {
  return elementary::exp(-0.5 * normalised_square) / std::sqrt(2 * std::numbers::pi * variance);
}

}  // namespace

PositionEstimator::PositionEstimator(EstimatorRules rules, std::optional<StatedStart> start)
    : rules_(rules), start_(start), clock_sigma_s_(rules.clock_offset_sigma_s) {
  for (const double value : {rules.drift_m_per_sqrt_s, rules.current_sigma_mps, rules.gate})
    require(std::isfinite(value) && value > 0, "a rule of the position estimator must be a number above 0");
  for (const double value : {rules.current_walk_mps_per_sqrt_s, rules.slip_m_per_sqrt_rad,
                             rules.depth_sigma_m, rules.clock_offset_sigma_s, rules.clock_drift_sigma,
                             rules.clock_walk_s_per_sqrt_s, rules.clock_gps_sigma_s})
    require(std::isfinite(value) && value >= 0, "a rule of the position estimator must be a number from 0");
  require(!start || start->sigma_m > 0, "a stated start needs a standard deviation above 0");
}

void PositionEstimator::move(const OwnMotion& motion) {
  const bool first = track_.empty();
  track_.take(motion);
  if (first && start_) {
    hypotheses_.push_back(hypothesis_at(start_->position_ne_m, start_->sigma_m, 1.0));
  }
  for (Hypothesis& hypothesis : hypotheses_) hypothesis = carried_on(hypothesis, track_.last());
  now_ = std::max(now_, track_.last());
}

PositionEstimator::Hypothesis PositionEstimator::hypothesis_at(const Vec2& position_ne_m, double sigma_m,
                                                               double weight) const {
  Hypothesis start{State::Zero(), Covariance::Zero(), weight};
  start.mean.head<2>() = position_ne_m;
  const double position = sigma_m * sigma_m, current = rules_.current_sigma_mps * rules_.current_sigma_mps;
  start.covariance.diagonal() << position, position, current, current;
  if (rules_.estimate_clock()) {
    start.clock_covariance.diagonal() << clock_sigma_s_ * clock_sigma_s_,
        rules_.clock_drift_sigma * rules_.clock_drift_sigma;
  }
  return start;
}

void PositionEstimator::set_clock() {
  if (!rules_.estimate_clock()) return;
  clock_sigma_s_ = rules_.clock_gps_sigma_s;
  waiting_.clear();
  for (Hypothesis& hypothesis : hypotheses_) {
    hypothesis.clock[0] = 0;
    hypothesis.cross.col(0).setZero();
    hypothesis.clock_covariance.row(0).setZero();
    hypothesis.clock_covariance.col(0).setZero();
    hypothesis.clock_covariance(0, 0) = clock_sigma_s_ * clock_sigma_s_;
  }
}

// Prediction of a hypothesis over the interval dt (Bar-Shalom, Li and Kirubarajan 2001, ch. 10), with
// position p, current c, and the clock's offset b and drift d:
//
//   p <- p + path through the water + c dt
//   b <- b + d dt
//   P <- F P F^T + Q,  F = [I, dt I; 0, I]
//   Q = diag(drift^2 dt + slip^2 |turn| for p, walk^2 dt for c)
//
// The clock's covariance and its cross covariance with the state are predicted likewise.
PositionEstimator::Hypothesis PositionEstimator::carried_on(const Hypothesis& from, SimTime at) const {
  if (at <= now_ || !track_.covers(now_)) return from;
  const double seconds = (at - now_).seconds();
  Covariance step = Covariance::Identity();
  step.topRightCorner<2, 2>() = seconds * Eigen::Matrix2d::Identity();
  Hypothesis to = from;
  to.mean = step * from.mean;
  to.mean.head<2>() += track_.gone_ne_m(at) - track_.gone_ne_m(now_);
  const double turned_rad = track_.turned_rad(at) - track_.turned_rad(now_);
  const double drift = rules_.drift_m_per_sqrt_s * rules_.drift_m_per_sqrt_s * seconds +
                       rules_.slip_m_per_sqrt_rad * rules_.slip_m_per_sqrt_rad * turned_rad;
  const double walk = rules_.current_walk_mps_per_sqrt_s * rules_.current_walk_mps_per_sqrt_s * seconds;
  to.covariance = step * from.covariance * step.transpose();
  to.covariance.diagonal() += State(drift, drift, walk, walk);
  Eigen::Matrix2d clock_step = Eigen::Matrix2d::Identity();
  clock_step(0, 1) = seconds;
  to.clock = clock_step * from.clock;
  to.cross = step * from.cross * clock_step.transpose();
  to.clock_covariance = clock_step * from.clock_covariance * clock_step.transpose();
  to.clock_covariance(0, 0) += rules_.clock_walk_s_per_sqrt_s * rules_.clock_walk_s_per_sqrt_s * seconds;
  return to;
}

// Expected length and its derivatives: the sum over the ways, each at its own instant t, of |p(t) - beacon| +
// k b(t) with
//
//   p(t) = p - path since t - c (now - t),  b(t) = b - d (now - t)
//
// and k the lengthening per second of clock offset.
PositionEstimator::Expected PositionEstimator::expected(const Hypothesis& hypothesis,
                                                        const RangeMeasurement& range) const {
  const State& state = hypothesis.mean;
  Expected sum{0, State::Zero(), 0, Clock::Zero()};
  for (const SimTime at : range.at) {
    const double back_s = (now_ - at).seconds();
    const Vec2 place =
        state.head<2>() - (track_.gone_ne_m(now_) - track_.gone_ne_m(at)) - back_s * state.tail<2>();
    const Vec3 from_beacon = Vec3(place.x(), place.y(), track_.depth_m(at)) - range.beacon_m;
    const double length = std::max(from_beacon.norm(), 1e-6);
    const Vec2 direction = from_beacon.head<2>() / length;
    sum.length_m += length;
    sum.gradient.head<2>() += direction;
    sum.gradient.tail<2>() -= back_s * direction;
    sum.per_depth += from_beacon.z() / length;
    sum.clock_gradient += range.per_clock_m_s * Clock(1, -back_s);
  }
  sum.length_m += sum.clock_gradient.dot(hypothesis.clock);
  return sum;
}

// Innovation variance of the range, with H the gradient by the state, k that by the clock, C their cross
// covariance and P_clock the clock's covariance:
//
//   v = H^T P H + sigma_range^2 + (dl/dz sigma_depth)^2 + 2 H^T C k + k^T P_clock k
double PositionEstimator::variance(const Hypothesis& hypothesis, const Expected& there,
                                   const RangeMeasurement& range) const {
  const double depth = there.per_depth * rules_.depth_sigma_m;
  const Clock& k = there.clock_gradient;
  return there.gradient.dot(hypothesis.covariance * there.gradient) + range.sigma_m * range.sigma_m +
         depth * depth +
         (2 * there.gradient.dot(hypothesis.cross * k) + k.dot(hypothesis.clock_covariance * k));
}

// Iterated update (Gauss-Newton): finds the state of maximum likelihood given the prediction and the range.
// The gain of the measurement h(x) with gradient H, for an iterate x_i that starts from the prediction x, P,
// is
//
//   v       = H^T P H + R
//   K       = P H / v
//   x_(i+1) = x + K (z - h(x_i) - H^T (x - x_i))
//
// with H taken at x_i. The clock's state and covariance are updated in the same way; the cross covariance
// couples the two.
void PositionEstimator::update(Hypothesis& hypothesis, const RangeMeasurement& range) const {
  const Hypothesis before = hypothesis;
  for (int i = 0; i < kIterations; ++i) {
    const Expected there = expected(hypothesis, range);
    const double v = variance(before, there, range);
    const State gain = (before.covariance * there.gradient + before.cross * there.clock_gradient) / v;
    const Clock clock_gain =
        (before.cross.transpose() * there.gradient + before.clock_covariance * there.clock_gradient) / v;
    const double off = range.length_m - there.length_m - there.gradient.dot(before.mean - hypothesis.mean) -
                       there.clock_gradient.dot(before.clock - hypothesis.clock);
    hypothesis.mean = before.mean + gain * off;
    hypothesis.covariance = before.covariance - v * gain * gain.transpose();
    hypothesis.clock = before.clock + clock_gain * off;
    hypothesis.cross = before.cross - v * gain * clock_gain.transpose();
    hypothesis.clock_covariance = before.clock_covariance - v * clock_gain * clock_gain.transpose();
  }
  hypothesis.covariance = (0.5 * (hypothesis.covariance + hypothesis.covariance.transpose())).eval();
}

// Updates weight and state of a hypothesis by a range. Returns true when the range moved the state: an
// outlier only lowers the weight. With p_o the share of outliers, f_o their density and N the normal density
// of the innovation:
//
//   weight <- weight (p_o f_o + (1 - p_o) N(innovation; v)),  the second term only within the gate
bool PositionEstimator::weigh(Hypothesis& hypothesis, const RangeMeasurement& range) const {
  const Expected there = expected(hypothesis, range);
  const double v = variance(hypothesis, there, range);
  const double off = range.length_m - there.length_m;
  const double normalised = off * off / v;
  const bool fits = normalised <= rules_.gate * rules_.gate;
  hypothesis.weight *=
      kOutlierShare * kOutlierDensityPerM + (fits ? (1 - kOutlierShare) * gaussian(normalised, v) : 0);
  if (fits) update(hypothesis, range);
  return fits;
}

RangeVerdict PositionEstimator::take(const RangeMeasurement& range) {
  require(!range.at.empty() && range.sigma_m > 0,
          "a range needs an instant and a standard deviation above 0");
  if (!std::all_of(range.at.begin(), range.at.end(), [&](SimTime at) { return track_.covers(at); }))
    return RangeVerdict::kTooOld;
  const SimTime latest = *std::max_element(range.at.begin(), range.at.end());
  if (latest > now_) {
    for (Hypothesis& hypothesis : hypotheses_) hypothesis = carried_on(hypothesis, latest);
    now_ = latest;
  }
  if (hypotheses_.empty()) {
    start_from_ranges(range);
    return hypotheses_.empty() ? RangeVerdict::kWaiting : RangeVerdict::kUsed;
  }
  bool used = false;
  for (Hypothesis& hypothesis : hypotheses_) used = weigh(hypothesis, range) || used;
  drop_unlikely();
  misfits_in_a_row_ = used ? 0 : misfits_in_a_row_ + 1;
  if (misfits_in_a_row_ >= kMaxMisfits) {
    hypotheses_.clear();
    misfits_in_a_row_ = 0;
  }
  return used ? RangeVerdict::kUsed : RangeVerdict::kOutlier;
}

void PositionEstimator::drop_unlikely() {
  std::stable_sort(hypotheses_.begin(), hypotheses_.end(),
                   [](const Hypothesis& a, const Hypothesis& b) { return a.weight > b.weight; });
  const Hypothesis best = hypotheses_.front();
  const Eigen::Matrix2d information = best.covariance.topLeftCorner<2, 2>().inverse();
  // Hypotheses within a standard deviation of the best one are the same position.
  const auto goes = [&](const Hypothesis& other) {
    const Vec2 apart = (other.mean - best.mean).head<2>();
    return other.weight < kForgotten * best.weight || apart.dot(information * apart) < 1;
  };
  hypotheses_.erase(std::remove_if(hypotheses_.begin() + 1, hypotheses_.end(), goes), hypotheses_.end());
  double sum = 0;
  for (const Hypothesis& hypothesis : hypotheses_) sum += hypothesis.weight;
  for (Hypothesis& hypothesis : hypotheses_) hypothesis.weight /= sum;
}

void PositionEstimator::start_from_ranges(const RangeMeasurement& latest) {
  const auto forgotten = [&](const RangeMeasurement& range) { return !track_.covers(range.at.front()); };
  waiting_.erase(std::remove_if(waiting_.begin(), waiting_.end(), forgotten), waiting_.end());
  for (auto other = waiting_.rbegin(); other != waiting_.rend() && hypotheses_.empty(); ++other) {
    if (other->beacon_m.head<2>() != latest.beacon_m.head<2>()) add_crossings(*other, latest);
  }
  waiting_.push_back(latest);
  if (waiting_.size() > kMaxWaiting) waiting_.erase(waiting_.begin());
  if (!hypotheses_.empty()) waiting_.clear();
}

// Adds a hypothesis at each crossing of two circles, the loci of the vehicle by one range each. A circle's
// centre is the beacon, shifted by the vehicle's path since the range was measured.
void PositionEstimator::add_crossings(const RangeMeasurement& one, const RangeMeasurement& other) {
  struct Circle {
    Vec2 centre = Vec2::Zero();
    double radius = 0;
  };
  const auto circle_of = [&](const RangeMeasurement& range) {
    const auto ways = static_cast<double>(range.at.size());
    Circle circle{range.beacon_m.head<2>(), 0};
    double below = 0;
    for (const SimTime at : range.at) {
      circle.centre += (track_.gone_ne_m(now_) - track_.gone_ne_m(at)) / ways;
      below += (track_.depth_m(at) - range.beacon_m.z()) / ways;
    }
    const double slant = range.length_m / ways;
    circle.radius = std::sqrt(std::max(slant * slant - below * below, 0.0));
    return circle;
  };
  const Circle a = circle_of(one), b = circle_of(other);
  const Vec2 line = b.centre - a.centre;
  const double apart = line.norm();
  if (apart <= 0 || a.radius <= 0 || b.radius <= 0) return;
  const double along = (a.radius * a.radius - b.radius * b.radius + apart * apart) / (2 * apart);
  const double across_square = a.radius * a.radius - along * along;
  // sin(angle between the two directions) = 2 (area of the triangle) / (r_a r_b)
  if (across_square <= 0 || std::sqrt(across_square) * apart < kMinSine * a.radius * b.radius) return;
  const Vec2 unit = line / apart;
  for (const double side : {-1.0, 1.0}) {
    const Vec2 crossing =
        a.centre + along * unit + side * std::sqrt(across_square) * Vec2(-unit.y(), unit.x());
    Hypothesis start = hypothesis_at(crossing, kUnknownM, 0.5);
    update(start, one);
    update(start, other);
    hypotheses_.push_back(start);
  }
}

std::optional<PositionEstimate> PositionEstimator::estimate(SimTime at) const {
  if (hypotheses_.empty()) return std::nullopt;
  const Hypothesis best = carried_on(hypotheses_.front(), at);
  return PositionEstimate{
      best.mean.head<2>(),   best.mean.tail<2>(), best.covariance.topLeftCorner<2, 2>(), best.clock,
      best.clock_covariance, best.weight,         static_cast<int>(hypotheses_.size())};
}

}  // namespace halocline::clients
