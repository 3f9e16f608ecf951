// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/link/capacity.h"

#include <cmath>

#include "acoustics/math/frequency_band.h"
#include "tests/acoustics/reference_rows.h"
#include "tests/support/csv.h"

namespace halocline::acoustics {
namespace {

using testing::CsvRow;
using testing::tolerance;

constexpr double kCapacityTolerance = 1e-9;  // required of equation 8

UniformLink link_of(const CsvRow& row) {
  const AbsorbingWater water{row.number("T_degC"), 35, 0, row.number("P_atm"), 8};
  return {.source_level = {row.number("Ptx_dB_re_1uPa_at_1m")},
          .range_m = row.number("range_m"),
          .spreading_exponent = row.number("k_spreading"),
          .absorption = absorption_spectrum(AbsorptionModel::kFisherSimmons1977, water),
          .noise = {row.number("shipping"), row.number("wind_m_per_s")}};
}

Band band_of(const CsvRow& row) {
  return {khz_to_hz(row.number("f_lo_kHz")), khz_to_hz(row.number("f_hi_kHz"))};
}

TEST(Capacity, MatchesEveryReferenceRow) {
  expect_column(
      "capacity_eq8.csv", "C_bit_per_s",
      [](const CsvRow& row) { return capacity_bps(link_of(row), band_of(row)); }, kCapacityTolerance);
}

TEST(Capacity, NarrowbandMatchesEveryReferenceRow) {
  expect_column(
      "capacity_eq8.csv", "C_narrowband_at_fc_bit_per_s",
      [](const CsvRow& row) { return narrowband_capacity_bps(link_of(row), band_of(row)); },
      kCapacityTolerance);
}

// Equation 8 with the given panels, to measure what the panels cost.
double capacity_with_panels(const UniformLink& link, const Band& band, double panel_ratio) {
  double bits = 0;
  for (const FrequencyNode& node : frequency_nodes(band.low_hz, band.high_hz, panel_ratio)) {
    const double f = hz_to_khz(node.frequency_hz);
    const double loss_db = link.spreading_exponent * 10 * std::log10(link.range_m) +
                           link.absorption.db_per_km(f * f) * link.range_m / 1000;
    const double level = std::pow(10, (link.source_level.value - loss_db) / 10) / band.width_hz();
    bits += node.weight_hz * log2_of_1_plus(level / noise_power_density(node.frequency_hz, link.noise).value);
  }
  return bits;
}

TEST(Capacity, PanelsAreFineEnoughForEveryBandAndRange) {
  for (const double source_level : {60.0, 120.0, 185.0, 220.0}) {
    for (const double range : {1.0, 180.0, 3e3, 3e4, 3e5}) {
      for (const Band band : {Band{22.5e3, 27.5e3}, Band{9.44e3, 13.6e3}, Band{1e3, 100e3}, Band{100, 3e3}}) {
        const UniformLink link{{source_level},
                               range,
                               1.5,
                               absorption_spectrum(AbsorptionModel::kFisherSimmons1977, {4, 35, 0, 1, 8}),
                               {0.5, 5}};
        const double fine = capacity_with_panels(link, band, 1.01);
        EXPECT_NEAR(capacity_bps(link, band) / fine, 1, tolerance(1e-10))
            << source_level << " dB, " << range << " m, " << band.low_hz << " Hz";
      }
    }
  }
}

UniformLink example(double source_level_db, double range_m, double wind_mps) {
  const AbsorbingWater water{13.3, 35, 100, 10.95, 8};
  return {{source_level_db},
          range_m,
          1.5,
          absorption_spectrum(AbsorptionModel::kFisherSimmons1977, water),
          {0.5, wind_mps}};
}
constexpr Band kBand{22.5e3, 27.5e3};

TEST(Capacity, FallsWithRangeAndWindAndGrowsWithPower) {
  EXPECT_LT(capacity_bps(example(120, 180, 0), kBand), capacity_bps(example(120, 100, 0), kBand));
  EXPECT_LT(capacity_bps(example(120, 100, 10), kBand), capacity_bps(example(120, 100, 0), kBand));
  EXPECT_LT(capacity_bps(example(110, 100, 0), kBand), capacity_bps(example(120, 100, 0), kBand));
}

TEST(Capacity, TenDecibelsOfStrengthAreWorthTheirBitsInAStrongLink) {
  // Far above noise log2(1 + x) is log2(x): 10 dB gain B log2(10) bits.
  const double gain = capacity_bps(example(190, 100, 0), kBand) - capacity_bps(example(180, 100, 0), kBand);
  EXPECT_NEAR(gain / (5000 * std::log2(10)), 1, tolerance(1e-9));
}

TEST(Capacity, KeepsItsDigitsInAHopelessLink) {
  // log2(1 + x) of x = 1e-18 is 0 when computed as printed.
  EXPECT_NEAR(log2_of_1_plus(1e-18) / 1e-18, 1 / std::log(2.0), tolerance(1e-12));
  const double weak = capacity_bps(example(0, 180, 0), kBand),
               weaker = capacity_bps(example(-100, 180, 0), kBand);
  EXPECT_NEAR(weak / weaker / 1e10, 1, tolerance(1e-5));
}

}  // namespace
}  // namespace halocline::acoustics
