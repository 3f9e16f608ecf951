// SPDX-License-Identifier: BSD-3-Clause
// Position estimator: fuses ranges to beacons at known positions with the vehicle's own speed, heading and
// depth.
//
// Model: an extended Kalman filter (Bar-Shalom, Li and Kirubarajan 2001, ch. 10; updates iterated as in
// 10.5.2) with the state
//
//   [north, east, current north, current east]
//
// Between ranges the position moves by dead reckoning plus the current; position and current have process
// noise of random walks. The depth below the sea surface is measured and not part of the state. A range is
// the length of one way (a stamped packet) or the sum of two (a ping and its reply), each from the vehicle's
// position at that way's own instant t, which may lie seconds back:
//
//   range = sum over ways of |p(t) - beacon|
//   p(t)  = p(now) - (path through the water from t to now) - current (now - t)
//
// With a clock_offset_sigma_s above 0, the offset b and the drift d of the vehicle's clock are part of the
// state, too. A one-way range by a stamped packet is then longer by
//
//   c b(t),  b(t) = b(now) - d (now - t),  c the sound speed
//
// while the sum of two ways does not depend on the clock. b has process noise of a random walk. The clocks of
// the beacons are taken to be right. Position and clock are observable together when ranges come from beacons
// on several sides, or when pings are among them; otherwise their covariance remains large.
//
// Two beacons leave an ambiguity: the mirror image of the vehicle in the line through them. Without a stated
// start the filter starts from two ranges to two beacons, with one hypothesis on either side. All hypotheses
// move by the same dead reckoning, and each range weights them by their likelihood, until one has less than
// kForgotten of the other's weight. A course along that very line leaves both sides possible; the start then
// has to be stated.
//
// A range that differs from the one a hypothesis expects by more than `gate` standard deviations is an
// outlier to that hypothesis: it lowers the weight and does not change the state. After kMaxMisfits ranges in
// a row that are outliers to all hypotheses, the filter starts again from ranges.
//
// The model holds where the errors of ranges and dead reckoning are white and ranges are long compared with
// the position error. Errors common to all ranges (of the sound speed, of a beacon's position) are not in the
// covariance. Pure, not thread-safe.
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "clients/onboard/localiser/dead_reckoning.h"
#include "core/archive.h"
#include "core/frames.h"
#include "core/sim_time.h"

namespace halocline::clients {

struct EstimatorRules {
  double drift_m_per_sqrt_s = 0.05;             // random walk of the position, error of dead reckoning
  double slip_m_per_sqrt_rad = 2;               // additional random walk in turns, by the angle turned
  double current_sigma_mps = 0.2;               // prior standard deviation of each component
  double current_walk_mps_per_sqrt_s = 0.0005;  // random walk of the current
  double depth_sigma_m = 0.1;
  double gate = 4;                     // standard deviations; of correct ranges 1 in 16 000 lies beyond 4
  double clock_offset_sigma_s = 0;     // prior standard deviation of the clock's offset; 0: it is right
  double clock_drift_sigma = 1e-6;     // s/s, prior standard deviation of the clock's drift
  double clock_walk_s_per_sqrt_s = 0;  // random walk of the clock's offset
  double clock_gps_sigma_s = 1e-6;     // deviation of the clock's offset after GPS has set it

  bool estimate_clock() const { return clock_offset_sigma_s > 0; }
};

// Starting position that is known beforehand.
struct StatedStart {
  Vec2 position_ne_m = Vec2::Zero();
  double sigma_m = 10;  // standard deviation of each component, above 0
};

struct RangeMeasurement {
  Vec3 beacon_m = Vec3::Zero();  // north, east, depth below the sea surface
  std::vector<SimTime> at;       // instants at which the vehicle was at its end of each way: one or two
  double length_m = 0;           // sum over the ways
  double sigma_m = 1;            // standard deviation of length_m, above 0
  // Lengthening per second by which the vehicle's clock is ahead: the sound speed for one way, 0 for two.
  double per_clock_m_s = 0;

