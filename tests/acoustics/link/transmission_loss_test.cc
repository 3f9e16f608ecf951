// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/link/transmission_loss.h"

#include <string>

#include "acoustics/sea/absorption.h"
#include "tests/acoustics/reference_rows.h"
#include "tests/support/csv.h"

namespace halocline::acoustics {
namespace {

using testing::CsvRow;
using testing::tolerance;

double alpha(const CsvRow& row) {
  const AbsorbingWater water{row.number("T_degC"), 35, 0, row.number("P_atm"), 8};
  return absorption_db_per_km(AbsorptionModel::kFisherSimmons1977, water, khz_to_hz(row.number("f_kHz")));
}

TransmissionLoss loss(const CsvRow& row) {
  return transmission_loss(row.number("range_m"), row.number("k_spreading"), alpha(row));
}

TEST(TransmissionLoss, MatchesEveryReferenceRow) {
  const std::string file = "transmission_loss.csv";
  expect_column(file, "alpha_dB_per_km", alpha);
  expect_decibels(file, "spreading_dB", [](const CsvRow& row) { return loss(row).spreading.value; });
  expect_decibels(file, "absorption_dB", [](const CsvRow& row) { return loss(row).absorption.value; });
  expect_decibels(file, "TL_dB", [](const CsvRow& row) { return loss(row).total.value; });
  expect_column(file, "A_linear", [](const CsvRow& row) { return to_power_ratio(loss(row).total).value; });
}

TEST(TransmissionLoss, IsZeroBelowOneMetre) {
  for (const double range : {0.0, 1e-300, 0.5, 0.999999}) {
    EXPECT_EQ(transmission_loss(range, 2, 1000).total.value, 0) << range;
  }
  EXPECT_GT(transmission_loss(1.0, 2, 1000).total.value, 0);
}

TEST(TransmissionLoss, TenTimesTheRangeCostsTenDecibelsPerExponent) {
  EXPECT_NEAR(transmission_loss(1000, 2, 0).total.value, 60, tolerance(1e-12));    // spherical
  EXPECT_NEAR(transmission_loss(1000, 1, 0).total.value, 30, tolerance(1e-12));    // cylindrical
  EXPECT_NEAR(transmission_loss(1000, 1.5, 0).total.value, 45, tolerance(1e-12));  // practical
}

TEST(TransmissionLoss, AbsorptionCountsPerKilometreNotPerMetre) {
  const double near = transmission_loss(2000, 1.5, 3).absorption.value;
  EXPECT_NEAR(near, 6, tolerance(1e-12));
}

}  // namespace
}  // namespace halocline::acoustics
