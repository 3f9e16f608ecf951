// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/sea/profile_drift.h"

#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/sea/ray_water.h"
#include "acoustics/sea/sound_speed_profile.h"
#include "core/check.h"
#include "tests/support/tolerance.h"

namespace halocline::acoustics {
namespace {

using halocline::testing::tolerance;

ProfileDrift drift_of(std::uint64_t seed) { return {.spread_mps = 0.3, .depth_m = 100, .seed = seed}; }

// 4000 seeds: standard errors sqrt(2 / 4000) of squares, 1 / sqrt(4000) of the product; bounds at 4. The step
// is 0.3 sqrt(2 (1 - exp(-600 / 21600))) = 0.0702 m/s rms.
TEST(ProfileDrift, HasTheStatedSpreadAndStepsFromBlockToBlock) {
  constexpr int kSeeds = 4000;
  double first = 0, second = 0, joint = 0, step = 0;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const DriftAmplitudes now = drift_amplitudes(drift_of(seed), 40),
                          next = drift_amplitudes(drift_of(seed), 41);
    first += now.first_mps * now.first_mps / kSeeds;
    second += now.second_mps * now.second_mps / kSeeds;
    joint += now.first_mps * now.second_mps / kSeeds;
    step += std::pow(next.first_mps - now.first_mps, 2) / kSeeds;
  }
  const double bound = 4 * std::sqrt(2.0 / kSeeds);
  EXPECT_NEAR(first / 0.09, 1, bound);
  EXPECT_NEAR(second / 0.09, 1, bound);
  EXPECT_NEAR(joint / 0.09, 0, 4 / std::sqrt(kSeeds));
  EXPECT_NEAR(std::sqrt(step), 0.0702, 0.0702 * bound / 2);
}

TEST(ProfileDrift, IsAFunctionOfSeedAndBlockAlone) {
  const DriftAmplitudes later = drift_amplitudes(drift_of(1), 500), start = drift_amplitudes(drift_of(1), 0);
  EXPECT_EQ(drift_amplitudes(drift_of(1), 0).first_mps, start.first_mps);
  EXPECT_EQ(drift_amplitudes(drift_of(1), 500).second_mps, later.second_mps);
  EXPECT_EQ(drift_amplitudes(drift_of(1), -3).first_mps, start.first_mps);
  EXPECT_NE(drift_amplitudes(drift_of(2), 0).first_mps, start.first_mps);
}

TEST(ProfileDrift, ChangesTheUpperWaterByTwoCosinesAndTheWaterBelowByNothing) {
  const DriftAmplitudes amplitudes{0.3, -0.2};
  const auto even = SoundSpeedProfile::isovelocity(1500, {10, 35});
  const auto changed = even.with_change(drift_rows(drift_of(1).depth_m, amplitudes));
  for (double z = 0; z <= 100; z += 3) {
    const double angle = M_PI * z / 100;
    EXPECT_NEAR(changed.sound_speed_mps(z) - 1500, 0.3 * std::cos(angle) - 0.2 * std::cos(2 * angle), 0.005)
        << z;
  }
  EXPECT_NEAR(changed.sound_speed_mps(150) - 1500, -0.25, tolerance(1e-9));  // half of -0.3 - 0.2
  EXPECT_EQ(changed.sound_speed_mps(200), 1500);
  EXPECT_EQ(changed.sound_speed_mps(5000), 1500);
  EXPECT_EQ(changed.without_change().sound_speed_mps(0), 1500);
  EXPECT_EQ(changed.water(10).temperature_degc, 10);
}

// Sound that is traced through knots has the changed speed, also where the profile is a formula of
// temperature or Munk's; the delay of a straight path is the integral of the slowness.
TEST(ProfileDrift, ReachesRaysAndTravelTimesOfEveryKindOfProfile) {
  const std::vector<SpeedRow> rows = drift_rows(drift_of(1).depth_m, {0.3, 0.2});
  for (const auto& profile : {SoundSpeedProfile::isovelocity(1500, {10, 35}),
                              SoundSpeedProfile::global_mean(), SoundSpeedProfile::munk({10, 35})}) {
    const auto changed = profile.with_change(rows);
    const auto water = RayWater::from_profile(changed, [](double) { return 0.0; });
    for (const double z : {0.0, 20.0, 55.0, 130.0, 900.0}) {
      EXPECT_NEAR(water.speed_at(z), changed.sound_speed_mps(z), 0.011) << z;
    }
    double slowness = 0;
    constexpr int kSteps = 20'000;
    for (int i = 0; i < kSteps; ++i)
      slowness += 1 / changed.sound_speed_mps(150 * (i + 0.5) / kSteps) / kSteps;
    EXPECT_NEAR(changed.travel_time_s(0, 150, 1000), 1000 * slowness, tolerance(1e-9));
  }
}

TEST(ProfileDrift, RefusesWhatIsOutOfRange) {
  EXPECT_NO_THROW(validate(drift_of(1)));
  EXPECT_THROW(validate(ProfileDrift{.spread_mps = -1}), InvalidArgument);
  EXPECT_THROW(validate(ProfileDrift{.depth_m = 300}), InvalidArgument);
  EXPECT_THROW(SoundSpeedProfile::global_mean().with_change({{5, 0}, {5, 0}}), InvalidArgument);
}

}  // namespace
}  // namespace halocline::acoustics
