// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/fading/scattering_loss.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "acoustics/fading/path_fading.h"
#include "acoustics/sea/boundary_reflection.h"
#include "core/units.h"

namespace halocline::acoustics {
namespace {

constexpr double kHz = 25'000;
constexpr FadingModel kSea{.enabled = true, .scattering_loss = true};

double squared_sine(double degrees) { return std::pow(std::sin(to_radians(degrees)), 2); }

double of_sand() { return trapped_share(*sediment("MediumSand")); }

// Bounces alike at this angle.
RoughBounces bounces(int surface, int bottom, double degrees) {
  return {surface, bottom, surface * squared_sine(degrees), bottom * squared_sine(degrees)};
}

// One bounce at 10 degrees over medium sand: Gamma = 0.7273, of 1 - exp(-Gamma^2) = 0.4108 the share 1 /
// 1.1782^2 is lost.
TEST(ScatteringLoss, ABottomLosesWhatItScattersBeyondItsCriticalAngle) {
  EXPECT_NEAR(of_sand(), 1 - 1 / (1.1782 * 1.1782), 1e-4);
  EXPECT_EQ(trapped_share(*sediment("Clay")), 0);
  const double kept = kept_share(kSea, 0, kHz, of_sand(), bounces(0, 1, 10));
  EXPECT_NEAR(kept, 1 - 0.4108 / (1.1782 * 1.1782), 1e-4);
  EXPECT_NEAR(kept_share(kSea, 0, kHz, of_sand(), bounces(0, 3, 10)), std::pow(kept, 3), 1e-14);
  // What is coherent stays as it was.
  const PathFading fading = path_fading(kSea, 0, kHz, 0, squared_sine(10), kept);
  EXPECT_NEAR(kept * (1 - fading.scattered), 1 - 0.4108, 1e-4);
  EXPECT_NEAR(fading.coherent + fading.medium + fading.scattered, 1, 1e-15);
  EXPECT_EQ(kept_share({.enabled = true}, 5, kHz, of_sand(), bounces(3, 3, 10)), 1);
  EXPECT_EQ(kept_share({.enabled = false, .scattering_loss = true}, 5, kHz, of_sand(), bounces(3, 3, 10)), 1);
}

// The share by a sum over facets in steps of 1e-5 of slope.
TEST(ScatteringLoss, WavesTurnSoundSteeperByTheirSlopes) {
  const double wind_mps = 5, angle = to_radians(8), critical = std::asin(std::sqrt(of_sand()));
  const double variance = (0.003 + 5.12e-3 * wind_mps) / 2;
  double steeper = 0, all = 0;
  for (double slope = -1 + 5e-6; slope < 1; slope += 1e-5) {
    const double met = std::fmax(1 + slope / std::tan(angle), 0) * std::exp(-slope * slope / (2 * variance));
    all += met;
    if (angle + 2 * std::atan(slope) > critical) steeper += met;
  }
  EXPECT_NEAR(steepened_share(wind_mps, std::sin(angle), of_sand()), steeper / all, 1e-5);
}

TEST(ScatteringLoss, TheSurfaceLosesNothingInCalmWaterOrWithoutABottomThatTakesIt) {
  EXPECT_EQ(kept_share(kSea, 0, kHz, of_sand(), bounces(3, 0, 8)), 1);
  EXPECT_EQ(kept_share(kSea, 10, kHz, of_sand(), bounces(3, 0, 8)), 1);
  const double bottom = kept_share(kSea, 0, kHz, of_sand(), bounces(3, 2, 8));
  const double lost =
      steepened_share(5, std::sin(to_radians(8)), of_sand()) * (1 - squared_sine(8) / of_sand());
  const double gamma =
      2 * (2 * std::numbers::pi * kHz / 1500) * rms_wave_height_m(5) * std::sin(to_radians(8));
  EXPECT_NEAR(kept_share(kSea, 5, kHz, of_sand(), bounces(3, 2, 8)) / bottom,
              std::pow(1 - lost * (1 - std::exp(-gamma * gamma)), 2), 1e-12);
  // Beyond the critical angle, over mud: the bottom alone.
  EXPECT_EQ(kept_share(kSea, 5, kHz, of_sand(), bounces(2, 2, 40)),
            kept_share(kSea, 0, kHz, of_sand(), bounces(2, 2, 40)));
  EXPECT_EQ(kept_share(kSea, 5, kHz, 0, bounces(2, 2, 8)), kept_share(kSea, 0, kHz, 0, bounces(2, 2, 8)));
}

// What stays coherent is never more than what is kept.
TEST(ScatteringLoss, FollowsWindAndAngleContinuously) {
  double last = 1;
  for (int i = 0; i <= 900; ++i) {
    const double kept = kept_share(kSea, 7, kHz, of_sand(), bounces(1, 1, 0.1 * i));
    EXPECT_NEAR(kept, last, 0.02) << 0.1 * i;
    last = kept;
  }
  for (int i = 0; i <= 200; ++i) {
    const double kept = kept_share(kSea, 0.1 * i, kHz, of_sand(), bounces(4, 4, 8));
    const double gamma = 2 * (2 * std::numbers::pi * kHz / 1500) * std::sin(to_radians(8));
    const double heights = std::pow(rms_wave_height_m(0.1 * i), 2) + std::pow(kSea.bottom_roughness_m, 2);
    EXPECT_GE(kept, std::exp(-4 * gamma * gamma * heights)) << 0.1 * i;
  }
}

}  // namespace
}  // namespace halocline::acoustics
