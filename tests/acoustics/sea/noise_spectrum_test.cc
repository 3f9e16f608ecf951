// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/noise/noise_spectrum.h"

#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "acoustics/sea/noise.h"
#include "core/check.h"
#include "tests/support/tolerance.h"

namespace halocline::acoustics {
namespace {

using halocline::testing::tolerance;

TEST(NoiseSpectrum, IsLinearInTheLogarithmOfFrequencyAndConstantBeyond) {
  const NoiseSpectrum spectrum({1e3, 1e5}, {100, 60});
  EXPECT_EQ(spectrum.level(10).value, 100);
  EXPECT_NEAR(spectrum.level(1e4).value, 80, tolerance(1e-12));
  EXPECT_EQ(spectrum.level(1e6).value, 60);
}

// 10^(L / 10) df with L = L0 - 20 log(f / f0): f0^2 10^(L0 / 10) (1 / f1 - 1 / f2).
TEST(NoiseSpectrum, PowerOverABandIsTheIntegralOfItsDensity) {
  const NoiseSpectrum spectrum({1e3, 1e5}, {100, 60});
  const double exact = 1e6 * 1e10 * (1 / 22'500.0 - 1 / 27'500.0);
  EXPECT_NEAR(spectrum.power_over_band(22'500, 27'500).value / exact, 1, tolerance(1e-9));
}

TEST(NoiseSpectrum, TheLeastLevelOfABandMayLieWithinIt) {
  const NoiseSpectrum spectrum({1e3, 1e4, 1e5}, {80, 50, 90});
  EXPECT_EQ(spectrum.least_level(2e3, 5e4).value, 50);
  EXPECT_EQ(spectrum.least_level(2e4, 5e4).value, spectrum.level(2e4).value);
}

TEST(NoiseSpectrum, RefusesTablesThatAreNone) {
  EXPECT_THROW(NoiseSpectrum({}, {}), InvalidArgument);
  EXPECT_THROW(NoiseSpectrum({1e3, 1e3}, {1, 2}), InvalidArgument);
  EXPECT_THROW(NoiseSpectrum({1e3}, {1, 2}), InvalidArgument);
  EXPECT_THROW(NoiseSpectrum({1e3}, {400}), InvalidArgument);
}

TEST(Rain, At5KilohertzIsWhatMaAndNystuenMeasured) {
  // R = 10^((L - 42.4) / 15.4); the shape takes 0.46 dB off at 5 kHz.
  for (const double rain : {2.0, 10.0, 100.0}) {
    const double level_db = noise_components(5000, {.shipping = 0, .rain_mm_per_h = rain}).rain.value;
    EXPECT_NEAR(level_db, 42.4 + 15.4 * std::log10(rain), tolerance(0.5)) << rain;
  }
}

TEST(Rain, AddsItsPowerAndNoneWithoutRain) {
  const NoiseSources dry{.shipping = 0.5, .wind_mps = 5},
      wet{.shipping = 0.5, .wind_mps = 5, .rain_mm_per_h = 20};
  const double added = noise_power_density(1e4, wet).value - noise_power_density(1e4, dry).value;
  EXPECT_NEAR(added / to_power_ratio(noise_components(1e4, wet).rain).value, 1, tolerance(1e-9));
  EXPECT_EQ(noise_components(1e4, dry).rain.value, -300);
}

TEST(NoiseTable, TakesThePlaceOfAllOtherNoise) {
  NoiseSources sources{.shipping = 1, .wind_mps = 20, .rain_mm_per_h = 100};
  sources.table = std::make_shared<const NoiseSpectrum>(NoiseSpectrum({1e3, 1e5}, {70, 30}));
  EXPECT_NEAR(noise_components(1e4, sources).total.value, 50, tolerance(1e-9));
  EXPECT_NEAR(noise_level_over_band(22'500, 27'500, sources).value,
              to_decibels(sources.table->power_over_band(22'500, 27'500)).value, tolerance(1e-9));
}

// The reach of sound is judged by it: no frequency of the band may be quieter.
TEST(LeastNoise, LiesBelowTheDensityEverywhereInTheBand) {
  for (const double rain : {0.0, 30.0}) {
    for (const double low : {200.0, 5e3, 2e4, 9e4}) {
      const NoiseSources sources{.shipping = 0.3, .wind_mps = 7, .rain_mm_per_h = rain};
      const double least = least_noise_power_density(low, 2 * low, sources).value;
      for (int i = 0; i <= 50; ++i)
        EXPECT_LE(least, noise_power_density(low * (1 + i / 50.0), sources).value * (1 + 1e-12)) << low;
    }
  }
}

}  // namespace
}  // namespace halocline::acoustics
