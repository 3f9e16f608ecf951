// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/fading/path_fading.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/check.h"
#include "core/units.h"

namespace halocline::acoustics {
namespace {

FadingModel fading_sea() { return {.enabled = true}; }

double squared_sine(double degrees) { return std::pow(std::sin(to_radians(degrees)), 2); }

// Rayleigh parameters and spreads worked out by hand from Gamma = 2 k 0.22 U^2 / (4 g) sin(theta), three
// digits.
struct RoughSurface {
  double frequency_hz, wind_mps, grazing_deg, gamma, spread_hz;
};

class OneSurfaceBounce : public ::testing::TestWithParam<RoughSurface> {};

TEST_P(OneSurfaceBounce, SharesPowerByItsRayleighParameter) {
  const RoughSurface& c = GetParam();
  FadingModel model = fading_sea();
  model.medium_coherence_s = 1e6;
  const PathFading fading =
      path_fading(model, c.wind_mps, c.frequency_hz, squared_sine(c.grazing_deg), /*bottom=*/0);
  EXPECT_NEAR(fading.scattered, 1 - std::exp(-c.gamma * c.gamma), 0.006);
  EXPECT_NEAR(fading.doppler_spread_hz, c.spread_hz, 0.005 * c.spread_hz + 0.001);
  EXPECT_NEAR(fading.coherent + fading.medium + fading.scattered, 1, 1e-15);
}

INSTANTIATE_TEST_SUITE_P(Winds, OneSurfaceBounce,
                         ::testing::Values(RoughSurface{25'000, 5, 10, 5.098, 1.967},
                                           RoughSurface{25'000, 10, 10, 20.39, 3.933},
                                           RoughSurface{25'000, 2, 3, 0.2458, 0.2371},
                                           RoughSurface{11'520, 5, 10, 2.349, 0.9063}));

TEST(PathFading, LosesAThirdOfADecibelOfItsCoherentPartInALightBreeze) {
  FadingModel model = fading_sea();
  model.rice_factor_db = 60;  // the medium leaves it alone
  const PathFading fading = path_fading(model, 2, 25'000, squared_sine(3), 0);
  EXPECT_NEAR(to_decibels({fading.coherent}).value, -0.26, 0.01);
}

TEST(PathFading, InCalmWaterIsSharedBetweenSteadyAndMediumByTheRiceFactor) {
  const PathFading fading = path_fading(fading_sea(), 0, 25'000, 3 * squared_sine(20), 0);
  EXPECT_NEAR(fading.coherent, 10.0 / 11, 1e-15);
  EXPECT_NEAR(fading.medium, 1.0 / 11, 1e-15);
  EXPECT_EQ(fading.scattered, 0);
  EXPECT_NEAR(coherence_time_of(fading.doppler_spread_hz), 20, 1e-12);
}

TEST(PathFading, ARoughBottomScattersByItsOwnHeight) {
  FadingModel model = fading_sea();
  const double k = 2 * std::numbers::pi * 25'000 / 1500;
  const double gamma = 2 * k * model.bottom_roughness_m * std::sin(to_radians(10));
  EXPECT_NEAR(path_fading(model, 0, 25'000, 0, 2 * squared_sine(10)).scattered,
              1 - std::exp(-2 * gamma * gamma), 1e-14);
  model.bottom_roughness_m = 0;
  EXPECT_EQ(path_fading(model, 0, 25'000, 0, squared_sine(10)).scattered, 0);
}

TEST(PathFading, FollowsTheWindContinuously) {
  double last = path_fading(fading_sea(), 0, 25'000, squared_sine(5), 0).scattered;
  for (int i = 1; i <= 1000; ++i) {
    const double now = path_fading(fading_sea(), 0.01 * i, 25'000, squared_sine(5), 0).scattered;
    EXPECT_GE(now, last);
    EXPECT_LT(now - last, 0.02) << "at " << 0.01 * i << " m/s";
    last = now;
  }
}

TEST(PathFading, WithoutFadingEverythingIsCoherent) {
  const PathFading fading = path_fading({.enabled = false}, 10, 25'000, 1, 1);
  EXPECT_EQ(fading.coherent, 1);
  EXPECT_EQ(fading.doppler_spread_hz, 0);
}

TEST(PathFading, ImpossibleModelsAreRefused) {
  EXPECT_THROW(validate(FadingModel{.medium_coherence_s = 0}), InvalidArgument);
  EXPECT_THROW(validate(FadingModel{.large_scale_db = -1}), InvalidArgument);
  EXPECT_THROW(validate(FadingModel{.bottom_roughness_m = 2}), InvalidArgument);
}

}  // namespace
}  // namespace halocline::acoustics
