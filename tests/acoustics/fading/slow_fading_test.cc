// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/fading/slow_fading.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/fading/link_fading.h"
#include "acoustics/fading/path_fading.h"
#include "acoustics/math/functions.h"
#include "acoustics/noise/noise_variation.h"
#include "core/check.h"
#include "core/random.h"
#include "core/sim_time.h"
#include "tests/support/tolerance.h"

namespace halocline::acoustics {
namespace {

using halocline::testing::tolerance;
using std::numbers::ln10;
using std::numbers::pi;

constexpr SlowFading kHours{.deviation_db = 3, .time_s = 21600};
constexpr SlowFading kSlow{.deviation_db = 3, .time_s = 21600, .tidal_db = 1, .daily_db = 1};
constexpr double kHourS = 3600;

double level_db(const SlowFading& model, std::uint64_t seed, double time_s) {
  return slow_level(model, {seed, 1, 2}, SimTime::from_seconds(time_s)).value;
}

TEST(SlowFading, IsAFunctionOfSeedPairAndTimeAlone) {
  std::vector<double> forwards, backwards;
  for (int hour = 0; hour < 50; ++hour) forwards.push_back(level_db(kSlow, 7, hour * kHourS));
  for (int hour = 50; hour-- > 0;) backwards.push_back(level_db(kSlow, 7, hour * kHourS));
  std::reverse(backwards.begin(), backwards.end());
  EXPECT_EQ(forwards, backwards);
  EXPECT_NE(level_db(kSlow, 7, 0), level_db(kSlow, 8, 0));
  EXPECT_NE(slow_level(kSlow, {7, 1, 2}, SimTime()).value, slow_level(kSlow, {7, 1, 3}, SimTime()).value);
}

TEST(SlowFading, KeptDrawsGiveTheSameLevels) {
  SlowLevels kept(kSlow);
  for (const double time_s : {0.0, 10.0, 65.0, 66.0, 5e5, 1.0, 1e8}) {
    for (const std::uint32_t other : {2u, 3u}) {
      const SlowPair pair{7, 1, other};
      const SimTime at = SimTime::from_seconds(time_s);
      EXPECT_EQ(kept.at(pair, at).value, slow_level(kSlow, pair, at).value) << time_s;
    }
  }
}

// No step where the draws change: 1 ms apart the level moves by the slope of a few dB an hour.
TEST(SlowFading, IsContinuous) {
  const double edge_s = 65.536 * 100;
  EXPECT_NEAR(level_db(kSlow, 3, edge_s - 1e-3), level_db(kSlow, 3, edge_s + 1e-3), 1e-4);
}

TEST(SlowFading, OfNothingIsNothing) {
  EXPECT_FALSE(SlowFading().any());
  EXPECT_EQ(level_db({}, 1, 1000), 0);
}

// Standard errors of 4000 pairs: of the mean power 10^(Y/10), whose relative deviation is 0.85, 0.014; of the
// variance sqrt(2 / 4000), of the correlation 1 / sqrt(4000). Bounds at 4. The spectrum is the transform of
// the correlation exp(-|t| / T).
TEST(SlowFading, IsStationaryWithTheStatedPowerDeviationAndCorrelation) {
  constexpr int kPairs = 4000;
  for (const double start_s : {0.0, 1e6}) {
    double power = 0, variance = 0, after_2_h = 0, after_6_h = 0;
    for (std::uint64_t seed = 0; seed < kPairs; ++seed) {
      const double mean = -9 * ln10 / 20, now = level_db(kHours, seed, start_s) - mean;
      power += std::pow(10, (now + mean) / 10) / kPairs;
      variance += now * now / kPairs;
      after_2_h += now * (level_db(kHours, seed, start_s + 2 * kHourS) - mean) / kPairs;
      after_6_h += now * (level_db(kHours, seed, start_s + 6 * kHourS) - mean) / kPairs;
    }
    EXPECT_NEAR(power, 1, 4 * 0.014);
    EXPECT_NEAR(variance / 9, 1, 4 * std::sqrt(2.0 / kPairs));
    EXPECT_NEAR(after_2_h / 9, std::exp(-1.0 / 3), 4 / std::sqrt(kPairs));
    EXPECT_NEAR(after_6_h / 9, std::exp(-1.0), 4 / std::sqrt(kPairs));
  }
}

// A cosine of M2: its greatest less its least value is twice the amplitude, it repeats after 44714.16 s and
// its mean power over a period is 1.
TEST(SlowFading, ATideIsACosineOfItsPeriodAndAPhaseOfThePair) {
  const SlowFading tide{.tidal_db = 2}, day{.daily_db = 2};
  double least = 1e9, most = -1e9, power = 0;
  constexpr int kSteps = 1000;
  for (int i = 0; i < kSteps; ++i) {
    const double now = level_db(tide, 3, 44714.16 * i / kSteps);
    least = std::min(least, now);
    most = std::max(most, now);
    power += std::pow(10, now / 10) / kSteps;
  }
  EXPECT_NEAR(most - least, 4, 1e-4);
  EXPECT_NEAR(power, 1, tolerance(1e-9));
  EXPECT_NEAR(level_db(tide, 3, 500), level_db(tide, 3, 500 + 44714.16), tolerance(1e-9));
  EXPECT_NEAR(level_db(day, 3, 500), level_db(day, 3, 500 + 86400), tolerance(1e-9));
  EXPECT_GT(std::abs(level_db(tide, 3, 0) - level_db(tide, 4, 0)), 1e-3);
}

TEST(SlowFading, ScalesThePressuresOfALink) {
  FadingModel model{.enabled = true, .large_scale_db = 0};
  model.slow = kSlow;
  const SimTime at = SimTime::from_seconds(5000);
  const double expected = std::pow(10, slow_level(kSlow, {9, 2, 5}, at).value / 20);
  EXPECT_NEAR(LinkFading(model, {9, 2, 5, false}).large_scale(at), expected, tolerance(1e-12));
  EXPECT_EQ(LinkFading(model, {9, 2, 5, true}).large_scale(at),
            LinkFading(model, {9, 2, 5, false}).large_scale(at));
  FadingModel minutes{.enabled = true};
  const double fast = LinkFading(minutes, {9, 2, 5, false}).large_scale(at);
  minutes.slow = kSlow;
  EXPECT_NEAR(LinkFading(minutes, {9, 2, 5, false}).large_scale(at), fast * expected, tolerance(1e-12));
}

// Outcomes of packets whose probability is Phi(Y / w) correlate by (2 / pi) asin(s^2 rho / (s^2 + w^2)).
double correlation(double apart_s) {
  constexpr double kSpread = 9, kWidth = 16;
  return 2 / pi * std::asin(kSpread * std::exp(-apart_s / 21600) / (kSpread + kWidth));
}

TEST(SlowSea, OutcomesTwoHoursApartCorrelateAsTheirClosedForm) {
  EXPECT_NEAR(correlation(2 * kHourS), 0.166094805742, tolerance(1e-12));
  constexpr int kPairs = 20'000;
  double joint = 0;
  for (std::uint64_t seed = 0; seed < kPairs; ++seed) {
    const auto outcome = [&](double time_s) {
      const double level = level_db(kHours, seed, time_s) + 9 * ln10 / 20;
      return 2 * normal_probability(level / 4) - 1;  // the mean of +1 and -1
    };
    joint += outcome(0) * outcome(2 * kHourS) / kPairs;
  }
  // Each product lies within 1 and has a deviation of 0.3: four standard errors are 0.009.
  EXPECT_NEAR(joint, correlation(2 * kHourS), 0.009);
}

// 4000 bins: four standard errors of the variance are 9 %.
TEST(SlowSea, BinsOfTwentyPacketsVaryAsTheirClosedForm) {
  constexpr int kPackets = 20, kBins = 4000;
  double expected = 1;
  for (int k = 1; k < kPackets; ++k) expected += 2.0 / kPackets * (kPackets - k) * correlation(360.0 * k);
  EXPECT_NEAR(expected, 4.95758950384, tolerance(1e-11));
  double variance = 0;
  for (std::uint64_t seed = 0; seed < kBins; ++seed) {
    int delivered = 0;
    for (int i = 0; i < kPackets; ++i) {
      const double level = level_db(kHours, seed, 360.0 * i) + 9 * ln10 / 20;
      const double draw = uniform_at({.seed = seed, .which = static_cast<std::uint64_t>(i)});
      delivered += draw < normal_probability(level / 4) ? 1 : 0;
    }
    variance += std::pow(delivered - kPackets / 2.0, 2) / kBins;
  }
  EXPECT_NEAR(variance / (kPackets * 0.25) / expected, 1, 0.09);
}

// What a run has at packets 360 s apart: bins of 2 h of links with a margin of 0 dB over the place where half
// arrives, with a curve of w = 2 dB.
struct BinStatistics {
  double variance_ratio = 0, correlation = 0;
};
BinStatistics statistics_of(const FadingModel& fading, const NoiseVariation& noise, int links, double days) {
  constexpr int kPackets = 20;
  const int bins = std::max(2, static_cast<int>(std::lround(days * 12)));
  std::vector<std::vector<double>> shares;
  for (int link = 0; link < links; ++link) {
    const auto seed = static_cast<std::uint64_t>(link);
    std::vector<double>& own = shares.emplace_back();
    for (int bin = 0; bin < bins; ++bin) {
      double delivered = 0;
      for (int i = 0; i < kPackets; ++i) {
        const int number = kPackets * bin + i;
        const SimTime at = SimTime::from_seconds(360.0 * number);
        const double margin_db = 20 * std::log10(LinkFading(fading, {seed, 1, 2, false}).large_scale(at)) -
                                 noise_offset(noise, seed, at).value;
        const double draw =
            uniform_at({.seed = seed, .purpose = 1, .which = static_cast<std::uint64_t>(number)});
        delivered += draw < normal_probability(margin_db / 2) ? 1.0 / kPackets : 0;
      }
      own.push_back(delivered);
    }
  }
  double mean = 0, variance = 0, joint = 0;
  const double count = links * bins, pairs = links * (bins - 1.0);
  for (const auto& own : shares) {
    for (const double share : own) mean += share / count;
  }
  for (const auto& own : shares) {
    for (std::size_t i = 0; i < own.size(); ++i) {
      variance += std::pow(own[i] - mean, 2) / count;
      if (i > 0) joint += (own[i] - mean) * (own[i - 1] - mean) / pairs;
    }
  }
  return {variance / (mean * (1 - mean) / kPackets), joint / variance};
}

// Acceptance 11.8 of the slow sea.
TEST(SlowSea, BinsOfTwoHoursVaryTwoToEightTimesAsTheBinomialOnes) {
  FadingModel sea{.enabled = true};
  sea.slow = kSlow;
  for (const double days : {0.2, 0.5, 2.0}) {
    const BinStatistics slow =
        statistics_of(sea, {.spread_db = 3, .spread_time_s = 3600}, days < 1 ? 120 : 30, days);
    EXPECT_GT(slow.variance_ratio, 2) << days;
    EXPECT_LT(slow.variance_ratio, 8) << days;
    EXPECT_GT(slow.correlation, 0.15) << days;
    EXPECT_LT(slow.correlation, 0.65) << days;
  }
  const BinStatistics still = statistics_of({.enabled = true}, {}, 60, 2);
  EXPECT_GT(still.variance_ratio, 0.8);
  EXPECT_LT(still.variance_ratio, 1.3);
}

// Normal: mean +- 1.2815515655 s, s^2 = 9 + 16.
TEST(MarginQuantiles, OfNormalChangesAreThoseOfTheNormalDistribution) {
  const MarginQuantiles hours = margin_quantiles(kHours, 4);
  const double mean = (16 - 9) * ln10 / 20;
  EXPECT_NEAR(hours.low_db, mean - 1.2815515655 * 5, 0.005);
  EXPECT_NEAR(hours.high_db, mean + 1.2815515655 * 5, 0.005);
  EXPECT_EQ(margin_quantiles({}, 0).low_db, 0);
  EXPECT_EQ(margin_quantiles({}, 0).high_db, 0);
}

// 20 000 pairs at one time each: the share below a quantile has a standard error of 0.0021; bound at 4.
TEST(MarginQuantiles, AreThoseOfTheMarginsOverPairsAndTimes) {
  constexpr int kPairs = 20'000;
  const NoiseVariation noise{.spread_db = 3, .spread_time_s = 3600};
  const SlowFading model{.deviation_db = 2, .tidal_db = 3, .daily_db = 1};
  const MarginQuantiles hours = margin_quantiles(model, noise.spread_db);
  double low = 0, high = 0;
  for (std::uint64_t seed = 0; seed < kPairs; ++seed) {
    const double time_s = 1000.0 * static_cast<double>(seed % 100);
    const double margin =
        level_db(model, seed, time_s) - noise_offset(noise, seed, SimTime::from_seconds(time_s)).value;
    low += margin < hours.low_db ? 1.0 / kPairs : 0;
    high += margin < hours.high_db ? 1.0 / kPairs : 0;
  }
  EXPECT_NEAR(low, 0.1, 4 * 0.0021);
  EXPECT_NEAR(high, 0.9, 4 * 0.0021);
}

TEST(SlowFading, RefusesWhatIsOutOfRange) {
  EXPECT_NO_THROW(validate(kSlow));
  EXPECT_THROW(validate(SlowFading{.deviation_db = 21}), InvalidArgument);
  EXPECT_THROW(validate(SlowFading{.time_s = 0}), InvalidArgument);
  EXPECT_THROW(validate(SlowFading{.tidal_db = -1}), InvalidArgument);
  EXPECT_THROW(validate(SlowFading{.daily_db = 21}), InvalidArgument);
}

}  // namespace
}  // namespace halocline::acoustics
