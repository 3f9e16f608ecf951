// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/noise/noise_variation.h"

#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include "core/check.h"
#include "core/sim_time.h"
#include "tests/support/tolerance.h"

namespace halocline::acoustics {
namespace {

using halocline::testing::tolerance;

// 2000 seeds: the relative standard error of the variance is sqrt(2 / 2000), of the correlation 1 /
// sqrt(2000); bounds at 4.
TEST(NoiseSpread, HasTheStatedDeviationAndCorrelationTime) {
  const NoiseVariation variation{.spread_db = 3, .spread_time_s = 600};
  constexpr int kSeeds = 2000;
  double variance = 0, joint = 0, power = 0;
  const double mean = -9 * std::log(10) / 20;  // preserves the mean power
  for (int seed = 0; seed < kSeeds; ++seed) {
    const auto s = static_cast<std::uint64_t>(seed);
    const double now = noise_offset(variation, s, SimTime::from_seconds(1000)).value - mean;
    const double later = noise_offset(variation, s, SimTime::from_seconds(1600)).value - mean;
    power += std::pow(10, (now + mean) / 10) / kSeeds;
    variance += now * now / kSeeds;
    joint += now * later / kSeeds;
  }
  EXPECT_NEAR(variance / 9, 1, 4 * std::sqrt(2.0 / kSeeds));
  EXPECT_NEAR(joint / 9, std::exp(-1), 4 / std::sqrt(kSeeds));
  EXPECT_NEAR(power, 1, 4 * 0.85 / std::sqrt(kSeeds));  // the relative deviation of a power is 0.85
}

TEST(NoiseSpread, OfNoneIsNone) { EXPECT_EQ(noise_offset({}, 1, SimTime::from_seconds(5)).value, 0); }

// E exp(-s A) = exp(-s^(alpha / 2)). exp(-s A) lies in 0..1, so the standard error of 40 000 draws is at most
// 0.5 / 200; bound at 4.
TEST(ImpulsiveNoise, ThePowersAreStableOfHalfTheExponent) {
  constexpr int kDraws = 40'000;
  for (const double alpha : {1.2, 1.6, 1.9}) {
    for (const double s : {0.1, 1.0, 5.0}) {
      double mean = 0;
      for (int i = 0; i < kDraws; ++i) mean += std::exp(-s * burst_power(alpha, 7, 3, i)) / kDraws;
      EXPECT_NEAR(mean, std::exp(-std::pow(s, alpha / 2)), 4 * 0.5 / std::sqrt(kDraws)) << alpha << " " << s;
    }
  }
}

TEST(ImpulsiveNoise, OfExponentTwoIsGaussian) { EXPECT_EQ(burst_power(2, 1, 1, 5), 1); }

TEST(ImpulsiveNoise, IsAnotherAtEachReceiverAndBurst) {
  EXPECT_NE(burst_power(1.5, 1, 1, 5), burst_power(1.5, 1, 2, 5));
  EXPECT_NE(burst_power(1.5, 1, 1, 5), burst_power(1.5, 1, 1, 6));
  EXPECT_EQ(burst_power(1.5, 1, 1, 5), burst_power(1.5, 1, 1, 5));
}

TEST(NoiseVariation, RefusesWhatIsOutOfRange) {
  EXPECT_NO_THROW(validate(NoiseVariation{}));
  EXPECT_THROW(validate(NoiseVariation{.spread_db = -1}), InvalidArgument);
  EXPECT_THROW(validate(NoiseVariation{.burst_exponent = 0.2}), InvalidArgument);
  EXPECT_THROW(validate(NoiseVariation{.burst_exponent = 2.5}), InvalidArgument);
  EXPECT_THROW(validate(NoiseVariation{.burst = SimDuration()}), InvalidArgument);
}

}  // namespace
}  // namespace halocline::acoustics