  void archive(Archive& a) { a(beacon_m, at, length_m, sigma_m, per_clock_m_s); }
};

enum class RangeVerdict {
  kUsed,     // at least one hypothesis was updated
  kOutlier,  // an outlier to all hypotheses
  kWaiting,  // kept for a start: there is no hypothesis yet
  kTooOld,   // before the history of dead reckoning
};

struct PositionEstimate {
  Vec2 position_ne_m = Vec2::Zero();
  Vec2 current_ne_mps = Vec2::Zero();
  Eigen::Matrix2d position_covariance_m2 = Eigen::Matrix2d::Zero();
  Eigen::Vector2d clock = Eigen::Vector2d::Zero();  // offset, s, and drift, s/s, of the vehicle's clock
  Eigen::Matrix2d clock_covariance = Eigen::Matrix2d::Zero();
  double weight = 1;   // weight of this hypothesis among all, 0.5 to 1
  int hypotheses = 1;  // number of hypotheses left
};

class PositionEstimator {
 public:
  static constexpr double kForgotten = 1e-3;
  static constexpr int kMaxMisfits = 8;

  // Throws InvalidArgument when a rule or the start's deviation is out of its range.
  explicit PositionEstimator(EstimatorRules rules, std::optional<StatedStart> start = {});

  // Adds a measurement of the vehicle's own motion. Measurements must come in order of time.
  void move(const OwnMotion& motion);
  // Adds a range; ranges may come in any order, within the history of dead reckoning.
  [[nodiscard]] RangeVerdict take(const RangeMeasurement& range);
  // Sets the clock's offset to 0, with the deviation clock_gps_sigma_s: GPS has just set the vehicle's clock.
  void set_clock();
  // Returns the best hypothesis at `at`, which is not before the last motion; empty before there is one.
  std::optional<PositionEstimate> estimate(SimTime at) const;

  const DeadReckoning& dead_reckoning() const { return track_; }

  void archive(Archive& a) { a(track_, now_, clock_sigma_s_, hypotheses_, waiting_, misfits_in_a_row_); }

 private:
  using State = Eigen::Vector4d;
  using Covariance = Eigen::Matrix4d;
  using Clock = Eigen::Vector2d;  // offset, drift
  using Cross = Eigen::Matrix<double, 4, 2>;
  // Hypothesis of the vehicle's position. The clock's values stay 0 when the clock is not estimated.
  struct Hypothesis {
    State mean;
    Covariance covariance;
    double weight;
    Clock clock = Clock::Zero();
    Cross cross = Cross::Zero();  // covariance of state and clock
    Eigen::Matrix2d clock_covariance = Eigen::Matrix2d::Zero();
    void archive(Archive& a) { a(mean, covariance, weight, clock, cross, clock_covariance); }
  };
  struct Expected {
    double length_m;
    State gradient;        // derivative of the length by the state
    double per_depth;      // derivative by the depth
    Clock clock_gradient;  // derivative by the clock
  };

  Hypothesis carried_on(const Hypothesis& from, SimTime at) const;
  Hypothesis hypothesis_at(const Vec2& position_ne_m, double sigma_m, double weight) const;
  Expected expected(const Hypothesis& hypothesis, const RangeMeasurement& range) const;
  // Returns the variance of the innovation, measured minus expected length, m^2.
  double variance(const Hypothesis& hypothesis, const Expected& there, const RangeMeasurement& range) const;
  [[nodiscard]] bool weigh(Hypothesis& hypothesis, const RangeMeasurement& range) const;
  void update(Hypothesis& hypothesis, const RangeMeasurement& range) const;
  void drop_unlikely();
  void start_from_ranges(const RangeMeasurement& latest);
  void add_crossings(const RangeMeasurement& one, const RangeMeasurement& other);

  EstimatorRules rules_;
  std::optional<StatedStart> start_;
  DeadReckoning track_;
  SimTime now_;                            // instant at which the hypotheses hold
  double clock_sigma_s_;                   // deviation of the clock's offset at a start
  std::vector<Hypothesis> hypotheses_;     // in descending order of weight
  std::vector<RangeMeasurement> waiting_;  // ranges kept for a start
  int misfits_in_a_row_ = 0;
};

}  // namespace halocline::clients
