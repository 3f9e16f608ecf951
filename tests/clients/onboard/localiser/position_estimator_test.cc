// SPDX-License-Identifier: BSD-3-Clause
#include "clients/onboard/localiser/position_estimator.h"

#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "core/check.h"
#include "core/random.h"

namespace halocline::clients {
namespace {

using std::numbers::pi;
const Vec3 kWest(0, 0, 50), kEast(0, 1000, 50);
constexpr double kDepthM = 30, kSoundMps = 1500;

// A vehicle that moves by the estimator's model: by its speed and heading, a constant current and a random
// walk, all drawn from what the rules state.
struct Voyage {
  std::uint64_t number = 0;
  Vec2 start{600, 300};
  double start_sigma_m = 0;  // of the stated start, whose error is drawn; 0: none is stated
  double speed_mps = 1.5;
  double seconds = 300;
  double range_sigma_m = 1;
  bool two_way = false;
  EstimatorRules rules = {};
  std::function<double(double)> heading_rad = [](double t) { return 2.0 + 0.8 * std::sin(t / 40); };
  std::function<double(int)> blunder_m = [](int) { return 0.0; };  // added to the n-th range
};

struct End {
  std::optional<PositionEstimate> estimate;
  Vec2 truth = Vec2::Zero(), current = Vec2::Zero();
  Eigen::Vector2d clock = Eigen::Vector2d::Zero();  // true offset and drift
  int outliers = 0, used = 0;
  double error_m() const { return (estimate->position_ne_m - truth).norm(); }
  double normalised_square() const {
    const Vec2 error = estimate->position_ne_m - truth;
    return error.dot(estimate->position_covariance_m2.inverse() * error);
  }
  double normalised_square_of_clock() const {
    const Eigen::Vector2d error = estimate->clock - clock;
    return error.dot(estimate->clock_covariance.inverse() * error);
  }
};

class Draws {
 public:
  explicit Draws(std::uint64_t voyage) : voyage_(voyage) {}
  double next() { return normal_at({77, purpose_of("localiser-test"), 0, voyage_ * 100'000 + count_++}); }
  Vec2 pair(double sigma) {
    const double a = next();
    return sigma * Vec2(a, next());
  }

 private:
  std::uint64_t voyage_, count_ = 0;
};

class Sailing {
 public:
  explicit Sailing(const Voyage& voyage)
      : v_(voyage), draws_(voyage.number), estimator_(voyage.rules, stated_start()), truth_(voyage.start) {
    current_ = draws_.pair(v_.rules.current_sigma_mps);
    if (v_.rules.estimate_clock()) {
      clock_[0] = v_.rules.clock_offset_sigma_s * draws_.next();
      clock_[1] = v_.rules.clock_drift_sigma * draws_.next();
    }
  }

  End sail() {
    constexpr int kStepsPerSecond = 2;
    const double dt = 1.0 / kStepsPerSecond;
    for (int i = 0; i <= v_.seconds * kStepsPerSecond; ++i) {
      const double t = i * dt;
      if (i > 0) step(t - dt, dt);
      estimator_.move({SimTime::from_seconds(t), v_.speed_mps, v_.heading_rad(t), 0, kDepthM});
      trace_.push_back(truth_);
      constexpr int kEverySteps = 10;
      if (i % kEverySteps == 4) measure(i, dt);
    }
    end_.estimate = estimator_.estimate(SimTime::from_seconds(v_.seconds));
    end_.truth = truth_;
    end_.current = current_;
    end_.clock = clock_;
    return end_;
  }

 private:
  std::optional<StatedStart> stated_start() {
    if (v_.start_sigma_m <= 0) return std::nullopt;
    return StatedStart{v_.start + draws_.pair(v_.start_sigma_m), v_.start_sigma_m};
  }
  void step(double t, double dt) {
    const auto velocity = [&](double s) -> Vec2 {
      return v_.speed_mps * Vec2(std::cos(v_.heading_rad(s)), std::sin(v_.heading_rad(s)));
    };
    const double turned_rad = std::abs(v_.heading_rad(t + dt) - v_.heading_rad(t));
    truth_ += 0.5 * dt * (velocity(t) + velocity(t + dt)) + dt * current_ +
              draws_.pair(v_.rules.drift_m_per_sqrt_s * std::sqrt(dt)) +
              draws_.pair(v_.rules.slip_m_per_sqrt_rad * std::sqrt(turned_rad));
    current_ += draws_.pair(v_.rules.current_walk_mps_per_sqrt_s * std::sqrt(dt));
    if (!v_.rules.estimate_clock()) return;
    clock_[0] += clock_[1] * dt + v_.rules.clock_walk_s_per_sqrt_s * std::sqrt(dt) * draws_.next();
  }
  double way(int i, const Vec3& beacon) const {
    const Vec2& p = trace_.at(static_cast<std::size_t>(i));
    return (Vec3(p.x(), p.y(), kDepthM) - beacon).norm();
  }
  void measure(int i, double dt) {
    RangeMeasurement range;
    range.beacon_m = ranges_ % 2 == 0 ? kWest : kEast;
    const int first = v_.two_way ? i - 3 : i;
    range.at.push_back(SimTime::from_seconds(first * dt));
    range.length_m = way(first, range.beacon_m);
    if (v_.two_way) {
      range.at.push_back(SimTime::from_seconds(i * dt));
      range.length_m += way(i, range.beacon_m);
    } else if (v_.rules.estimate_clock()) {
      range.per_clock_m_s = kSoundMps;
      range.length_m += kSoundMps * clock_[0];
    }
    range.sigma_m = v_.range_sigma_m;
    range.length_m += v_.range_sigma_m * draws_.next() + v_.blunder_m(ranges_);
    const RangeVerdict verdict = estimator_.take(range);
    end_.outliers += verdict == RangeVerdict::kOutlier;
    end_.used += verdict == RangeVerdict::kUsed;
    ++ranges_;
  }

  const Voyage v_;
  Draws draws_;
  PositionEstimator estimator_;
  Vec2 truth_, current_ = Vec2::Zero();
  Eigen::Vector2d clock_ = Eigen::Vector2d::Zero();
  std::vector<Vec2> trace_;
  int ranges_ = 0;
  End end_;
};

End sail(const Voyage& voyage) { return Sailing(voyage).sail(); }

// The normalised squared errors of many voyages: chi-squared with two degrees of freedom each when the
// covariance is its covariance. Over n voyages their sum has mean 2 n and variance 4 n; the share beyond 3
// sigma (11.83) is 0.27 %.
void expect_honest(Voyage voyage) {
  constexpr int kVoyages = 400;
  double sum = 0;
  int beyond = 0, unresolved = 0;
  for (int n = 0; n < kVoyages; ++n) {
    voyage.number = static_cast<std::uint64_t>(n);
    const End end = sail(voyage);
    ASSERT_TRUE(end.estimate.has_value()) << n;
    unresolved += end.estimate->hypotheses > 1;
    sum += end.normalised_square();
    beyond += end.normalised_square() > 11.83;
  }
  // 4 standard deviations of the mean: 1 in 16 000; of 400 draws of 0.27 %, more than 6 come 1 in 4000 times.
  EXPECT_NEAR(sum / kVoyages, 2.0, 4 * std::sqrt(4.0 / kVoyages));
  EXPECT_LE(beyond, 6);
  EXPECT_EQ(unresolved, 0);
}

TEST(PositionEstimator, ErrorMatchesItsCovarianceFromAStatedStart) { expect_honest({.start_sigma_m = 10}); }

TEST(PositionEstimator, ErrorMatchesItsCovarianceWithPings) {
  expect_honest({.start_sigma_m = 10, .range_sigma_m = 2, .two_way = true});
}

// Normalised squared errors of position and of clock are chi-squared with two degrees of freedom each, as
// above.
TEST(PositionEstimator, ErrorsOfPositionAndClockMatchTheirCovariancesWithOneWayRanges) {
  constexpr int kVoyages = 400;
  Voyage voyage{.start_sigma_m = 10,
                .seconds = 600,
                .rules = {.current_sigma_mps = 0.1,
                          .clock_offset_sigma_s = 0.02,
                          .clock_drift_sigma = 1e-5,
                          .clock_walk_s_per_sqrt_s = 1e-6}};
  double position = 0, clock = 0;
  for (int n = 0; n < kVoyages; ++n) {
    voyage.number = static_cast<std::uint64_t>(n);
    const End end = sail(voyage);
    ASSERT_TRUE(end.estimate.has_value()) << n;
    position += end.normalised_square() / kVoyages;
    clock += end.normalised_square_of_clock() / kVoyages;
    // Of 30 m of offset at the start less than a third is left.
    EXPECT_LT(kSoundMps * std::sqrt(end.estimate->clock_covariance(0, 0)), 10.0) << n;
  }
  EXPECT_NEAR(position, 2.0, 4 * std::sqrt(4.0 / kVoyages));
  EXPECT_NEAR(clock, 2.0, 4 * std::sqrt(4.0 / kVoyages));
}

// The sum of two ways does not depend on the clock.
TEST(PositionEstimator, PingsTellNothingOfTheClock) {
  const Voyage voyage{.start_sigma_m = 10, .two_way = true, .rules = {.clock_offset_sigma_s = 0.02}};
  const End end = sail(voyage);
  // The drift of 1e-6 has added its part over 300 s.
  EXPECT_NEAR(std::sqrt(end.estimate->clock_covariance(0, 0)), std::hypot(0.02, 300e-6), 1e-9);
  EXPECT_EQ(end.estimate->clock[0], 0);
}

TEST(PositionEstimator, AClockThatGpsHasSetIsKnownToItsResidual) {
  PositionEstimator estimator({.clock_offset_sigma_s = 1, .clock_gps_sigma_s = 1e-6},
                              StatedStart{{0, 0}, 10});
  estimator.move({SimTime(), 0, 0, 0, 50});
  EXPECT_EQ(estimator.estimate(SimTime())->clock_covariance(0, 0), 1);
  estimator.set_clock();
  EXPECT_NEAR(estimator.estimate(SimTime())->clock_covariance(0, 0), 1e-12, 1e-18);
  // The drift, of 1e-6, goes on: 1 us after a second.
  EXPECT_NEAR(estimator.estimate(SimTime::from_seconds(1))->clock_covariance(0, 0), 2e-12, 1e-17);
}

// No start is stated: of the two mirror images of the start the motion has to choose.
TEST(PositionEstimator, FindsItsSideOfTheBeaconsByItsMotion) {
  expect_honest({.rules = {.current_sigma_mps = 0.1}});
}

TEST(PositionEstimator, FindsTheOtherSideLikewise) {
  expect_honest({.start = {-600, 300}, .rules = {.current_sigma_mps = 0.1}});
}

// Along the line through the beacons both images fit every range equally well, and neither is forgotten. The
// current is known here: an unknown one that sets across the line would distinguish the sides.
TEST(PositionEstimator, KeepsTwoHypothesesOnACourseAlongTheBeacons) {
  Voyage voyage{.start = {300, 200}, .rules = {.drift_m_per_sqrt_s = 1e-4, .current_sigma_mps = 1e-6}};
  voyage.heading_rad = [](double) { return pi / 2; };
  const End end = sail(voyage);
  ASSERT_TRUE(end.estimate.has_value());
  EXPECT_EQ(end.estimate->hypotheses, 2);
  EXPECT_NEAR(std::abs(end.estimate->position_ne_m.x()), std::abs(end.truth.x()), 5);
  EXPECT_LT(end.estimate->weight, 0.9);
}

TEST(PositionEstimator, TakesTheStatedSideOnThatCourse) {
  for (std::uint64_t n = 0; n < 20; ++n) {
    Voyage voyage{.number = n, .start = {300, 200}, .start_sigma_m = 20};
    voyage.rules.current_sigma_mps = 0.1;
    voyage.heading_rad = [](double) { return pi / 2; };
    const End end = sail(voyage);
    EXPECT_EQ(end.estimate->hypotheses, 1);
    EXPECT_LT(end.normalised_square(), 18.4) << n;  // 1 in 10 000 each
  }
}

TEST(PositionEstimator, MeasuresTheCurrent) {
  Voyage voyage{.start_sigma_m = 5, .seconds = 900, .rules = {.current_walk_mps_per_sqrt_s = 0}};
  const End end = sail(voyage);
  EXPECT_LT((end.estimate->current_ne_mps - end.current).norm(), 0.02);
}

// Two perpendicular ranges of 1 m each, and nothing else: the covariance is theirs.
TEST(PositionEstimator, CovarianceOfTwoCrossingRangesIsThatOfTheGeometry) {
  PositionEstimator estimator({}, StatedStart{{500, 500}, 1000});
  estimator.move({SimTime(), 0, 0, 0, 50});
  const double length = std::hypot(500, 500);
  EXPECT_EQ(estimator.take({kWest, {SimTime()}, length, 1}), RangeVerdict::kUsed);
  EXPECT_EQ(estimator.take({kEast, {SimTime()}, length, 1}), RangeVerdict::kUsed);
  const auto estimate = estimator.estimate(SimTime());
  ASSERT_TRUE(estimate.has_value());
  EXPECT_LT((estimate->position_ne_m - Vec2(500, 500)).norm(), 1e-3);
  // In directions at 45 degrees each range fixes one; both have 1 m^2, less the start's one in a million.
  EXPECT_TRUE(estimate->position_covariance_m2.isApprox(Eigen::Matrix2d::Identity(), 1e-5));
}

TEST(PositionEstimator, ErrorGrowsWhereTheBeaconsLieInOneDirection) {
  Voyage abeam{.start = {500, 500}, .start_sigma_m = 10, .speed_mps = 0};
  Voyage in_line{.start = {20, 2500}, .start_sigma_m = 10, .speed_mps = 0};
  const Eigen::Matrix2d good = sail(abeam).estimate->position_covariance_m2;
  const Eigen::Matrix2d poor = sail(in_line).estimate->position_covariance_m2;
  EXPECT_GT(poor(0, 0), 25 * good(0, 0));  // across the line: hardly measured
  EXPECT_LT(poor(1, 1), 4 * good(1, 1));   // along it: as well as ever
}

// Every seventh range is an echo, 40 m late.
TEST(PositionEstimator, LeavesOutRangesThatDoNotFit) {
  Voyage voyage{.start_sigma_m = 10};
  voyage.blunder_m = [](int n) { return n % 7 == 6 ? 40.0 : 0.0; };
  const End end = sail(voyage), clean = sail({.start_sigma_m = 10});
  EXPECT_EQ(end.outliers, 60 / 7);
  EXPECT_EQ(clean.outliers, 0);
  EXPECT_LT(end.normalised_square(), 11.83);
}

// The stated start is 2 km off, so that no range fits; what the filter then finds by itself is right.
TEST(PositionEstimator, StartsAnewWhenNothingFits) {
  PositionEstimator estimator({.current_sigma_mps = 0.05}, StatedStart{{2600, 300}, 1});
  Vec2 truth(600, 300);
  for (int i = 0; i < 60; ++i) {
    const SimTime now = SimTime::from_seconds(5.0 * i);
    const double heading = i < 30 ? pi : pi / 2;
    estimator.move({now, 1.5, heading, 0, kDepthM});
    if (i == 30) truth += Vec2(3.75, -3.75);  // the turn, by the trapezium rule
    const Vec3& beacon = i % 2 == 0 ? kWest : kEast;
    EXPECT_NE(estimator.take({beacon, {now}, (Vec3(truth.x(), truth.y(), kDepthM) - beacon).norm(), 1}),
              RangeVerdict::kTooOld);
    truth += 7.5 * Vec2(std::cos(heading), std::sin(heading));
  }
  const auto estimate = estimator.estimate(SimTime::from_seconds(300.0));
  ASSERT_TRUE(estimate.has_value());
  EXPECT_LT((estimate->position_ne_m - truth).norm(), 5);
}

TEST(PositionEstimator, HasNoEstimateBeforeRangesToTwoBeacons) {
  PositionEstimator estimator({});
  EXPECT_EQ(estimator.take({kWest, {SimTime()}, 500, 1}), RangeVerdict::kTooOld);
  estimator.move({SimTime(), 1.5, 0, 0, kDepthM});
  EXPECT_EQ(estimator.take({kWest, {SimTime()}, 600, 1}), RangeVerdict::kWaiting);
  EXPECT_FALSE(estimator.estimate(SimTime()).has_value());
  EXPECT_EQ(estimator.take({kEast, {SimTime()}, 700, 1}), RangeVerdict::kUsed);
  EXPECT_TRUE(estimator.estimate(SimTime()).has_value());
}

TEST(PositionEstimator, DoesNotStartFromRangesThatDoNotMeet) {
  PositionEstimator estimator({});
  estimator.move({SimTime(), 1.5, 0, 0, kDepthM});
  EXPECT_EQ(estimator.take({kWest, {SimTime()}, 100, 1}), RangeVerdict::kWaiting);
  EXPECT_EQ(estimator.take({kEast, {SimTime()}, 200, 1}), RangeVerdict::kWaiting);
}

TEST(PositionEstimator, RefusesRulesThatAreNoNumbersAboveZero) {
  EXPECT_THROW(PositionEstimator({.gate = 0}), InvalidArgument);
  EXPECT_THROW(PositionEstimator({.drift_m_per_sqrt_s = std::numeric_limits<double>::quiet_NaN()}),
               InvalidArgument);
  EXPECT_THROW(PositionEstimator({}, StatedStart{{0, 0}, 0}), InvalidArgument);
}

}  // namespace
}  // namespace halocline::clients
