// SPDX-License-Identifier: BSD-3-Clause
// Position estimator: ranges to beacons at known positions fused with the vehicle's own speed, heading and
// depth.
//
// Model: an extended Kalman filter (Bar-Shalom, Li and Kirubarajan 2001, ch. 10; updates iterated as in
// 10.5.2) over horizontal position and current, [north, east, current north, current east]. Between ranges
// the vehicle goes by dead reckoning plus the current; both wander as random walks. Depth below the sea
// surface is measured and no part of the state. A
// range is the length of one way (a stamped packet) or the sum of two (a ping and its answer), each from
// where the vehicle was at that way's own instant, which may lie seconds back:
//   sum over ways of |p(t) - beacon|,  p(t) = p(now) - (gone through the water since t) - current (now - t)
//
// With a clock_offset_sigma_s above 0 the offset b and the drift d of the vehicle's clock are part of the
// state, too: one way by a stamped packet is c b(t) longer, c the sound speed, b(t) = b(now) - d (now - t);
// the sum of two is not. b wanders as a random walk. Beacons keep the right time. Position and clock can be
// told apart when ranges come from beacons on several sides, or with pings among them; otherwise their
// covariance stays large.
//
// Two beacons leave a mirror image of the vehicle beyond the line through them. Without a stated start the
// filter starts from two ranges to two beacons, with one hypothesis on either side; each goes by the same
// dead reckoning, and each range weighs them by how well it fits, until one has kForgotten of the other's
// weight. A course along that very line leaves both sides possible; with it, the start has to be stated.
//
// A range farther from what a hypothesis expects than `gate` standard deviations is an outlier to it: it does
// not move it, and costs weight. After kMaxMisfits such ranges in a row to all hypotheses the filter starts
// anew.
//
// Holds where errors of range and dead reckoning are white and ranges are long against the position's error;
// errors common to all ranges (of sound speed, of a beacon's place) are not in the covariance. Pure and not
// thread-safe.
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "clients/localiser/dead_reckoning.h"
#include "core/archive.h"
#include "core/frames.h"
#include "core/sim_time.h"

namespace halocline::clients {

struct EstimatorRules {
  double drift_m_per_sqrt_s = 0.05;             // of dead reckoning: random walk of the position
  double slip_m_per_sqrt_rad = 2;               // likewise in turns, by the angle turned
  double current_sigma_mps = 0.2;               // of each component, before anything is known
  double current_walk_mps_per_sqrt_s = 0.0005;  // how it changes
  double depth_sigma_m = 0.1;
  double gate = 4;                     // standard deviations; of sound ranges 1 in 16 000 lies beyond 4
  double clock_offset_sigma_s = 0;     // of the vehicle's clock, before anything is known; 0: it is right
  double clock_drift_sigma = 1e-6;     // likewise, s/s
  double clock_walk_s_per_sqrt_s = 0;  // random walk of its offset
  double clock_gps_sigma_s = 1e-6;     // of its offset when GPS has set it

  bool estimate_clock() const { return clock_offset_sigma_s > 0; }
};

// A start that is known beforehand.
struct StatedStart {
  Vec2 position_ne_m = Vec2::Zero();
  double sigma_m = 10;  // of each component, above 0
};

struct RangeMeasurement {
  Vec3 beacon_m = Vec3::Zero();  // north, east, depth below the sea surface
  std::vector<SimTime> at;       // when the vehicle was at the end of each way: one or two instants
  double length_m = 0;           // of the ways together
  double sigma_m = 1;            // likewise, above 0
  double per_clock_m_s =
      0;  // by how much a clock that is a second ahead lengthens it: c of one way, 0 of two

  void archive(Archive& a) { a(beacon_m, at, length_m, sigma_m, per_clock_m_s); }
};

enum class RangeVerdict {
  kUsed,     // by at least one hypothesis
  kOutlier,  // by none
  kWaiting,  // there is no estimate yet to judge it by
  kTooOld,   // before the history of the dead reckoning
};

struct PositionEstimate {
  Vec2 position_ne_m = Vec2::Zero();
  Vec2 current_ne_mps = Vec2::Zero();
  Eigen::Matrix2d position_covariance_m2 = Eigen::Matrix2d::Zero();
  Eigen::Vector2d clock = Eigen::Vector2d::Zero();  // offset, s, and drift, s/s, of the vehicle's clock
  Eigen::Matrix2d clock_covariance = Eigen::Matrix2d::Zero();
  double weight = 1;  // of this hypothesis among all, 0.5..1
  int hypotheses = 1;
};

class PositionEstimator {
 public:
  static constexpr double kForgotten = 1e-3;
  static constexpr int kMaxMisfits = 8;

  // Throws InvalidArgument when a rule or the start is no number above 0.
  explicit PositionEstimator(EstimatorRules rules, std::optional<StatedStart> start = {});

  // What the vehicle measures of itself, in the order of time.
  void move(const OwnMotion& motion);
  // A range, as soon as it is known.
  [[nodiscard]] RangeVerdict take(const RangeMeasurement& range);
  // GPS has set the vehicle's clock by now.
  void set_clock();
  // The best hypothesis as of `at`, which is not before the last motion; empty before there is one.
  std::optional<PositionEstimate> estimate(SimTime at) const;

  const DeadReckoning& dead_reckoning() const { return track_; }

  void archive(Archive& a) { a(track_, now_, clock_sigma_s_, hypotheses_, waiting_, misfits_in_a_row_); }

 private:
  using State = Eigen::Vector4d;
  using Covariance = Eigen::Matrix4d;
  using Clock = Eigen::Vector2d;  // offset, drift
  using Cross = Eigen::Matrix<double, 4, 2>;
  // Of a clock that is not estimated all is 0.
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
    State gradient;        // of the length
    double per_depth;      // likewise, for the depth
    Clock clock_gradient;  // likewise, for the clock
  };

  Hypothesis carried_on(const Hypothesis& from, SimTime at) const;
  Hypothesis hypothesis_at(const Vec2& position_ne_m, double sigma_m, double weight) const;
  Expected expected(const Hypothesis& hypothesis, const RangeMeasurement& range) const;
  // Of the measured length about the one that is expected.
  double variance(const Hypothesis& hypothesis, const Expected& there, const RangeMeasurement& range) const;
  [[nodiscard]] bool weigh(Hypothesis& hypothesis, const RangeMeasurement& range) const;
  void update(Hypothesis& hypothesis, const RangeMeasurement& range) const;
  void drop_unlikely();
  void start_from_ranges(const RangeMeasurement& latest);
  void add_crossings(const RangeMeasurement& one, const RangeMeasurement& other);

  EstimatorRules rules_;
  std::optional<StatedStart> start_;
  DeadReckoning track_;
  SimTime now_;                            // of the hypotheses
  double clock_sigma_s_;                   // of the clock's offset at a start
  std::vector<Hypothesis> hypotheses_;     // the weightiest first
  std::vector<RangeMeasurement> waiting_;  // for a start
  int misfits_in_a_row_ = 0;
};

}  // namespace halocline::clients
