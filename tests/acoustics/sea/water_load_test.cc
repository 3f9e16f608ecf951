// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/sea/water_load.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "acoustics/link/link_kernel.h"
#include "acoustics/modem/modem.h"
#include "acoustics/sea/absorption.h"
#include "acoustics/sea/environment.h"
#include "core/check.h"
#include "core/frames.h"
#include "tests/support/tolerance.h"

namespace halocline::acoustics {
namespace {

using halocline::testing::tolerance;

constexpr WaterLoad kSilt{.particles_kg_m3 = 0.2, .particle_radius_m = 3e-6};

// Urick 1948; the tolerance is the rounding of the values.
TEST(WaterLoad, SiltAbsorbsWhatUricksFormulaGives) {
  EXPECT_NEAR(kSilt.db_per_km(25e3), 7.5, 0.05);
  EXPECT_NEAR(kSilt.db_per_km(69e3), 23.9, 0.05);
  EXPECT_NEAR(kSilt.db_per_km(100e3), 33.7, 0.05);
}

// Large grains at high frequencies scatter: k^4 a^3 / 3 nepers a metre of a share of the volume of 1. Drag
// adds 1 % of it there.
TEST(WaterLoad, LargeGrainsScatterByTheFourthPowerOfTheFrequency) {
  const WaterLoad sand{.particles_kg_m3 = 1, .particle_radius_m = 2e-4};
  const double k = 2 * std::numbers::pi * 1e6 / 1500;
  const double scattered = 10 / std::numbers::ln10 * 1000 * std::pow(k, 4) * std::pow(2e-4, 3) / 3 / 2650;
  EXPECT_NEAR(sand.db_per_km(1e6) / scattered, 1.01, 0.005);
}

TEST(WaterLoad, IsInProportionToTheMassAndPlantsAddTheirs) {
  WaterLoad more = kSilt;
  more.particles_kg_m3 *= 3;
  more.plants_db_per_km = 20;
  EXPECT_NEAR(more.db_per_km(25e3), 3 * kSilt.db_per_km(25e3) + 20, tolerance(1e-9));
  EXPECT_TRUE(WaterLoad().is_none());
  EXPECT_EQ(WaterLoad().db_per_km(25e3), 0);
}

TEST(WaterLoad, AddsToTheAbsorptionOfEveryFormula) {
  for (const AbsorptionModel model : kAbsorptionModels) {
    Environment clear, turbid;
    clear.absorption_model = turbid.absorption_model = model;
    turbid.load = kSilt;
    for (const double khz : {0.2, 25.0}) {
      const double added = absorption_spectrum_at(turbid, 10).db_per_km(khz * khz) -
                           absorption_spectrum_at(clear, 10).db_per_km(khz * khz);
      EXPECT_NEAR(added, kSilt.db_per_km(1000 * khz), tolerance(1e-9)) << to_name(model);
      EXPECT_EQ(absorption_spectrum_at(turbid, 10).components_at(1000 * khz).total_db_per_km,
                absorption_spectrum_at(turbid, 10).db_per_km(khz * khz))
          << to_name(model);
    }
  }
}

TEST(WaterLoad, ALinkThroughTurbidWaterLosesIt) {
  Environment clear, turbid;
  turbid.load = kSilt;
  Modem modem;
  const LinkKernel through_clear(clear, modem, modem), through_turbid(turbid, modem, modem);
  const Vec3 from(0, 0, 10), to(2000, 0, 10);
  const double added = through_turbid.budget(from, to, Capacity::kLeftOut, {}).transmission_loss.value -
                       through_clear.budget(from, to, Capacity::kLeftOut, {}).transmission_loss.value;
  EXPECT_NEAR(added, 2 * kSilt.db_per_km(modem.centre_frequency_hz), tolerance(1e-6));
}

TEST(WaterLoad, IsRefusedOutOfRange) {
  Environment sea;
  sea.load.particles_kg_m3 = -1;
  EXPECT_THROW(validate(sea), InvalidArgument);
  sea.load = {.particles_kg_m3 = 1, .particle_radius_m = 1};
  EXPECT_THROW(validate(sea), InvalidArgument);
}

}  // namespace
}  // namespace halocline::acoustics
