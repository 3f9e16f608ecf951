// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/sea/profile_modes.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "acoustics/sea/sound_speed_profile.h"
#include "core/units.h"

namespace halocline::acoustics {
namespace {

constexpr ProfileModes kModes{0.3, -0.2, 100};

double change_at(double z) {
  const double x = std::numbers::pi * z / 100;
  return 0.3 * std::cos(x) - 0.2 * std::cos(2 * x);
}

// Rows are 12.5 m apart; between them the change is straight, off by 0.08 of the second mode at most.
TEST(ProfileModes, MoveTheSpeedOfAnyProfile) {
  const double latitude = to_radians(45);
  for (const SoundSpeedProfile& profile :
       {SoundSpeedProfile::global_mean(), SoundSpeedProfile::isovelocity(1500, {10, 35}),
        SoundSpeedProfile::munk({10, 35})}) {
    const SoundSpeedProfile moved = with_modes(profile, kModes, latitude);
    for (double z = 0; z <= 100; z += 12.5)
      EXPECT_NEAR(moved.sound_speed_mps(z) - profile.sound_speed_mps(z), change_at(z), 0.02) << z;
    EXPECT_NEAR(moved.sound_speed_mps(200), profile.sound_speed_mps(200), 0.04);
  }
}

TEST(ProfileModes, OfNoAmplitudeLeaveTheProfile) {
  const SoundSpeedProfile profile = SoundSpeedProfile::global_mean();
  EXPECT_EQ(with_modes(profile, {}, 0).cell_boundaries_m(), profile.cell_boundaries_m());
}

}  // namespace
}  // namespace halocline::acoustics
