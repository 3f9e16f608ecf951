// SPDX-License-Identifier: BSD-3-Clause
#include "core/gauss_markov.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/check.h"
#include "tests/support/at_ms.h"
#include "tests/support/tolerance.h"

namespace halocline {
namespace {

using halocline::testing::tolerance;

constexpr double kDeviation = 0.3, kTime_s = 2;

GaussMarkovProcess process(std::uint64_t seed) {
  return {kDeviation, kTime_s, {.seed = seed, .purpose = purpose_of("test"), .who = 0, .which = 0}};
}

using halocline::testing::at_ms;

TEST(GaussMarkov, TheValueAtAnInstantDependsOnNeitherTheStepNorTheOrderOfEvaluation) {
  const GaussMarkovProcess p = process(1);
  GaussMarkovProcess::Cursor fine, coarse, backwards;
  std::vector<double> last;
  for (int ms = 5000; ms >= 0; ms -= 100) last.push_back(p.at(at_ms(ms), backwards));
  std::reverse(last.begin(), last.end());
  for (int ms = 0; ms <= 5000; ++ms) {
    const double value = p.at(at_ms(ms), fine);
    if (ms % 100 != 0) continue;
    EXPECT_EQ(value, p.at(at_ms(ms), coarse));
    EXPECT_EQ(value, p.at(at_ms(ms)));
    EXPECT_EQ(value, last[static_cast<std::size_t>(ms / 100)]);
  }
}

// Mean square over `seconds`, sampled each `step_ms`, of its own seed.
double mean_square(std::uint64_t seed, int step_ms, int seconds) {
  const GaussMarkovProcess p = process(seed);
  GaussMarkovProcess::Cursor cursor;
  double sum = 0;
  const int samples = seconds * 1000 / step_ms;
  for (int i = 0; i < samples; ++i) sum += std::pow(p.at(at_ms(std::int64_t{i} * step_ms), cursor), 2);
  return sum / samples;
}

// Samples of one path are correlated: over a time S the mean square's relative standard error is sqrt(2 T /
// S) (its correlation is exp(-2 t / T)): 4.5 % for S = 2000 s. Bounds at 4 standard errors: a true variance
// fails once in 16 000.
TEST(GaussMarkov, VarianceIsTheSameAtOneTenAndAHundredMilliseconds) {
  constexpr int kSeconds = 2000;
  const double bound = 4 * std::sqrt(2 * kTime_s / kSeconds);
  for (const int step_ms : {1, 10, 100}) {
    const double ratio =
        mean_square(static_cast<std::uint64_t>(step_ms), step_ms, kSeconds) / (kDeviation * kDeviation);
    EXPECT_NEAR(ratio, 1, bound) << step_ms << " ms";
  }
}

// Over 10 000 independent paths: variance to 4 sqrt(2 / 10 000) = 5.7 %, correlations to 4 / sqrt(10 000) =
// 0.04.
TEST(GaussMarkov, CorrelationFallsExponentially) {
  constexpr int kPaths = 10'000;
  const int lags_ms[] = {1, 500, 2000, 6000};
  double square = 0, products[4] = {};
  for (int path = 0; path < kPaths; ++path) {
    const GaussMarkovProcess p = process(1000 + static_cast<std::uint64_t>(path));
    GaussMarkovProcess::Cursor cursor;
    const double start = p.at(at_ms(1234), cursor);
    square += start * start / kPaths;
    for (int k = 0; k < 4; ++k) products[k] += start * p.at(at_ms(1234 + lags_ms[k]), cursor) / kPaths;
  }
  const double variance = kDeviation * kDeviation;
  EXPECT_NEAR(square / variance, 1, 0.057);
  for (int k = 0; k < 4; ++k)
    EXPECT_NEAR(products[k] / variance, std::exp(-lags_ms[k] / 1000.0 / kTime_s), 0.06)
        << lags_ms[k] << " ms";
}

// The step of a millisecond has variance 2 sigma^2 (1 - exp(-h / T)); 20 000 of them estimate it to 4 sqrt(2
// / 20 000) = 4 %.
TEST(GaussMarkov, IncrementsHaveTheRightSizeAtTheFinestStep) {
  const GaussMarkovProcess p = process(77);
  GaussMarkovProcess::Cursor cursor;
  constexpr int kSteps = 20'000;
  double sum = 0, last = p.at(at_ms(0), cursor);
  for (int i = 1; i <= kSteps; ++i) {
    const double now = p.at(at_ms(i), cursor);
    sum += (now - last) * (now - last) / kSteps;
    last = now;
  }
  EXPECT_NEAR(sum / (-2 * kDeviation * kDeviation * std::expm1(-0.001 / kTime_s)), 1, 0.04);
}

TEST(GaussMarkov, BetweenMillisecondsItIsInterpolated) {
  const GaussMarkovProcess p = process(5);
  const double a = p.at(at_ms(10)), b = p.at(at_ms(11));
  EXPECT_NEAR(p.at(SimTime::from_nanoseconds(10'250'000)), 0.75 * a + 0.25 * b, tolerance(1e-15));
}

TEST(GaussMarkov, ImpossibleSettingsAreRefused) {
  EXPECT_THROW(GaussMarkovProcess(-1, 1, {}), InvalidArgument);
  EXPECT_THROW(GaussMarkovProcess(1, 0, {}), InvalidArgument);
}

// Over 2000 walks the relative standard error of a variance is sqrt(2 / 2000); bounds at 4 of them.
TEST(RandomWalk, StartsFromZeroAndItsIncrementsAreIndependentAndGrowWithTheRootOfTime) {
  constexpr int kWalks = 2000;
  constexpr double kStep = 0.2;
  double first = 0, second = 0, joint = 0;
  for (int i = 0; i < kWalks; ++i) {
    const auto walk = GaussMarkovProcess::random_walk(
        kStep, {.seed = static_cast<std::uint64_t>(i), .purpose = purpose_of("test")});
    EXPECT_EQ(walk.at(at_ms(0)), 0);
    const double a = walk.at(at_ms(777'000)), b = walk.at(at_ms(5'000'000)) - a;
    first += a * a / (kStep * kStep * 777) / kWalks;
    second += b * b / (kStep * kStep * 4223) / kWalks;
    joint += a * b / (kStep * kStep * std::sqrt(777.0 * 4223)) / kWalks;
  }
  const double bound = 4 * std::sqrt(2.0 / kWalks);
  EXPECT_NEAR(first, 1, bound);
  EXPECT_NEAR(second, 1, bound);
  EXPECT_NEAR(joint, 0, 4 / std::sqrt(kWalks));
}

TEST(RandomWalk, TheValueAtAnInstantDependsOnNoOrder) {
  const auto walk = GaussMarkovProcess::random_walk(1, {.seed = 4, .purpose = purpose_of("test")});
  GaussMarkovProcess::Cursor cursor;
  for (const int ms : {5000, 1, 3'600'000, 4999, 77})
    EXPECT_EQ(walk.at(at_ms(ms), cursor), walk.at(at_ms(ms)));
  EXPECT_EQ(GaussMarkovProcess::random_walk(0, {}).at(at_ms(10)), 0);
}

}  // namespace
}  // namespace halocline
