// SPDX-License-Identifier: BSD-3-Clause
// Bubbles, waves and ice against values of their formulas in twelve digits.
#include <cmath>

#include <gtest/gtest.h>

#include "acoustics/sea/boundary_reflection.h"
#include "acoustics/sea/ice_cover.h"
#include "acoustics/sea/surface/surface_boundary.h"
#include "acoustics/sea/surface/surface_layers.h"
#include "core/check.h"
#include "tests/support/tolerance.h"

namespace halocline::acoustics {
namespace {

using halocline::testing::relative_error;
using halocline::testing::tolerance;

constexpr double kTwelveDigits = 6e-12;  // of the last digit, half

struct BubbleRow {
  double wind_mps, khz, one_way_db, e_folding_m, level_db, slant_db;
};

class BubbleValues : public ::testing::TestWithParam<BubbleRow> {};

// Level at 0.5 m, and straight from 0.5 to 20 m, both over 500 m.
TEST_P(BubbleValues, AreThoseOfTheFormulas) {
  const BubbleRow& row = GetParam();
  const BubbleLayer layer = bubble_layer(row.wind_mps, row.khz * 1000);
  EXPECT_LT(relative_error(layer.one_way_db, row.one_way_db), tolerance(kTwelveDigits));
  EXPECT_LT(relative_error(layer.e_folding_m, row.e_folding_m), tolerance(kTwelveDigits));
  EXPECT_LT(relative_error(layer.straight_loss_db(0.5, 0.5, 500), row.level_db), tolerance(kTwelveDigits));
  EXPECT_LT(relative_error(layer.straight_loss_db(0.5, 20, std::hypot(500, 19.5)), row.slant_db),
            tolerance(kTwelveDigits));
}

INSTANTIATE_TEST_SUITE_P(
    Winds, BubbleValues,
    ::testing::Values(BubbleRow{5, 25, 0.0487678536067, 0.4, 17.4652799886, 0.358534508457},
                      BubbleRow{10, 25, 0.361068462636, 0.6875, 126.892608852, 4.47717889154},
                      BubbleRow{14, 25, 0.612365299493, 1.1475, 172.580933824, 10.1634442529},
                      BubbleRow{10, 11.5, 0.186609484756, 0.6875, 65.5813697615, 2.31392140984}));

TEST(BubbleLayer, TwoWaysThroughItAreABounce) {
  for (const double wind : {0.0, 2.0, 5.0, 6.0, 10.0, 14.0}) {
    const BubbleLayer layer = bubble_layer(wind, 25'000);
    for (const double grazing : {0.2, 0.7, 1.5}) {
      const double bounce = surface_loss_db({SurfaceModel::kAplBubbles, wind}, grazing, 25'000);
      const double both = 2 * layer.straight_loss_db(0, 100, 100 / std::sin(grazing));
      EXPECT_NEAR(both, bounce, tolerance(1e-9)) << wind << " " << grazing;
    }
  }
}

TEST(SurfaceWaves, LeaveAnEndUnderWaterForTheShareOfTheirHeights) {
  EXPECT_NEAR(surface_waves(14).share_under_water(0.5), 0.675281858137, tolerance(1e-12));
  EXPECT_NEAR(surface_waves(10).share_under_water(1), 0.962610556854, tolerance(1e-12));
  EXPECT_NEAR(surface_waves(14).share_under_water(5), 0.999997259159, tolerance(1e-12));
  EXPECT_NEAR(surface_waves(5).share_under_water(0.3), 0.983749005274, tolerance(1e-12));
  EXPECT_EQ(surface_waves(0).share_under_water(0), 1);
  EXPECT_EQ(surface_waves(0).share_under_water(-0.1), 0);
}

TEST(SurfaceWaves, LeaveAPathClearByTheirWavelengthsAlongIt) {
  EXPECT_NEAR(surface_waves(10).clear_share(1, 500), 0.7659235052794936, tolerance(1e-12));
  EXPECT_EQ(surface_waves(0).clear_share(0, 500), 1);
}

TEST(SurfaceWaves, HeaveDecaysWithDepth) {
  const SurfaceWaves waves = surface_waves(10);
  EXPECT_NEAR(waves.heave_mps(0), 0.679, tolerance(0.0005));
  const double omega = waves.mean_frequency_radps;
  EXPECT_NEAR(waves.heave_mps(5) / waves.heave_mps(0), std::exp(-omega * omega * 5 / 9.8), tolerance(1e-12));
  EXPECT_EQ(surface_waves(0).heave_mps(0), 0);
}

TEST(SurfaceBoundary, OfWavesHasTheirSlopesAndTheBubblesOfABounce) {
  EXPECT_NEAR(wave_slope_variance(1), 0.00170645589288, tolerance(1e-14));
  EXPECT_NEAR(wave_slope_variance(5), 0.00910987029007, tolerance(1e-14));
  EXPECT_NEAR(wave_slope_variance(10), 0.0122983473207, tolerance(1e-13));
  EXPECT_NEAR(wave_slope_variance(15), 0.0141634868179, tolerance(1e-13));
  EXPECT_EQ(wave_slope_variance(0.2), wave_slope_variance(1));
  const SurfaceBoundary waves = surface_boundary(10, {}, 25'000);
  EXPECT_EQ(waves.rms_height_m, rms_wave_height_m(10));
  EXPECT_EQ(waves.slope_variance, wave_slope_variance(10));
  const double steep = surface_loss_db({SurfaceModel::kAplBubbles, 10}, std::asin(0.5), 25'000);
  EXPECT_NEAR(waves.kept_power(0.5), std::pow(10, -steep / 10), tolerance(1e-12));
  EXPECT_EQ(waves.bounce_db(1e-6), kMaxBubbleBounceDb);
  EXPECT_EQ(surface_boundary(0, {}, 25'000).kept_power(1e-6), 1);
}

TEST(SurfaceBoundary, OfIceIsThatOfItsCoverWhateverTheWind) {
  const IceCover fast{.kind = IceKind::kFast};
  const SurfaceBoundary under = surface_boundary(20, fast, 10'000);
  EXPECT_EQ(under.rms_height_m, 0.2);
  EXPECT_NEAR(under.slope_variance, 0.0064, tolerance(1e-15));
  EXPECT_EQ(under.mean_frequency_radps, 0);
  EXPECT_TRUE(under.is_still);
  EXPECT_NEAR(under.bounce_db(0.3), 0.8 + 10 * 0.3, tolerance(1e-12));
  EXPECT_NEAR(under.kept_power(0.3), std::pow(10, -0.38), tolerance(1e-12));
  EXPECT_FALSE(surface_boundary(20, {.kind = IceKind::kPack}, 10'000).is_still);
}

TEST(IceCover, TakesTheLossOfABounceFromRays) {
  const RaySurface surface{.wind_mps = 12,
                           .ice = {.kind = IceKind::kFast, .loss_db = 1, .loss_per_sine_db = 6}};
  const double loss = 1 + 6 * 0.5;
  EXPECT_NEAR(surface_loss_db(surface, std::asin(0.5), 10'000), loss, tolerance(1e-9));
  EXPECT_NEAR(SurfaceLoss(surface, 10'000).db_at_sine(0.5), loss, tolerance(1e-12));
  EXPECT_NEAR(surface_magnitude(surface, std::asin(0.5), 10'000), std::pow(10, -loss / 20), tolerance(1e-9));
}

TEST(IceCover, KeelsTakeTheirShareOfTheDepth) {
  IceCover ice{.kind = IceKind::kFast, .keels_per_km = 2, .keel_draft_m = 2};
  EXPECT_NEAR(keel_loss_db_per_km(ice, 7.5), 2.69397147795, tolerance(1e-11));
  EXPECT_NEAR(keel_loss_db_per_km(ice, 1), 2 * 20, tolerance(1e-9));  // at most 99 %
  EXPECT_EQ(keel_loss_db_per_km(ice, 0), 0);
  ice.kind = IceKind::kNone;
  EXPECT_EQ(keel_loss_db_per_km(ice, 7.5), 0);
}

TEST(IceCover, ImpossibleNumbersAreRefused) {
  EXPECT_NO_THROW(validate(IceCover{}));
  EXPECT_THROW(validate(IceCover{.roughness_m = -1}), InvalidArgument);
  EXPECT_THROW(validate(IceCover{.slope = 2}), InvalidArgument);
  EXPECT_THROW(validate(IceCover{.keels_per_km = 1000}), InvalidArgument);
}

}  // namespace
}  // namespace halocline::acoustics
