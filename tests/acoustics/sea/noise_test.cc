// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/sea/noise.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/acoustics/reference_rows.h"
#include "tests/support/csv.h"

namespace halocline::acoustics {
namespace {

using testing::CsvRow;
using testing::tolerance;

NoiseComponents at(const CsvRow& row) {
  return noise_components(khz_to_hz(row.number("f_kHz")),
                          {row.number("shipping_0_1"), row.number("wind_m_per_s")});
}

TEST(Noise, MatchesEveryReferenceRow) {
  const std::string file = "noise_psd.csv";
  expect_decibels(file, "Nt_dB", [](const CsvRow& row) { return at(row).turbulence.value; });
  expect_decibels(file, "Ns_dB", [](const CsvRow& row) { return at(row).shipping.value; });
  expect_decibels(file, "Nw_dB", [](const CsvRow& row) { return at(row).wind.value; });
  expect_decibels(file, "Nth_dB", [](const CsvRow& row) { return at(row).thermal.value; });
  expect_decibels(file, "N_total_dB_re_1uPa2_per_Hz", [](const CsvRow& row) { return at(row).total.value; });
  expect_column(file, "N_total_linear_uPa2_per_Hz",
                [](const CsvRow& row) { return at(row).total_power.value; });
}

TEST(Noise, MatchesThePublishedValueAtTenKilohertz) {
  EXPECT_NEAR(noise_components(10e3, {0.5, 0}).total.value, 29.354703574234854, tolerance(1e-12));
}

TEST(Noise, ComponentsAddAsPowersNotAsDecibels) {
  const NoiseComponents n = noise_components(1e3, {0.5, 5});
  EXPECT_GT(n.total, std::max({n.turbulence, n.shipping, n.wind, n.thermal}));
  // Four equal powers would be 6.03 dB above one of them; no sum of four is more above the greatest.
  EXPECT_LT(n.total.value, std::max({n.turbulence, n.shipping, n.wind, n.thermal}).value + 6.03);
}

TEST(Noise, WindMovesItByTheRightAmount) {
  // The wind term goes as 7.5 sqrt(w): from 4 to 9 m/s it gains 7.5 dB, and at 10 kHz wind is nearly all
  // there is.
  const NoiseComponents calm = noise_components(10e3, {0.5, 4}), fresh = noise_components(10e3, {0.5, 9});
  EXPECT_NEAR(fresh.wind.value - calm.wind.value, 7.5, tolerance(1e-12));
  EXPECT_NEAR(fresh.total.value - calm.total.value, 7.5, tolerance(0.05));
}

TEST(Noise, WindNoiseIsNotTwentySixDecibelsLow) {
  // At 1 kHz and 10 m/s: 50 + 23.72 - 5.85 = 67.87 dB; Wenz's curves put sea state 5 at about 65 to 70 dB.
  EXPECT_NEAR(noise_components(1e3, {0, 10}).wind.value, 67.87, tolerance(0.01));
}

TEST(Noise, ShippingMovesItByTwentyDecibels) {
  const double quiet = noise_components(100, {0, 0}).shipping.value;
  EXPECT_NEAR(noise_components(100, {1, 0}).shipping.value - quiet, 20, tolerance(1e-12));
  EXPECT_GT(noise_components(100, {1, 0}).total.value, noise_components(100, {0, 0}).total.value + 15);
}

TEST(Noise, ThermalNoiseOverABandMatchesTheClosedForm) {
  // Far above 1 MHz only the thermal term counts: 10^-1.5 f^2 integrates to 10^-1.5 (b^3 - a^3) / 3 (kHz,
  // then Hz).
  const double a = 2e4, b = 3e4;  // kHz
  const double exact = std::pow(10, -1.5) * (b * b * b - a * a * a) / 3 * 1000;
  EXPECT_NEAR(noise_power_over_band(khz_to_hz(a), khz_to_hz(b), {0, 0}).value / exact, 1, tolerance(1e-9));
}

TEST(Noise, ABandIsTheSumOfItsParts) {
  const NoiseSources sea{0.7, 6};
  const double whole = noise_power_over_band(1e3, 100e3, sea).value;
  const double parts =
      noise_power_over_band(1e3, 7e3, sea).value + noise_power_over_band(7e3, 100e3, sea).value;
  EXPECT_NEAR(parts / whole, 1, tolerance(1e-13));
}

TEST(Noise, ANarrowBandIsDensityTimesWidth) {
  const NoiseSources sea{0.5, 5};
  EXPECT_NEAR(noise_power_over_band(9999.5, 10000.5, sea).value / noise_power_density(1e4, sea).value, 1,
              tolerance(1e-8));  // the curvature of the spectrum over 1 Hz
  EXPECT_EQ(noise_power_over_band(1e4, 1e4, sea).value, 0);
}

// noise_offset_db
TEST(Noise, AnOffsetMovesAllSourcesAndTablesAlike) {
  NoiseSources sea{0.5, 5};
  const double before = noise_level_over_band(9e3, 11e3, sea).value;
  const double least = least_noise_power_density(9e3, 11e3, sea).value;
  sea.offset_db = 7;
  EXPECT_NEAR(noise_level_over_band(9e3, 11e3, sea).value, before + 7, tolerance(1e-9));
  EXPECT_NEAR(least_noise_power_density(9e3, 11e3, sea).value / least, std::pow(10, 0.7), tolerance(1e-9));
}

}  // namespace
}  // namespace halocline::acoustics
