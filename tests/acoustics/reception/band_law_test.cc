#include "acoustics/reception/band_law.h"

#include <cmath>
#include <cstddef>

#include <gtest/gtest.h>

#include "acoustics/math/delay_profile.h"
#include "acoustics/math/functions.h"
#include "acoustics/reception/mean_sound.h"
#include "acoustics/reception/power_law.h"
#include "tests/support/tolerance.h"

namespace halocline::acoustics {
namespace {

using ::halocline::testing::tolerance;

// 0.05 dB is what power_law.h states.
TEST(PowerLaw, IsExponentialForOneScatteredPath) {
  const PowerLaw one{.mean = 2, .variance = 4, .third = 16};
  for (const double z : {-3.0, -1.3, 0.0, 2.1}) {
    const double exact = -2 * std::log1p(-normal_probability(z));
    EXPECT_NEAR(10 * std::log10(one.at(z) / exact), 0, tolerance(0.05)) << z;
  }
}

TEST(PowerLaw, IsItsMeanWithoutVariance) { EXPECT_EQ((PowerLaw{3, 0, 0}.at(-2)), 3); }

TEST(IndependentParts, AreOneForSlowAndAllForFastFading) {
  const auto slow = independent_parts(2, 8, 0);
  // Fades deeper than 2 deviations are short even then: the least of the table is B T = 0.004.
  for (std::size_t i = 2; i < slow.size(); ++i) EXPECT_NEAR(slow[i], 1, 0.2) << i;
  for (const double parts : independent_parts(1, 64, 1)) EXPECT_NEAR(parts, 64, 6);
}

MeanSound scattered(double power, double interference) {
  MeanSound sound;
  sound.scattered[0] = power;
  sound.modes = {{.scattered = power, .interference = interference, .rest = 0}};
  sound.shared = {
      .own = power * power, .y = interference, .xy = power * interference, .yy = squared(interference)};
  return sound;
}

// The saddle point's own error for an exponential, where it is greatest, is 3 % of the probability.
TEST(BandLaw, IsExponentialForOneMode) {
  for (const BandPoint& point : BandLaw(scattered(2, 0), 1, 0).points()) {
    if (std::abs(point.score) > 3.5) continue;
    const double exact = -std::expm1(-point.power / 2);
    EXPECT_NEAR(normal_probability(point.score), exact, 0.01 + 0.06 * exact) << point.power;
  }
}

// S - t (I - mean I) = (1 - t i) S + t i mean S where interference is the share i of one mode.
TEST(BandLaw, InterferenceThatFadesWithTheSignalNarrowsIt) {
  const BandLaw law(scattered(2, 0.5), 1, 0);
  EXPECT_NEAR(law.mean(), 2, 1e-12);
  EXPECT_NEAR(law.variance(), squared(1.5), 1e-12);
}

TEST(BandLaw, IsASinglePowerWhereNothingFades) {
  const MeanSound still;
  for (const BandPoint& point : BandLaw(still, 1, 5).points()) EXPECT_EQ(point.power, 5);
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
