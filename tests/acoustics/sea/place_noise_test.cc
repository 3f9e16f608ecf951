// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/noise/place_noise.h"

#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "acoustics/noise/noise_spectrum.h"
#include "acoustics/noise/noise_variation.h"
#include "acoustics/sea/noise.h"
#include "core/sim_time.h"
#include "tests/support/tolerance.h"

namespace halocline::acoustics {
namespace {

using halocline::testing::tolerance;

double level_db(NoisePlace place, double frequency_hz, double wind_mps = 5) {
  NoiseSources sources{.wind_mps = wind_mps};
  sources.place = place;
  return noise_components(frequency_hz, sources).total.value;
}

// The tolerance is the rounding of the published values.
TEST(PlaceNoise, At25KilohertzInABreezeIsThatOfTheTable) {
  EXPECT_NEAR(level_db(NoisePlace::kOpen, 25e3), 38.5, 0.05);
  EXPECT_NEAR(level_db(NoisePlace::kShelf, 25e3), 42.6, 0.05);
  EXPECT_NEAR(level_db(NoisePlace::kHarbour, 25e3), 50.6, 0.05);
  EXPECT_NEAR(level_db(NoisePlace::kReef, 25e3), 63.7, 0.05);
}

TEST(PlaceNoise, OfEachPlaceIsItsFormula) {
  const auto at = [](NoisePlace place, double khz) { return place_noise(place, 1000 * khz)->value; };
  EXPECT_FALSE(place_noise(NoisePlace::kOpen, 25e3).has_value());
  for (const double khz : {0.5, 3.5, 20.0, 200.0}) {
    const double fall_db = 17 * std::log10(khz / 20);
    EXPECT_NEAR(at(NoisePlace::kShelf, khz), 42 - fall_db, tolerance(1e-12)) << khz;
    EXPECT_NEAR(at(NoisePlace::kWindFarm, khz), 48 - fall_db, tolerance(1e-12)) << khz;
    EXPECT_NEAR(at(NoisePlace::kEstuary, khz), 50 - fall_db, tolerance(1e-12)) << khz;
    EXPECT_NEAR(at(NoisePlace::kHarbour, khz), 52 - fall_db, tolerance(1e-12)) << khz;
    EXPECT_NEAR(at(NoisePlace::kFastIce, khz), 45 - 17 * std::log10(khz / 3.5), tolerance(1e-12)) << khz;
  }
  for (const double khz : {2.0, 10.0, 24.0}) {
    EXPECT_EQ(at(NoisePlace::kReef, khz), 64);
    EXPECT_EQ(at(NoisePlace::kReefEdge, khz), 54);
  }
  EXPECT_NEAR(at(NoisePlace::kReef, 240), 44, tolerance(1e-12));
  EXPECT_NEAR(at(NoisePlace::kReef, 0.2), 44, tolerance(1e-12));
  EXPECT_EQ(at(NoisePlace::kShelf, 0.05), at(NoisePlace::kShelf, 0.5));
}

// Heat, ships and turbulence stay; the wind alone is gone.
TEST(PlaceNoise, UnderFastIceTheWindMakesNone) {
  EXPECT_EQ(level_db(NoisePlace::kFastIce, 3500, 0), level_db(NoisePlace::kFastIce, 3500, 20));
  EXPECT_LT(level_db(NoisePlace::kFastIce, 3500, 5), level_db(NoisePlace::kOpen, 3500, 5));
  NoiseSources ice{.wind_mps = 20};
  ice.place = NoisePlace::kFastIce;
  const NoiseComponents n = noise_components(3500, ice);
  EXPECT_EQ(n.wind.value, -300);
  EXPECT_NEAR(n.place.value, 45, tolerance(1e-12));
  EXPECT_GE(noise_components(400e3, ice).total.value, n.thermal.value);
}

TEST(PlaceNoise, ASpectrumMeasuredThereTakesItsPlaceAndWindStays) {
  NoiseSources sources{.wind_mps = 5};
  sources.place = NoisePlace::kReef;
  sources.site =
      std::make_shared<const NoiseSpectrum>(std::vector<double>{1e3, 1e5}, std::vector<double>{60, 60});
  const double expected = std::pow(10, 6.0) + std::pow(10, level_db(NoisePlace::kOpen, 25e3) / 10);
  EXPECT_NEAR(noise_power_density(25e3, sources).value / expected, 1, tolerance(1e-12));
}

TEST(PlaceNoise, TheLeastDensityOfABandBoundsEveryPlace) {
  for (const NoisePlace place : kNoisePlaces) {
    NoiseSources sources{.wind_mps = 7};
    sources.place = place;
    for (const double low_hz : {200.0, 1500.0, 20e3, 90e3}) {
      const double least = least_noise_power_density(low_hz, 2 * low_hz, sources).value;
      for (int i = 0; i <= 50; ++i)
        EXPECT_LE(least, noise_power_density(low_hz * (1 + i / 50.0), sources).value * (1 + 1e-12))
            << to_name(place) << low_hz;
    }
  }
}

TEST(PlaceNoise, AShelfEndsAt500Metres) {
  EXPECT_EQ(place_of_depth(500), NoisePlace::kShelf);
  EXPECT_EQ(place_of_depth(501), NoisePlace::kOpen);
}

// The level rises by 4 dB from noon to midnight, half of it by six o'clock.
TEST(PlaceNoise, AReefIsLouderByNight) {
  const NoiseVariation reef{.day_night_db = day_night_db(NoisePlace::kReef), .noon_s = 3600};
  const auto at = [&](double hour) {
    return noise_offset(reef, 1, SimTime::from_seconds(3600 * (1 + hour))).value;
  };
  EXPECT_EQ(at(0), 0);
  EXPECT_NEAR(at(6), 2, tolerance(1e-9));
  EXPECT_NEAR(at(12), 4, tolerance(1e-9));
  EXPECT_NEAR(at(24), 0, tolerance(1e-9));
  EXPECT_EQ(day_night_db(NoisePlace::kShelf), 0);
}

TEST(PlaceNoise, SnapsWithinTheLevelAreNotDrawnBesideIt) {
  const NoiseVariation reef{.burst_exponent = kPlaceBurstExponent, .bursts_within_level = true};
  EXPECT_TRUE(reef.has_bursts());
  EXPECT_FALSE(reef.draws_bursts());
}

}  // namespace
}  // namespace halocline::acoustics
