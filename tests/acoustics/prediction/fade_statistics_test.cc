// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/prediction/fade_statistics.h"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/math/delay_profile.h"
#include "acoustics/math/functions.h"
#include "acoustics/prediction/equalizer_statistics.h"
#include "acoustics/prediction/gamma_power.h"
#include "tests/support/tolerance.h"

namespace halocline::acoustics {
namespace {

using ::halocline::testing::tolerance;

// 0.05 dB is what gamma_power.h states.
TEST(GammaPower, IsExponentialForOneScatteredPath) {
  const GammaPower one{.mean = 2, .variance = 4, .third = 16};
  for (const double z : {-3.0, -1.3, 0.0, 2.1}) {
    const double exact = -2 * std::log1p(-normal_probability(z));
    EXPECT_NEAR(10 * std::log10(one.at(z) / exact), 0, tolerance(0.05)) << z;
  }
}

// Rice's distribution of mean 1 and variance 0.87, of which 0.639 is diffuse: quantiles of a million drawn.
TEST(GammaPower, HasTheLowQuantilesOfASteadyAndAScatteredPath) {
  const GammaPower rice{.mean = 1, .variance = 0.87, .third = 1.4068};
  EXPECT_NEAR(rice.at(-1.8627), 0.036, 0.001);  // 1 in 32; the gamma variable alone: -0.005
  EXPECT_NEAR(rice.at(-1.5341), 0.072, 0.001);  // 1 in 16
  EXPECT_NEAR(rice.at(-0.8871), 0.229, 0.005);  // 3 in 16
}

TEST(GammaPower, IsItsMeanWithoutVariance) { EXPECT_EQ((GammaPower{3, 0, 0}.at(-2)), 3); }

EqualizerStatistics scattered(double power, double interference, double spread_hz = 0) {
  EqualizerStatistics sound;
  sound.fast = power;
  sound.terms = {{.signal = power,
                  .interference = interference,
                  .unit = power,
                  .signal_cross_terms = 0,
                  .interference_cross_terms = 0,
                  .squared_spread = squared(spread_hz)}};
  return sound;
}
FadeStatistics law_of(const EqualizerStatistics& sound, double threshold, double block_power) {
  return {BandTerms(sound, threshold), block_power};
}
constexpr Stretches kOne{1, 0};

struct BandPoint {
  double power = 0, score = 0, log_parts = 0;
};
std::vector<BandPoint> points_of(const FadeStatistics& law, const Stretches& stretches) {
  const FadeStatistics::Points points = law.points(stretches);
  std::vector<BandPoint> made;
  for (std::size_t i = 0; i < FadeStatistics::kPoints; ++i)
    made.push_back({points.powers[i], points.scores[i], points.log_parts[i]});
  return made;
}

// The saddle point's own error for an exponential, where it is greatest, is 3 % of the probability.
TEST(FadeStatistics, IsExponentialForOnePath) {
  for (const BandPoint& point : points_of(law_of(scattered(2, 0), 1, 0), kOne)) {
    if (std::abs(point.score) > 3.5) continue;
    const double exact = -std::expm1(-point.power / 2);
    EXPECT_NEAR(normal_probability(point.score), exact, 0.01 + 0.06 * exact) << point.power;
    EXPECT_EQ(point.log_parts, 0);
  }
}

// S - t (I - mean I) = S + t mean I - t I of an exponential I.
TEST(FadeStatistics, IsAnExponentialTurnedRoundForInterferenceOfOnePath) {
  EqualizerStatistics sound = scattered(0, 0.5);
  for (const BandPoint& point : points_of(law_of(sound, 2, 3), kOne)) {
    if (std::abs(point.score) > 3.5) continue;
    const double exact = std::exp(-(4 - point.power));
    EXPECT_NEAR(normal_probability(point.score), exact, 0.01 + 0.06 * exact) << point.power;
  }
}

// S - t (I - mean I) = (1 - t i) S + t i mean S where interference is the share i of one path.
TEST(FadeStatistics, InterferenceThatFadesWithTheSignalNarrowsIt) {
  const FadeStatistics law = law_of(scattered(2, 0.5), 1, 0);
  EXPECT_NEAR(law.mean(), 2, 1e-12);
  EXPECT_NEAR(law.variance(), squared(1.5), 1e-12);
}

// Two paths that fade together are one of twice the power.
TEST(FadeStatistics, PathsThatFadeTogetherAreOne) {
  EqualizerStatistics two = scattered(1, 0);
  two.terms.front().unit = 2;
  two.terms.push_back(two.terms.front());
  two.fast = 2;
  const FadeStatistics one = law_of(scattered(2, 0), 1, 0), both = law_of(two, 1, 0);
  EXPECT_NEAR(both.variance(), one.variance(), 1e-12);
  EXPECT_NEAR(both.skewness(), one.skewness(), 1e-12);
}

TEST(FadeStatistics, IsASinglePowerWhereNothingFades) {
  for (const BandPoint& point : points_of(law_of(EqualizerStatistics(), 1, 5), kOne))
    EXPECT_EQ(point.power, 5);
}

// Instants far apart are independent; close ones are one, but for fades that are shorter still.
TEST(FadeStatistics, FadesFallIntoAsManyPartsAsThereAreInstantsFarApart) {
  for (const BandPoint& point : points_of(law_of(scattered(2, 0, 1), 1, 0), {16, 3})) {
    if (std::abs(point.score) > 3) continue;
    EXPECT_NEAR(std::exp(point.log_parts), 16, 1.5) << point.score;
  }
  for (const BandPoint& point : points_of(law_of(scattered(2, 0, 1), 1, 0), {16, 1e-4})) {
    if (point.score < -1 || point.score > 2) continue;
    EXPECT_NEAR(std::exp(point.log_parts), 1, 0.1) << point.score;
  }
}

// Rayleigh's crossings of the level R mean, sqrt(2 pi) B sqrt(2) sqrt(R) exp(-R) a second with B the rms
// spread: as many as stretches of 1 ms that newly fall below it.
TEST(FadeStatistics, CrossesALevelAsOftenAsRice) {
  constexpr double kStepS = 1e-3;
  for (const BandPoint& point : points_of(law_of(scattered(1, 0, 1), 1, 0), {2, kStepS})) {
    if (std::abs(point.score) > 1.5) continue;
    const double below = -std::expm1(-point.power);
    const double crossings =
        2 * std::sqrt(std::numbers::pi) * std::sqrt(point.power) * std::exp(-point.power) * kStepS;
    const double loss = std::exp(point.log_parts) * -std::log1p(-below);
    EXPECT_NEAR(loss + std::log1p(-below), 1.27 * crossings / (1 - below),
                0.12 * crossings / (1 - below) + 1e-4)
        << point.score;
  }
}

// Half of the power 2 s later: mean 1 s, rms 1 s about it.
TEST(DelayMoments, AreThoseOfTwoEqualPaths) {
  const DelayMoments moments = delay_moments({{7, 3}, {9, 3}});
  EXPECT_NEAR(moments.mean_s, 8, 1e-12);
  EXPECT_NEAR(moments.spread_s, 1, 1e-12);
  EXPECT_EQ(delay_moments({}).spread_s, 0);
}

}  // namespace
}  // namespace halocline::acoustics
