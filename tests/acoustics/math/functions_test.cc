// SPDX-License-Identifier: BSD-3-Clause
// Distributions against Boost.Math's.
#include "acoustics/math/functions.h"

#include <cmath>

#include <boost/math/special_functions/erf.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <gtest/gtest.h>

namespace halocline::acoustics {
namespace {

TEST(NormalDistribution, QuantilesAreThoseOfBoost) {
  for (double p = 1e-12; p < 1; p = p < 0.01 ? 3 * p : p + 0.0137)
    EXPECT_NEAR(normal_quantile(p), -std::sqrt(2.0) * boost::math::erfc_inv(2 * p), 1e-13) << p;
  EXPECT_NEAR(normal_quantile(0.5), 0, 1e-15);
}

TEST(NormalDistribution, AQuantileHasItsProbability) {
  for (double p = 1e-12; p < 1; p = p < 0.01 ? 3 * p : p + 0.0137)
    EXPECT_NEAR(normal_probability(normal_quantile(p)), p, 1e-14 * p + 1e-16) << p;
}

TEST(GammaDistribution, ProbabilitiesAndQuantilesAreThoseOfBoost) {
  for (const double k : {0.9, 1.0, 1.7, 4.0, 30.0, 400.0}) {
    for (double z = -4.5; z <= 4.5; z += 0.25) {
      const double p = normal_probability(z), x = boost::math::gamma_p_inv(k, p);
      EXPECT_NEAR(gamma_probability(k, x) / p, 1, 1e-12) << k << " " << z;
      // Above, what is left of the probability has few digits.
      EXPECT_NEAR(gamma_quantile_at(k, z) / x, 1, z < 3 ? 1e-11 : 1e-8) << k << " " << z;
    }
  }
}

}  // namespace
}  // namespace halocline::acoustics
