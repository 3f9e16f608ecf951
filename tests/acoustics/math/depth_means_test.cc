// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/math/depth_means.h"

#include <cmath>
#include <utility>

#include <gtest/gtest.h>

#include "core/check.h"
#include "tests/support/tolerance.h"

namespace halocline::acoustics {
namespace {

using testing::tolerance;

// e^(-z / 30), whose value falls by a factor of 28 over the tallest cell, and its square.
DepthMeans exponentials() {
  return {{0, 10, 60, 160}, 2, [](double depth_m, std::span<double> values) {
            values[0] = std::exp(-depth_m / 30);
            values[1] = values[0] * values[0];
          }};
}
double exact_mean(double upper_m, double lower_m) {
  const double height = (lower_m - upper_m) / 30;
  return -std::exp(-upper_m / 30) * std::expm1(-height) / height;
}
double mean(const DepthMeans& means, std::size_t property, double upper_m, double lower_m) {
  return means.mean(property, means.place(upper_m), means.place(lower_m));
}

TEST(DepthMeans, AreThoseOfTheIntegral) {
  const DepthMeans means = exponentials();
  // Half of the exponent's change over the tallest cell is h = 5 / 3: h^10 / (10! 2^9) = 9e-8; over the one
  // above, 8e-11.
  for (const double lower_m : {12.0, 59.0, 60.0, 61.0, 100.0, 160.0}) {
    EXPECT_NEAR(mean(means, 0, 3, lower_m) / exact_mean(3, lower_m), 1, tolerance(1e-8)) << lower_m;
  }
  for (const double lower_m : {12.0, 20.0, 60.0})
    EXPECT_NEAR(mean(means, 0, 3, lower_m) / exact_mean(3, lower_m), 1, tolerance(1e-11)) << lower_m;
  EXPECT_NEAR(mean(means, 1, 3, 3), std::exp(-0.2), tolerance(1e-13));
}

TEST(DepthMeans, OfPolynomialsOfTheNinthDegreeAreExact) {
  const DepthMeans means({-1, 0.5, 2}, 1,
                         [](double z, std::span<double> values) { values[0] = 10 * std::pow(z, 9); });
  const auto integral = [](double z) { return std::pow(z, 10); };
  for (const auto& [a, b] : {std::pair(-1.0, 2.0), {-0.9, 0.3}, {0.5, 1.5}, {0.4, 0.6}})
    EXPECT_NEAR(mean(means, 0, a, b), (integral(b) - integral(a)) / (b - a), tolerance(1e-11)) << a;
}

TEST(DepthMeans, LoseNoDigitsBetweenPlacesNearEachOther) {
  const DepthMeans means = exponentials();
  for (const double at_m : {5.0, 10.0, 59.9999999, 60.0, 110.0}) {
    const double here = mean(means, 0, at_m, at_m);
    for (double apart_m = 1e-2; at_m + apart_m > at_m; apart_m /= 8) {
      // To first order the mean is the value half way.
      const double expected = here * (1 - apart_m / 60 + apart_m * apart_m / 5400);
      EXPECT_NEAR(mean(means, 0, at_m, at_m + apart_m) / expected, 1, tolerance(1e-7 * apart_m + 1e-14))
          << at_m << " " << apart_m;
    }
  }
}

TEST(DepthMeans, PartsAddUp) {
  const DepthMeans means = exponentials();
  const double whole = 150 * mean(means, 0, 5, 155);
  const double parts = 3 * mean(means, 0, 5, 8) + 92 * mean(means, 0, 8, 100) + 55 * mean(means, 0, 100, 155);
  EXPECT_NEAR(parts / whole, 1, tolerance(1e-14));
}

TEST(DepthMeans, ACellOfNoHeightHoldsItsStep) {
  const double below = std::nextafter(10.0, 20.0);
  const DepthMeans means({0, 10, below, 20}, 1,
                         [](double z, std::span<double> values) { values[0] = z <= 10 ? 1 : 2; });
  EXPECT_NEAR(mean(means, 0, 0, 20), 1.5, tolerance(1e-14));
  EXPECT_NEAR(mean(means, 0, 10, 10), 1, tolerance(1e-12));
  EXPECT_NEAR(mean(means, 0, below, below), 2, tolerance(1e-12));
}

TEST(DepthMeans, NeedACell) {
  EXPECT_THROW(DepthMeans({0}, 1, [](double, std::span<double>) {}), InvalidArgument);
}

}  // namespace
}  // namespace halocline::acoustics
