// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/sea/ray_water.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/math/arc_math.h"
#include "acoustics/math/hermite_cubic.h"
#include "acoustics/rays/search/eigenray_search.h"
#include "acoustics/sea/environment.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "core/check.h"
#include "tests/support/tolerance.h"

namespace halocline::acoustics {
namespace {

using testing::tolerance;

double nothing(double) { return 0; }

TEST(RayWater, ATableOfSpeedsIsTakenAsItIs) {
  const auto profile = SoundSpeedProfile::from_speeds({{0, 1520}, {50, 1490}, {100, 1490}}, {10, 35});
  const RayWater water = RayWater::from_profile(profile, nothing);
  EXPECT_EQ(water.depths_m(), (std::vector<double>{0, 50, 100, kDeepestWater}));
  EXPECT_EQ(water.speeds_mps(), (std::vector<double>{1520, 1490, 1490, 1490}));
  EXPECT_NEAR(water.speed_at(25), 1505, tolerance(1e-12));
}

TEST(RayWater, AFormulaIsSampledToTheTolerance) {
  for (const auto& profile : {SoundSpeedProfile::munk({4, 35}), SoundSpeedProfile::global_mean()}) {
    const RayWater coarse = RayWater::from_profile(profile, nothing, 0.1),
                   fine = RayWater::from_profile(profile, nothing, 0.01);
    EXPECT_LT(coarse.layers(), fine.layers());
    for (double z = 0; z < 3900; z += 7.3) {
      EXPECT_NEAR(fine.speed_at(z), profile.sound_speed_mps(z), tolerance(0.02)) << z;
    }
  }
}

TEST(RayWater, AbsorptionOfALayerIsTheParabolaThroughThreeDepths) {
  const RayWater water({{0, 1500}, {100, 1510}}, [](double z) { return 1 + 0.01 * z + 1e-4 * z * z; });
  EXPECT_NEAR(water.absorption_db_per_m(30), (1 + 0.3 + 0.09) / 1000, tolerance(1e-15));
}

TEST(RayWater, KnowsWaterOfOneSpeed) {
  EXPECT_TRUE(RayWater({{0, 1500}}, nothing).is_isovelocity_above(100));
  const RayWater below({{0, 1500}, {100, 1500}, {200, 1510}}, nothing);
  EXPECT_TRUE(below.is_isovelocity_above(100));
  EXPECT_FALSE(below.is_isovelocity_above(101));
}

TEST(RayWater, RefusesKnotsThatDoNotGoDown) {
  EXPECT_THROW(RayWater({{0, 1500}, {0, 1510}}, nothing), InvalidArgument);
  EXPECT_THROW(RayWater({}, nothing), InvalidArgument);
}

TEST(Thinned, StaysWithinTheToleranceAtEveryKnotItDrops) {
  std::vector<SpeedRow> knots;
  for (int i = 0; i <= 100; ++i) knots.push_back({50.0 * i, munk_sound_speed_mps(50.0 * i)});
  const std::vector<SpeedRow> few = thinned(knots, 0.1);
  EXPECT_LT(few.size(), 35U);
  const RayWater water(few, nothing);
  for (const SpeedRow& knot : knots)
    EXPECT_NEAR(water.speed_at(knot.depth_m), knot.sound_speed_mps, tolerance(0.1000001));
  EXPECT_EQ(thinned(knots, 0).size(), knots.size());
}

TEST(RayWater, OfAnEnvironmentHasItsAbsorption) {
  Environment environment;
  const RayWater water = ray_water(environment, 25e3);
  EXPECT_NEAR(water.absorption_db_per_m(100) * 1000, absorption_spectrum_at(environment, 100).db_per_km(625),
              tolerance(1e-3));
}

TEST(RayWater, OfAnEnvironmentThinnedStaysWithinTheTolerance) {
  const Environment environment;
  const RayWater full = ray_water(environment, 25e3), thin = ray_water(environment, 25e3, 0.3);
  EXPECT_LT(thin.layers(), full.layers());
  for (const double depth : full.depths_m()) {
    EXPECT_NEAR(thin.speed_at(depth), full.speed_at(depth), tolerance(0.3000001)) << depth;
  }
}

TEST(ArcMath, SeriesAndFunctionsMeet) {
  for (const double x : {-0.09999, 0.05, 0.09999, 0.10001}) {
    EXPECT_NEAR(log1p_over(x), std::log1p(x) / x, tolerance(2e-14)) << x;
    EXPECT_NEAR(asin_over(x), std::asin(x) / x, tolerance(1e-13)) << x;
    EXPECT_NEAR(atanh_over(x), std::atanh(x) / x, tolerance(2e-13)) << x;
  }
  EXPECT_EQ(log1p_over(0), 1);
}

TEST(ArcMath, MeanAbsorptionOfAStraightPathIsTheMeanOfTheLayer) {
  EXPECT_NEAR(mean_absorption({1, 2, 3}, 0.5, 0.5), 1 + 1 + 1, tolerance(1e-15));
}

TEST(HermiteCubic, FindsItsTurnsAndCrossings) {
  const HermiteCubic cubic(0, 1, 0, 1, 1);  // t - 3 t^2 + 2 t^3: up, down, up
  EXPECT_EQ(cubic.turns().count, 2);
  for (const double t : cubic.turns()) EXPECT_NEAR(cubic.slope(t), 0, tolerance(1e-14));
  const HermiteCubic line(1, 2, 3, 2, 1);
  EXPECT_EQ(line.turns().count, 0);
  EXPECT_NEAR(line.crossing(2.5), 0.75, tolerance(1e-12));
}

}  // namespace
}  // namespace halocline::acoustics
