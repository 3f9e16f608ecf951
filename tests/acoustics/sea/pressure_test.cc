// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/sea/pressure.h"

#include "core/units.h"
#include "tests/acoustics/reference_rows.h"
#include "tests/support/csv.h"

namespace halocline::acoustics {
namespace {

using testing::CsvRow;
using testing::tolerance;

double latitude(const CsvRow& row) { return to_radians(row.number("lat_deg")); }

TEST(Pressure, StandardOceanMatchesEveryReferenceRow) {
  expect_column("pressure_from_depth_leroy_parthiot1998.csv", "p_standard_ocean_dbar", [](const CsvRow& row) {
    return standard_ocean_pressure_dbar(row.number("depth_m"), latitude(row));
  });
}

TEST(Pressure, CommonOceansMatchEveryReferenceRow) {
  expect_column("pressure_from_depth_leroy_parthiot1998.csv", "p_common_oceans_dbar", [](const CsvRow& row) {
    return common_oceans_pressure_dbar(row.number("depth_m"), latitude(row));
  });
}

TEST(Pressure, DepthMatchesEveryReferenceRow) {
  expect_column("depth_from_pressure_unesco.csv", "depth_m",
                [](const CsvRow& row) { return unesco_depth_m(row.number("p_dbar"), latitude(row)); });
}

TEST(Pressure, DepthMatchesUnescosPrintedValues) {
  // Printed to a millimetre and a centimetre.
  EXPECT_NEAR(unesco_depth_m(10'000, to_radians(30)), 9712.653, tolerance(5e-4));
  EXPECT_NEAR(unesco_depth_m(500, 0), 496.65, tolerance(5e-3));
  EXPECT_NEAR(unesco_depth_m(5'000, 0), 4915.04, tolerance(5e-3));
}

TEST(Pressure, ThereAndBackAgreesWithinTheTwoFits) {
  // Two authors' fits of two data sets: 0.1 dbar and 0.1 m each at mid depth, growing to 1.5 m at 10 km.
  for (double depth = 100; depth <= 10'000; depth += 300) {
    const double back = unesco_depth_m(standard_ocean_pressure_dbar(depth, to_radians(45)), to_radians(45));
    EXPECT_NEAR(back, depth, tolerance(1.5)) << depth;
  }
}

TEST(Pressure, GrowsTowardsThePoles) {
  for (double latitude_deg = 0; latitude_deg < 90; latitude_deg += 10) {
    EXPECT_LT(standard_ocean_pressure_dbar(1000, to_radians(latitude_deg)),
              standard_ocean_pressure_dbar(1000, to_radians(latitude_deg + 10)));
    EXPECT_DOUBLE_EQ(standard_ocean_pressure_dbar(1000, to_radians(latitude_deg)),
                     standard_ocean_pressure_dbar(1000, to_radians(-latitude_deg)));
  }
}

TEST(Pressure, IsOneAtmosphereAtTheSurface) {
  EXPECT_EQ(pressure_atm_absolute(0, to_radians(45)), 1);
  EXPECT_NEAR(pressure_atm_absolute(100, to_radians(45)), 10.9525,
              tolerance(5e-5));  // of the figures' absorption
}

}  // namespace
}  // namespace halocline::acoustics
