// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/modem/modem_power.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/check.h"
#include "tests/support/tolerance.h"

namespace halocline::acoustics {
namespace {

using halocline::testing::tolerance;

Modem modem_of(double source_level_db, double directivity_db = 0) {
  Modem modem;
  modem.source_level = {source_level_db};
  modem.directivity_index = {directivity_db};
  return modem;
}

TEST(ModemPower, AWattOfSoundIs170Point8Decibels) {
  EXPECT_NEAR(transmit_power_w(modem_of(170.8), 1), 1, tolerance(1e-12));
  EXPECT_NEAR(transmit_power_w(modem_of(170.8), 0.25), 4, tolerance(1e-12));
}

// 50 W at half efficiency: the Micromodem of models/modems, 184.8 dB.
TEST(ModemPower, FiftyWattsAtHalfEfficiencyAre184Point8Decibels) {
  EXPECT_NEAR(transmit_power_w(modem_of(170.8 + 10 * std::log10(25.0)), 0.5), 50, tolerance(1e-9));
}

TEST(ModemPower, TenDecibelsMoreCostTenTimesAndDirectivitySavesThem) {
  const double plain_w = transmit_power_w(modem_of(180), 0.5);
  EXPECT_NEAR(transmit_power_w(modem_of(190), 0.5), 10 * plain_w, tolerance(1e-9));
  EXPECT_NEAR(transmit_power_w(modem_of(190, 10), 0.5), plain_w, tolerance(1e-12));
}

TEST(ModemPower, RefusesEfficienciesThatAreNone) {
  EXPECT_THROW(transmit_power_w(modem_of(180), 0), InvalidArgument);
  EXPECT_THROW(transmit_power_w(modem_of(180), 1.1), InvalidArgument);
}

}  // namespace
}  // namespace halocline::acoustics
