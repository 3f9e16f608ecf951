// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/math/fast_functions.h"

#include <cmath>

#include <gtest/gtest.h>

namespace halocline::acoustics {
namespace {

TEST(FastFunctions, ExponentialAndLogarithmAreThoseOfTheLibrary) {
  for (int i = -69'000; i <= 69'000; ++i) {
    const double x = i * 0.01003;
    ASSERT_NEAR(fast_exp(x) / std::exp(x), 1, 1e-9) << x;
    ASSERT_NEAR(fast_log(std::exp(x)), x, 1e-9) << x;
  }
  EXPECT_EQ(fast_exp(0), 1);
  EXPECT_EQ(fast_log(1), 0);
  EXPECT_NEAR(fast_power(30), 1000, 1e-6);
}

TEST(FastFunctions, TurnsAreThoseOfTheLibrary) {
  for (int i = -100'000; i <= 100'000; ++i) {
    const double x = i * 0.00503 + (i % 7) * 1e5;
    const FastTurn turn = fast_turn(x);
    ASSERT_NEAR(turn.cosine, std::cos(x), 1e-9) << x;
    ASSERT_NEAR(turn.sine, std::sin(x), 1e-9) << x;
  }
  EXPECT_EQ(fast_turn(0).cosine, 1);
  EXPECT_EQ(fast_turn(0).sine, 0);
}

TEST(FastFunctions, ExponentsBeyondTheRangeAreThoseOfItsEnds) {
  EXPECT_EQ(fast_exp(-1e9), fast_exp(-700));
  EXPECT_EQ(fast_exp(1e9), fast_exp(700));
}

}  // namespace
}  // namespace halocline::acoustics
