// SPDX-License-Identifier: BSD-3-Clause
#include "core/tide.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/support/tolerance.h"

namespace halocline {
namespace {

using std::numbers::pi;
using testing::tolerance;

// A cos(2 pi t / T) at 10 000 s, from the formula in twelve digits.
TEST(Tide, OfOneMetreIsTheCosineOfTheLunarDay) {
  const Tide tide{{{.amplitude_m = 1}}};
  EXPECT_NEAR(tide.height_m(10'000), 0.164851218032, tolerance(1e-12));
  EXPECT_EQ(tide.height_m(0), 1);
}

TEST(Tide, WithoutConstituentsDoesNotMove) {
  const Tide tide;
  EXPECT_FALSE(tide.moves());
  EXPECT_EQ(tide.height_m(12'345), 0);
  EXPECT_EQ(tide.max_rate_mps(), 0);
}

TEST(Tide, RepeatsAfterAPeriodAndIsLaterByItsPhase) {
  const Tide now{{{.amplitude_m = 2}}}, later{{{.amplitude_m = 2, .phase_rad = pi / 2}}};
  EXPECT_NEAR(now.height_m(1000 + kLunarSemidiurnalS), now.height_m(1000), tolerance(1e-9));
  EXPECT_NEAR(later.height_m(1000 + kLunarSemidiurnalS / 4), now.height_m(1000), tolerance(1e-9));
}

TEST(Tide, ItsRateIsTheSlopeOfItsHeightAndStaysBelowItsBound) {
  const Tide tide{{{.amplitude_m = 1.2}, {.amplitude_m = 0.4, .period_s = 43'200, .phase_rad = 1}}};
  for (double t = 0; t < 1e5; t += 3333) {
    const double slope = (tide.height_m(t + 1) - tide.height_m(t - 1)) / 2;
    EXPECT_NEAR(tide.rate_mps(t), slope, tolerance(1e-11)) << t;  // third derivative: below 1e-12 m/s
    EXPECT_LE(std::abs(tide.rate_mps(t)), tide.max_rate_mps()) << t;
  }
}

}  // namespace
}  // namespace halocline
