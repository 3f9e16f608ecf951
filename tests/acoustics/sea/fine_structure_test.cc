// SPDX-License-Identifier: BSD-3-Clause
// Turning of rays by fine structure and internal waves, against its closed form and a quadrature over depth.
#include "acoustics/sea/fine_structure.h"

#include <cmath>

#include <gtest/gtest.h>

#include "acoustics/sea/ray_water.h"
#include "core/check.h"
#include "tests/support/tolerance.h"

namespace halocline::acoustics {
namespace {

using testing::relative_error;
using testing::tolerance;

double no_absorption(double) { return 0; }

TEST(FineStructure, TurningRateIsThatOfItsClosedForm) {
  EXPECT_LT(relative_error(turning_rate(0.5 * 0.5, std::sin(0.05)), 7.72769115055e-07), tolerance(1e-11));
}

TEST(FineStructure, ItsSpeedAndThatOfInternalWavesAddAsVariances) {
  const FineStructure structure{.speed_mps = 0.05, .internal_wave_m = 0.5};
  EXPECT_NEAR(structure.speed_variance(0.1), 0.05 * 0.05 + 0.05 * 0.05, tolerance(1e-15));
  EXPECT_EQ(structure.speed_variance(-0.1), structure.speed_variance(0.1));
  EXPECT_TRUE(FineStructure().is_perfect());
  EXPECT_FALSE(structure.is_perfect());
}

TEST(FineStructure, ARayThroughEvenWaterHasTheRateOfItsAngle) {
  const RayWater water({{0, 1500}}, no_absorption);
  const FineStructure structure{.speed_mps = 0.1};
  const double sine = std::sin(0.1), expected = turning_rate(0.01, sine);
  EXPECT_LT(relative_error(cycle_turning_rate(water, structure, 100, 30, std::cos(0.1) / 1500), expected),
            tolerance(1e-9));
}

// The mean over depth weighted by the cotangent of the angle, by the midpoint rule over u, z = turn + (H -
// turn) u^2: the cotangent has no bound at the turn.
TEST(FineStructure, TheMeanOfACycleIsWeightedByTheCotangent) {
  const RayWater water({{0, 1520}, {40, 1505}, {100, 1510}}, no_absorption);
  const FineStructure structure{.speed_mps = 0.05, .internal_wave_m = 0.5};
  const double c = water.speed_at(60), xi = std::cos(0.09) / c, turn = (1520 - 1 / xi) / (15.0 / 40);
  double weights = 0, sum = 0;
  constexpr int kCells = 20'000;
  for (int i = 0; i < kCells; ++i) {
    const double u = (i + 0.5) / kCells, z = turn + (100 - turn) * u * u;
    const double cosine = xi * water.speed_at(z), sine = std::sqrt(1 - cosine * cosine);
    const double weight = u * cosine / sine, gradient = water.gradients_per_s()[water.layer_at(z)];
    weights += weight;
    sum += weight * turning_rate(structure.speed_variance(gradient), sine);
  }
  EXPECT_LT(relative_error(cycle_turning_rate(water, structure, 100, 60, xi), sum / weights),
            tolerance(1e-4));
}

TEST(FineStructure, AHorizontalRayThatTurnsAtOnceIsTheLimitOfOthers) {
  const RayWater water({{0, 1520}, {100, 1510}}, no_absorption);
  const FineStructure structure{.speed_mps = 0.05, .internal_wave_m = 0.5};
  const double flat = cycle_turning_rate(water, structure, 100, 60, 1 / 1514.0);
  const double almost = cycle_turning_rate(water, structure, 100, 60, std::cos(1e-5) / 1514.0);
  EXPECT_LT(relative_error(flat, almost), tolerance(1e-3));
}

TEST(FineStructure, FieldsOutOfRangeAreRefused) {
  EXPECT_THROW(validate(FineStructure{.speed_mps = -1}), InvalidArgument);
  EXPECT_THROW(validate(FineStructure{.internal_wave_m = 51}), InvalidArgument);
}

}  // namespace
}  // namespace halocline::acoustics
