// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "acoustics/math/arc_math.h"
#include "acoustics/sea/boundary_reflection.h"
#include "core/check.h"
#include "core/units.h"
#include "tests/acoustics/reference_rows.h"
#include "tests/support/csv.h"

namespace halocline::acoustics {
namespace {

using testing::CsvRow;
using testing::tolerance;

const char* const kReflections = "bottom_reflection_rayleigh_apl9407.csv";

FluidBottom bottom_of(const CsvRow& row) {
  return {row.number("density_ratio"), row.number("sound_speed_ratio"), 0, row.number("loss_parameter_delta"),
          BottomLoss::kComplexWaveNumber};
}

Reflection reflection_of(const CsvRow& row) {
  return bottom_reflection(bottom_of(row), to_radians(row.number("grazing_deg")), 1500);
}

TEST(AngleOf, IsAtan2InEveryQuadrant) {
  for (int i = -3600; i <= 3600; ++i) {
    const double angle = i * std::numbers::pi / 3600, length = 1 + i % 7 * 0.1;
    const double y = length * std::sin(angle), x = length * std::cos(angle);
    // Two roundings of an angle up to pi.
    EXPECT_NEAR(angle_of(y, x), std::atan2(y, x), tolerance(1e-15)) << i;
  }
  EXPECT_EQ(angle_of(0, 1), 0);
  EXPECT_EQ(angle_of(0, 0), 0);
  EXPECT_EQ(angle_of(1e-300, 1), 1e-300);
}

TEST(BottomReflection, MatchesRayleighForTheSedimentsOfTr9407) {
  expect_column(kReflections, "abs_V", [](const CsvRow& row) { return reflection_of(row).magnitude; });
  expect_column(kReflections, "arg_V_rad(conv n=(1+i*delta)/cr)",
                [](const CsvRow& row) { return -reflection_of(row).phase_rad; });
  expect_decibels(kReflections, "bottom_loss_dB",
                  [](const CsvRow& row) { return reflection_of(row).loss_db(); });
}

TEST(BottomReflection, SedimentsByNameAreTheOnesOfTheTable) {
  for (const CsvRow& row : testing::read_reference_csv(std::string("acoustics/") + kReflections)) {
    ASSERT_TRUE(sediment(row.text("sediment"))) << row.text("sediment");
    EXPECT_EQ(*sediment(row.text("sediment")), bottom_of(row)) << row.text("sediment");
  }
}

TEST(BottomReflection, EverySedimentOfTr9407IsKnownWithinThePrintOfItsPolynomials) {
  for (const CsvRow& row : testing::read_reference_csv("acoustics/sediments_apl_uw_tr9407.csv")) {
    const std::optional<FluidBottom> known = sediment(row.text("sediment"));
    ASSERT_TRUE(known) << row.text("sediment");
    EXPECT_NEAR(known->loss_parameter, row.number("loss_delta_table"), tolerance(1e-12));
    if (!row.has_number("speed_ratio_bellhop_poly")) continue;
    // The table prints four digits, the polynomials five.
    EXPECT_NEAR(known->sound_speed_ratio, row.number("speed_ratio_bellhop_poly"), tolerance(1e-4));
    EXPECT_NEAR(known->density_ratio, row.number("density_ratio_bellhop_poly"), tolerance(1e-3));
  }
  EXPECT_EQ(sediment_names().size(), 22U);
  EXPECT_FALSE(sediment("Cheese"));
}

TEST(BottomReflection, ReflectsAllBelowTheCriticalAngleOfALosslessFastBottom) {
  const FluidBottom lossless{1.9, 1.1, 0, 0, BottomLoss::kComplexWaveNumber};
  const double critical = std::acos(1 / 1.1);
  EXPECT_NEAR(bottom_reflection(lossless, 0.9 * critical, 1500).magnitude, 1, tolerance(1e-15));
  EXPECT_LT(bottom_reflection(lossless, 1.1 * critical, 1500).magnitude, 0.7);
}

TEST(BottomReflection, AtNormalIncidenceIsTheRatioOfImpedances) {
  const FluidBottom lossless{1.9, 1.1, 0, 0, BottomLoss::kComplexWaveNumber};
  const double z = 1.9 * 1.1;
  EXPECT_NEAR(bottom_reflection(lossless, std::numbers::pi / 2, 1500).magnitude, (z - 1) / (z + 1),
              tolerance(1e-15));
}

TEST(BottomReflection, TurnsThePhaseByPiAtGrazing) {
  EXPECT_NEAR(std::abs(bottom_reflection(*sediment("MediumSand"), 1e-9, 1500).phase_rad), std::numbers::pi,
              tolerance(1e-6));
}

TEST(BottomReflection, SpeedGivenInMetresPerSecondDependsOnTheWaterAbove) {
  const FluidBottom absolute = fluid_bottom(1.9, 1650, 0.8);
  EXPECT_NE(bottom_reflection(absolute, 0.3, 1500).magnitude,
            bottom_reflection(absolute, 0.3, 1480).magnitude);
  const FluidBottom ratio = *sediment("MediumSand");
  EXPECT_EQ(bottom_reflection(ratio, 0.3, 1500).magnitude, bottom_reflection(ratio, 0.3, 1480).magnitude);
}

TEST(BottomReflection, AttenuationIsStatedInDecibelsPerWavelength) {
  // Over one wavelength a wave of wave number k (1 + i delta) falls by e^(-2 pi delta).
  const double delta = loss_parameter_from_attenuation(0.8);
  EXPECT_NEAR(-20 * std::log10(std::exp(-2 * std::numbers::pi * delta)), 0.8, tolerance(1e-14));
}

TEST(BottomReflection, TheTwoConventionsOfLossDifferInSecondOrder) {
  FluidBottom bottom = fluid_bottom(1.9, 1650, 0.8);
  const double speed = bottom_reflection(bottom, to_radians(24), 1500).loss_db();
  bottom.loss = BottomLoss::kComplexWaveNumber;
  const double number = bottom_reflection(bottom, to_radians(24), 1500).loss_db();
  EXPECT_GT(std::abs(speed - number), 1e-3);
  EXPECT_LT(std::abs(speed - number), 0.05);
}

TEST(BottomReflection, RefusesABottomOfTwoSpeedsOrNone) {
  EXPECT_THROW(validate(FluidBottom{1.9, 1.1, 1650, 0.01, BottomLoss::kComplexSpeed}), InvalidArgument);
  EXPECT_THROW(validate(FluidBottom{1.9, 0, 0, 0.01, BottomLoss::kComplexSpeed}), InvalidArgument);
  EXPECT_THROW(fluid_bottom(1.9, 1650, 60), InvalidArgument);
}

double surface_loss_of(SurfaceModel model, const CsvRow& row) {
  return surface_loss_db({model, row.number("wind_m_per_s")}, to_radians(row.number("grazing_deg")),
                         khz_to_hz(row.number("f_kHz")));
}

TEST(SurfaceLoss, MatchesTheFourPublishedForms) {
  const std::string file = "surface_loss.csv";
  expect_column(file, "loss_APL9407_bubble_dB",
                [](const CsvRow& row) { return surface_loss_of(SurfaceModel::kAplBubbles, row); });
  expect_column(file, "h_rms_PM_0p22w2_over_4g_m",
                [](const CsvRow& row) { return rms_wave_height_m(row.number("wind_m_per_s")); });
  expect_column(file, "loss_Eckart_coherent_dB",
                [](const CsvRow& row) { return surface_loss_of(SurfaceModel::kEckart, row); });
  expect_column(file, "loss_Coates1988_BS_dB(wind in knots inside)",
                [](const CsvRow& row) { return surface_loss_of(SurfaceModel::kCoates, row); });
  expect_column(file, "loss_Jones2009_BS_dB",
                [](const CsvRow& row) { return surface_loss_of(SurfaceModel::kJones, row); });
}

TEST(SurfaceLoss, AStillSeaReflectsAllByTheDefaultModel) {
  EXPECT_EQ(surface_magnitude(RaySurface{}, 0.2, 25e3), 1);
  EXPECT_EQ(surface_loss_db(RaySurface{SurfaceModel::kFlat, 20}, 0.2, 25e3), 0);
}

TEST(SurfaceLoss, GrowsWithWindInEveryModelButTheFlatOne) {
  for (const SurfaceModel model : {SurfaceModel::kAplBubbles, SurfaceModel::kEckart, SurfaceModel::kJones}) {
    EXPECT_GT(surface_loss_db({model, 12}, 0.2, 5e3), surface_loss_db({model, 6}, 0.2, 5e3))
        << to_name(model);
  }
  EXPECT_GT(surface_loss_db({SurfaceModel::kCoates, 12}, 0.2, 5e3),
            surface_loss_db({SurfaceModel::kCoates, 3}, 0.2, 5e3));
}

TEST(SurfaceLoss, ModelsAreKnownByName) {
  for (const SurfaceModel model : {SurfaceModel::kFlat, SurfaceModel::kAplBubbles, SurfaceModel::kEckart,
                                   SurfaceModel::kCoates, SurfaceModel::kJones}) {
    EXPECT_EQ(surface_model_from_name(to_name(model)), model);
  }
  EXPECT_FALSE(surface_model_from_name("glass"));
}

TEST(SurfaceLossAtManyAngles, IsThatOfOneAngleAtATime) {
  using Model = SurfaceModel;
  for (const Model model :
       {Model::kFlat, Model::kAplBubbles, Model::kEckart, Model::kCoates, Model::kJones}) {
    const RaySurface surface{model, 8};
    const SurfaceLoss loss(surface, 25e3);
    for (const double grazing : {0.02, 0.2, 0.7, 1.5}) {
      EXPECT_NEAR(loss.db_at_sine(std::sin(grazing)),
                  std::min(surface_loss_db(surface, grazing, 25e3), 400.0), tolerance(1e-9))
          << to_name(model) << " at " << grazing;
    }
  }
}

}  // namespace
}  // namespace halocline::acoustics
