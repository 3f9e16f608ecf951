// SPDX-License-Identifier: BSD-3-Clause
#include "core/units.h"

#include <limits>

#include <gtest/gtest.h>

#include "tests/support/tolerance.h"

namespace halocline {
namespace {

using testing::tolerance;

TEST(Units, TwiceThePowerIsThreeDecibels) {
  EXPECT_NEAR(to_decibels(PowerRatio{2}).value, 3.010299956639812, tolerance(1e-14));
  EXPECT_NEAR(to_power_ratio(Decibels{10}).value, 10, tolerance(1e-14));
}

TEST(Units, PowersAddLinearlyNotInDecibels) {
  const PowerRatio sum = to_power_ratio(Decibels{60}) + to_power_ratio(Decibels{60});
  EXPECT_NEAR(to_decibels(sum).value, 63.010299956639812, tolerance(1e-13));
}

TEST(Units, NoPowerIsMinusInfinityDecibels) {
  EXPECT_EQ(to_decibels(PowerRatio{0}).value, -std::numeric_limits<double>::infinity());
}

TEST(Units, DegreesConvertExactlyAtTheRightAngle) {
  EXPECT_EQ(to_radians(180), std::numbers::pi);
  EXPECT_EQ(to_degrees(std::numbers::pi), 180);
}

}  // namespace
}  // namespace halocline
