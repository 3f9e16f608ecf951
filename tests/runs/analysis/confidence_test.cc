// SPDX-License-Identifier: BSD-3-Clause
#include "runs/analysis/confidence.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "core/check.h"
#include "core/random.h"

namespace halocline::clients {
namespace {

TEST(WilsonInterval, IsThatOfNewcombesExamples) {
  // Newcombe 1998, "Two-sided confidence intervals for the single proportion", table I, method 3.
  struct Example {
    int k, n;
    double low, high;
  };
  for (const auto& [k, n, low, high] : {Example{81, 263, 0.2553, 0.3662}, Example{15, 148, 0.0624, 0.1605},
                                        Example{0, 20, 0, 0.1611}, Example{1, 29, 0.0061, 0.1718}}) {
    const ConfidenceInterval interval = wilson_interval(k, n, 0.95);
    EXPECT_NEAR(interval.low, low, 5e-5);
    EXPECT_NEAR(interval.high, high, 5e-5);
  }
}

TEST(WilsonInterval, OfNoTrialsIsUnknownAndOfImpossibleOnesRefused) {
  EXPECT_TRUE(std::isnan(wilson_interval(0, 0, 0.95).low));
  EXPECT_THROW(wilson_interval(3, 2, 0.95), InvalidArgument);
  EXPECT_THROW(wilson_interval(1, 2, 1), InvalidArgument);
}

TEST(MeanEstimate, OfFiveValuesByHand) {
  const std::vector<double> values{1, 2, 3, 4, 5};  // deviation 1.5811, standard error 0.70711, t 2.7764
  const MeanEstimate estimate = mean_estimate(values, 0.95);
  EXPECT_DOUBLE_EQ(estimate.mean, 3);
  EXPECT_NEAR(estimate.interval.high - 3, 1.9632, 1e-4);
  EXPECT_NEAR(estimate.interval.low, 6 - estimate.interval.high, 1e-12);
}

// The half width over the standard error is Student's t of n - 1 degrees: Abramowitz and Stegun, table 26.10,
// to the digits given there.
TEST(MeanEstimate, HasTheWidthOfThePublishedTables) {
  struct Example {
    std::size_t values;
    double level, t;
  };
  for (const auto& [n, level, t] : {Example{2, 0.95, 12.706},
                                    {3, 0.95, 4.303},
                                    {5, 0.95, 2.776},
                                    {10, 0.95, 2.262},
                                    {30, 0.95, 2.045},
                                    {11, 0.99, 3.169},
                                    {121, 0.9, 1.658}}) {
    std::vector<double> values(n, 0.0);
    values[0] = 1;  // mean 1/n, variance 1/n, standard error 1/n
    const ConfidenceInterval interval = mean_estimate(values, level).interval;
    EXPECT_NEAR((interval.high - interval.low) / 2 * static_cast<double>(n), t, 5e-4) << n;
  }
}

TEST(MeanEstimate, LeavesOutWhatIsUnknown) {
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(mean_estimate(std::vector<double>{unknown, 4}, 0.95).mean, 4);
  EXPECT_TRUE(std::isnan(mean_estimate(std::vector<double>{unknown, 4}, 0.95).interval.low));
  EXPECT_TRUE(std::isnan(mean_estimate(std::vector<double>{}, 0.95).mean));
}

TEST(ShareEstimate, LiesWithinZeroToOneWhateverTheRunsAre) {
  const std::vector<std::vector<double>> samples{
      {1, 1}, {0, 0, 0}, {1, 0}, {0.99, 1}, {0.98, 1, 1, 1}, {0, 0.01, 0, 0.02}, {0.5, 0.5}, {1, 1, 1, 1, 0}};
  for (const auto& values : samples) {
    const auto [mean, interval] = share_estimate(values, 0.95);
    EXPECT_GE(interval.low, 0);
    EXPECT_LE(interval.high, 1);
    EXPECT_LE(interval.low, mean);
    EXPECT_GE(interval.high, mean);
  }
  EXPECT_THROW(share_estimate(std::vector<double>{0.5, 1.1}, 0.95), InvalidArgument);
}

// Runs that delivered all are no proof that all will: of three runs, as of three trials, at t of two degrees.
TEST(ShareEstimate, OfRunsThatAllDeliveredEverythingIsOpenBelow) {
  const ConfidenceInterval interval = share_estimate(std::vector<double>{1, 1, 1}, 0.95).interval;
  EXPECT_EQ(interval.high, 1);
  EXPECT_NEAR(interval.low, 1 / (1 + 4.3027 * 4.3027 / 3), 1e-4);  // n / (n + t^2)
}

// Ends solve |mean - share| = t sqrt(share (1 - share) / trials), trials being mean (1 - mean) over the
// variance of the mean.
TEST(ShareEstimate, SolvesTheScoreEquationAndIsStudentsFarFromTheEnds) {
  const std::vector<double> near_end{0.9, 1, 0.98, 0.97, 0.99}, far{0.501, 0.499, 0.502, 0.498, 0.5};
  const auto [mean, interval] = share_estimate(near_end, 0.95);
  double squares = 0;
  for (const double v : near_end) squares += (v - mean) * (v - mean);
  const double trials = mean * (1 - mean) / (squares / 4 / 5);
  for (const double end : {interval.low, interval.high})
    EXPECT_NEAR(std::abs(mean - end), 2.7764 * std::sqrt(end * (1 - end) / trials), 1e-5);
  const ConfidenceInterval score = share_estimate(far, 0.95).interval,
                           student = mean_estimate(far, 0.95).interval;
  EXPECT_NEAR(score.low, student.low, 1e-5);  // t^3 s^3 / sqrt(n)^3, below 1e-7
  EXPECT_NEAR(score.high, student.high, 1e-5);
}

// 2000 experiments each: the share of intervals that hold the truth is within 3.5 standard errors of the
// level (normal values), or at least the level less that (Wilson's for p = 0.1, n = 50: coverage 0.94 to
// 0.97, Brown et al. 2001).
TEST(ConfidenceIntervals, CoverTheTruthAsOftenAsTheirLevelStates) {
  constexpr int kExperiments = 2000;
  int means = 0, shares = 0;
  for (std::uint64_t e = 0; e < kExperiments; ++e) {
    std::vector<double> values;
    int successes = 0;
    for (std::uint64_t i = 0; i < 50; ++i) {
      const DrawAddress address{.seed = 5, .purpose = purpose_of("coverage"), .who = 0, .which = e * 100 + i};
      if (i < 6) values.push_back(7 + 2 * normal_at(address));
      successes += uniform_at(address) < 0.1 ? 1 : 0;
    }
    const ConfidenceInterval mean = mean_estimate(values, 0.9).interval,
                             share = wilson_interval(successes, 50, 0.95);
    means += mean.low <= 7 && 7 <= mean.high ? 1 : 0;
    shares += share.low <= 0.1 && 0.1 <= share.high ? 1 : 0;
  }
  EXPECT_NEAR(means / 2000.0, 0.9, 3.5 * std::sqrt(0.9 * 0.1 / kExperiments));
  EXPECT_GT(shares / 2000.0, 0.94 - 3.5 * std::sqrt(0.94 * 0.06 / kExperiments));
  EXPECT_LT(shares / 2000.0, 0.97 + 3.5 * std::sqrt(0.97 * 0.03 / kExperiments));
}

}  // namespace
}  // namespace halocline::clients
