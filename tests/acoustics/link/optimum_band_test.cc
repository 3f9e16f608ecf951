// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/link/optimum_band.h"

#include <map>
#include <string>

#include "core/check.h"
#include "tests/acoustics/reference_rows.h"
#include "tests/support/csv.h"

namespace halocline::acoustics {
namespace {

using testing::CsvRow;
using testing::tolerance;

OptimumBandQuestion question(double range_m) {
  return {.range_m = range_m,
          .spreading_exponent = 1.5,
          .absorption = absorption_spectrum(AbsorptionModel::kThorpPiecewise, {4, 35, 0, 1, 8}),
          .noise = {0.5, 0},
          .target_snr = {20}};
}

// Results of the table's few ranges, kept: many columns need the same one.
const OptimumBand& answer(const CsvRow& row) {
  static std::map<double, OptimumBand> known;
  const double range_m = 1000 * row.number("range_km");
  const auto found = known.find(range_m);
  return found != known.end() ? found->second
                              : known.emplace(range_m, optimum_band(question(range_m))).first->second;
}

const std::string kFile = "stojanovic2006_k1p5_s0p5_w0_snr20.csv";
constexpr double kPrinted = 1e-9;  // the table has ten digits

TEST(OptimumBand, OptimumFrequencyMatchesEveryReferenceRow) {
  // A minimum found from values of 16 digits is known to about 8.
  expect_column(
      kFile, "f_opt_kHz", [](const CsvRow& r) { return hz_to_khz(answer(r).optimum_frequency_hz); }, 1e-7);
  expect_column(
      kFile, "minus_AN_min_dB", [](const CsvRow& r) { return -answer(r).min_loss_and_noise.value; },
      kPrinted);
}

TEST(OptimumBand, FlatBandMatchesEveryReferenceRow) {
  expect_column(
      kFile, "f3_lo_kHz", [](const CsvRow& r) { return hz_to_khz(answer(r).flat.band.low_hz); }, kPrinted);
  expect_column(
      kFile, "f3_hi_kHz", [](const CsvRow& r) { return hz_to_khz(answer(r).flat.band.high_hz); }, kPrinted);
  expect_column(
      kFile, "B3_Hz", [](const CsvRow& r) { return answer(r).flat.band.width_hz(); }, kPrinted);
  expect_column(
      kFile, "P3_dB_re_1uPa", [](const CsvRow& r) { return answer(r).flat.source_level.value; }, kPrinted);
  expect_column(
      kFile, "C3_bit_per_s", [](const CsvRow& r) { return answer(r).flat.capacity_bps; }, kPrinted);
  expect_column(
      kFile, "C3_over_B3",
      [](const CsvRow& r) { return answer(r).flat.capacity_bps / answer(r).flat.band.width_hz(); }, kPrinted);
}

TEST(OptimumBand, WaterFillingMatchesEveryReferenceRow) {
  const auto plan = [](const CsvRow& r) { return answer(r).water_filling; };
  expect_column(
      kFile, "fwf_lo_kHz", [&](const CsvRow& r) { return hz_to_khz(plan(r).band.low_hz); }, kPrinted);
  expect_column(
      kFile, "fwf_hi_kHz", [&](const CsvRow& r) { return hz_to_khz(plan(r).band.high_hz); }, kPrinted);
  expect_column(
      kFile, "Bwf_Hz", [&](const CsvRow& r) { return plan(r).band.width_hz(); }, kPrinted);
  expect_column(
      kFile, "Pwf_dB_re_1uPa", [&](const CsvRow& r) { return plan(r).source_level.value; }, kPrinted);
  expect_column(
      kFile, "Cwf_bit_per_s", [&](const CsvRow& r) { return plan(r).capacity_bps; }, kPrinted);
  expect_column(
      kFile, "Cwf_over_Bwf", [&](const CsvRow& r) { return plan(r).capacity_bps / plan(r).band.width_hz(); },
      kPrinted);
}

TEST(OptimumBand, FallsWithRange) {
  double before = 1e9;
  for (const double range : {500.0, 1e3, 5e3, 2e4, 1e5}) {
    const OptimumBand best = optimum_band(question(range));
    EXPECT_LT(best.optimum_frequency_hz, before) << range;
    EXPECT_LT(best.flat.capacity_bps, best.water_filling.capacity_bps) << range;
    before = best.optimum_frequency_hz;
  }
}

TEST(OptimumBand, RefusesRangesBelowAMetre) { EXPECT_THROW(optimum_band(question(0.5)), InvalidArgument); }

}  // namespace
}  // namespace halocline::acoustics
