// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/math/gauss_legendre.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/check.h"
#include "tests/support/tolerance.h"

namespace halocline::acoustics {
namespace {

using testing::tolerance;

TEST(GaussLegendre, IntegratesPolynomialsUpToTwiceItsNodesLessOneExactly) {
  for (int n = 1; n <= 64; n *= 2) {
    const GaussLegendreRule rule = make_gauss_legendre(n);
    for (int power = 0; power <= 2 * n - 1; ++power) {
      const double area = integrate(rule, 0.0, 1.0, [power](double x) { return std::pow(x, power); });
      // Rounding alone: a few units in the last place.
      EXPECT_NEAR(area * (power + 1), 1, tolerance(2e-14)) << n << " nodes, x^" << power;
    }
  }
}

TEST(GaussLegendre, FiveNodesMatchTheClosedForm) {
  const GaussLegendreRule& rule = gauss_legendre_5();
  EXPECT_NEAR(rule.nodes[4], std::sqrt(5 + 2 * std::sqrt(10.0 / 7)) / 3, tolerance(1e-15));
  EXPECT_NEAR(rule.weights[2], 128.0 / 225, tolerance(1e-15));
}

TEST(GaussLegendre, TurningTheIntervalRoundTurnsTheSign) {
  const auto f = [](double x) { return std::exp(x); };
  EXPECT_DOUBLE_EQ(integrate(gauss_legendre_16(), 0.0, 2.0, f), -integrate(gauss_legendre_16(), 2.0, 0.0, f));
}

TEST(GaussLegendre, RefusesNoNodes) { EXPECT_THROW(make_gauss_legendre(0), InvalidArgument); }

}  // namespace
}  // namespace halocline::acoustics
