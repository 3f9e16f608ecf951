// SPDX-License-Identifier: BSD-3-Clause
#include "acoustics/sea/sound_speed_profile.h"

#include <cmath>
#include <utility>

#include "core/check.h"
#include "core/units.h"
#include "tests/acoustics/reference_rows.h"
#include "tests/support/csv.h"

namespace halocline::acoustics {
namespace {

using testing::CsvRow;
using testing::tolerance;

constexpr WaterSample kAssumed{10, 35};
constexpr double kFigureRange = 1000;  // m, between the two nodes of figure 4

TEST(SoundSpeedProfile, SlantDelaysMatchEveryReferenceRow) {
  const auto profile = SoundSpeedProfile::global_mean();
  const std::string file = "slant_delay_straight_woa98.csv";
  const auto delay = [&](const CsvRow& row) {
    const double z1 = row.number("depth_tx_m"), z2 = row.number("depth_rx_m");
    return profile.travel_time_s(z1, z2, std::hypot(row.number("horizontal_range_m"), z2 - z1));
  };
  expect_column(file, "delay_s", delay);
  expect_column(file, "mean_speed_m_per_s", [&](const CsvRow& row) {
    return profile.mean_sound_speed_mps(row.number("depth_tx_m"), row.number("depth_rx_m"));
  });
}

// Speed and delay columns of figure 4 for one profile.
void expect_figure_4(const SoundSpeedProfile& profile, const std::string& speed, const std::string& delay) {
  const std::string file = "fig4_delay_vs_depth_1km.csv";
  expect_column(file, speed,
                [&](const CsvRow& row) { return profile.sound_speed_mps(row.number("depth_m")); });
  expect_column(file, delay, [&](const CsvRow& row) {
    return profile.travel_time_s(row.number("depth_m"), row.number("depth_m"), kFigureRange);
  });
}

TEST(SoundSpeedProfile, FigureFourMatchesForEveryProfile) {
  expect_figure_4(SoundSpeedProfile::global_mean(), "c_mackenzie_woa98_m_per_s", "delay_woa98_s");
  expect_figure_4(SoundSpeedProfile::global_mean_of_salinity_35(), "c_mackenzie_woa98_S35",
                  "delay_woa98_S35_s");
  expect_figure_4(SoundSpeedProfile::harris_zorzi(), "c_ns2_expr_harris", "delay_harris_s");
  expect_figure_4(SoundSpeedProfile::harris_zorzi(SoundSpeedModel::kMackenzie1981), "c_mackenzie_harris",
                  "delay_mackenzie_harris_s");
  expect_figure_4(SoundSpeedProfile::munk(kAssumed), "c_munk", "delay_munk_s");
}

TEST(SoundSpeedProfile, FigureFoursWaterMatches) {
  const std::string file = "fig4_delay_vs_depth_1km.csv";
  const auto mean = SoundSpeedProfile::global_mean(), harris = SoundSpeedProfile::harris_zorzi();
  expect_column(file, "T_woa98_degC",
                [&](const CsvRow& row) { return mean.water(row.number("depth_m")).temperature_degc; });
  expect_column(file, "S_woa98_psu",
                [&](const CsvRow& row) { return mean.water(row.number("depth_m")).salinity_psu; });
  expect_column(file, "T_harris_ns2_degC",
                [&](const CsvRow& row) { return harris.water(row.number("depth_m")).temperature_degc; });
}

TEST(SoundSpeedProfile, TheMisprintedEquationWouldMoveFigureFourByMilliseconds) {
  // The reference keeps what the paper's printed equation 1 would give (salinity term as printed here), so
  // that the size of the error is on record; ours is the corrected equation.
  const auto mean = SoundSpeedProfile::global_mean();
  const auto misprint = [&](const CsvRow& row) {
    const double z = row.number("depth_m"), t = mean.water(z).temperature_degc;
    return mean.sound_speed_mps(z) + 5.304e-2 * t * t - (2.374e-4 + 5.304e-4) * t * t * t;
  };
  expect_column("fig4_delay_vs_depth_1km.csv", "c_seed_misprint_woa98", misprint);
  expect_column("fig4_delay_vs_depth_1km.csv", "delay_seed_misprint_s",
                [&](const CsvRow& row) { return kFigureRange / misprint(row); });
}

TEST(SoundSpeedProfile, FigureFoursLandmarksHold) {
  const auto profile = SoundSpeedProfile::global_mean();
  const auto delay = [&](double depth) { return profile.travel_time_s(depth, depth, kFigureRange); };
  // The model page prints six digits.
  EXPECT_NEAR(delay(0), 0.660724, tolerance(5e-7));
  EXPECT_NEAR(delay(950), 0.674539, tolerance(5e-7));
  EXPECT_NEAR(delay(4500), 0.652978, tolerance(5e-7));
  for (double depth = 0; depth <= 4500; depth += 10) EXPECT_LE(delay(depth), delay(950)) << depth;
}

TEST(SoundSpeedProfile, HarrisDelaysMatchThePublishedOnes) {
  const auto profile = SoundSpeedProfile::harris_zorzi();
  const auto delay = [&](double depth) { return profile.travel_time_s(depth, depth, kFigureRange); };
  // Printed to 12 digits.
  EXPECT_NEAR(delay(0), 0.654954919977, tolerance(6e-13));
  EXPECT_NEAR(delay(500), 0.660131910859, tolerance(6e-13));
  EXPECT_NEAR(delay(1000), 0.674312871138, tolerance(6e-13));
  EXPECT_NEAR(delay(4500), 0.651474948404, tolerance(6e-13));
}

TEST(SoundSpeedProfile, MunkMatchesEveryReferenceRow) {
  expect_column("munk_profile.csv", "c_m_per_s",
                [](const CsvRow& row) { return munk_sound_speed_mps(row.number("depth_m")); });
}

TEST(SoundSpeedProfile, TravelTimeThroughALinearGradientMatchesTheClosedForm) {
  const double c0 = 1480, c1 = 1530, bottom = 2000;
  const auto profile = SoundSpeedProfile::from_speeds({{0, c0}, {bottom, c1}}, kAssumed);
  const double gradient = (c1 - c0) / bottom;
  for (const double range : {0.0, 300.0, 5000.0}) {
    const double length = std::hypot(range, 1700 - 130), ca = c0 + gradient * 130, cb = c0 + gradient * 1700;
    const double exact = length / (1700 - 130) * std::log(cb / ca) / gradient;
    EXPECT_NEAR(profile.travel_time_s(130, 1700, length) / exact, 1, tolerance(1e-14)) << range;
  }
}

TEST(SoundSpeedProfile, TravelTimeIsTheSameBothWays) {
  const auto profile = SoundSpeedProfile::global_mean();
  EXPECT_DOUBLE_EQ(profile.travel_time_s(20, 3000, 5000), profile.travel_time_s(3000, 20, 5000));
}

TEST(SoundSpeedProfile, TravelTimesAddUpAlongAPath) {
  const auto profile = SoundSpeedProfile::global_mean();
  const double whole = profile.travel_time_s(10, 910, 1800);
  const double parts = profile.travel_time_s(10, 333, 646) + profile.travel_time_s(333, 910, 1154);
  EXPECT_NEAR(parts / whole, 1, tolerance(1e-15 * 4));
}

TEST(SoundSpeedProfile, AShortSlantTendsToTheHorizontal) {
  const auto profile = SoundSpeedProfile::global_mean();
  for (const double z : {0.0, 49.9999999, 50.0, 777.7}) {
    const double flat = profile.travel_time_s(z, z, 1000);
    EXPECT_NEAR(profile.travel_time_s(z, z + 1e-6, 1000) / flat, 1, tolerance(1e-9)) << z;
  }
}

TEST(SoundSpeedProfile, DelayIsNotDistanceOverOneSpeed) {
  const auto profile = SoundSpeedProfile::global_mean();
  const double one_speed = 4500 / profile.sound_speed_mps(0);
  EXPECT_GT(std::abs(profile.travel_time_s(0, 4500, 4500) - one_speed), 0.02);
}

TEST(SoundSpeedProfile, WaterStaysConstantOutsideOfTheTableButPressureGrows) {
  const auto profile =
      SoundSpeedProfile::from_water({{10, 12, 35}, {50, 8, 34}}, SoundSpeedModel::kMackenzie1981, 0);
  EXPECT_EQ(profile.water(0).temperature_degc, 12);
  EXPECT_EQ(profile.water(5000).salinity_psu, 34);
  EXPECT_NEAR(profile.water(30).temperature_degc, 10, tolerance(1e-14));
  EXPECT_EQ(profile.sound_speed_mps(5000), mackenzie_1981(8, 34, 5000));
  EXPECT_EQ(profile.sound_speed_mps(-3), mackenzie_1981(12, 35, 0));
}

TEST(SoundSpeedProfile, TheFormulaMovesTheSpeed) {
  const double mackenzie = SoundSpeedProfile::global_mean().sound_speed_mps(3000);
  const double unesco =
      SoundSpeedProfile::global_mean(SoundSpeedModel::kUnescoChenMillero).sound_speed_mps(3000);
  EXPECT_NE(mackenzie, unesco);
  EXPECT_NEAR(mackenzie, unesco, tolerance(1.0));
}

TEST(SoundSpeedProfile, ATableOfSpeedsIsConstantBelowItsLastRow) {
  const auto profile = SoundSpeedProfile::from_speeds({{0, 1500}, {100, 1490}}, kAssumed);
  EXPECT_EQ(profile.sound_speed_mps(4000), 1490);
  EXPECT_NEAR(profile.sound_speed_mps(25), 1497.5, tolerance(1e-12));
  EXPECT_EQ(profile.water(50).temperature_degc, kAssumed.temperature_degc);
}

TEST(SoundSpeedProfile, RefusesImpossibleTables) {
  const auto water = [](std::vector<WaterRow> rows) {
    return SoundSpeedProfile::from_water(std::move(rows), SoundSpeedModel::kMackenzie1981, 0);
  };
  EXPECT_THROW(water({}), InvalidArgument);
  EXPECT_THROW(water({{0, 10, 35}, {0, 10, 35}}), InvalidArgument);
  EXPECT_THROW(water({{10, 10, 35}, {5, 10, 35}}), InvalidArgument);
  EXPECT_THROW(water({{0, std::nan(""), 35}}), InvalidArgument);
  EXPECT_THROW(water({{0, 10, -1}}), InvalidArgument);
  EXPECT_THROW(SoundSpeedProfile::from_speeds({{0, 343}}, kAssumed), InvalidArgument);  // the speed in air
}

}  // namespace
}  // namespace halocline::acoustics
