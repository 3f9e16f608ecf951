// SPDX-License-Identifier: BSD-3-Clause
// Links near the surface, under ice and with a tide, as link tables and packets see them.
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>

#include <gtest/gtest.h>

#include "acoustics/fading/arrival.h"
#include "acoustics/modem/modem.h"
#include "acoustics/sea/ice_cover.h"
#include "acoustics/sea/sound_speed.h"
#include "channel_server/links/link_predictor.h"
#include "channel_server/propagation/environment_timeline.h"
#include "channel_server/propagation/path_search.h"
#include "channel_server/propagation/ray_propagation.h"
#include "channel_server/propagation/seabed_profile.h"
#include "channel_server/propagation/surface_ends.h"
#include "core/tide.h"
#include "tests/channel_server/channel_fixtures.h"
#include "tests/support/tolerance.h"

namespace halocline::channel_server {
namespace {

using halocline::testing::tolerance;
using testing::at_s;
using testing::even_water;
using testing::kSpeedMps;

struct Sea {
  double depth_m = 200, wind_mps = 5;
  std::string sediment = "SandyMud";
  acoustics::IceCover ice = {};
  Tide tide = {};
  acoustics::SoundSpeedProfile profile = even_water().profile;
};

RayModel model_over(const Sea& sea, std::optional<SurfaceEnds> near_surface) {
  RayModel model;
  model.bottom = *acoustics::sediment(sea.sediment);
  model.fading.enabled = true;
  model.bounces_follow_range = true;
  model.options.max_bounces = 0;
  model.options.min_boundary_factor = std::pow(10, -1.5);
  model.near_surface = std::move(near_surface);
  return model;
}

class NearSurfaceLink : public ::testing::Test {
 protected:
  Reception over(const Sea& sea, const RayModel& model, const Vec3& from, const Vec3& to, double time_s = 0) {
    acoustics::Environment water = even_water();
    water.profile = sea.profile;
    water.noise.wind_mps = sea.ice.covers() ? 0 : sea.wind_mps;
    water.ice = sea.ice;
    water.tide = sea.tide;
    RayPropagation propagation(std::make_shared<EnvironmentTimeline>(water),
                               std::make_shared<SeabedMap>(SeabedRule{}), model);
    return propagation.reception_over(
        at_s(time_s), {1, from, Vec3::Zero(), &modem_}, {2, to, Vec3::Zero(), &modem_},
        std::make_shared<const SeabedProfile>(SeabedProfile::flat(sea.depth_m)));
  }
  Reception level_link(const Sea& sea, double depth_m, double range_m,
                       const std::optional<SurfaceEnds>& ends) {
    return over(sea, model_over(sea, ends), {0, 0, depth_m}, {range_m, 0, depth_m});
  }
  double delivery(const Sea& sea, const Reception& reception) {
    LinkPredictor predictor({32, model_over(sea, {}).fading, {}});
    return predictor.forecast(*predictor.rates_of(modem_), modem_, modem_, reception).delivery_probability;
  }
  static double loss_db(const Reception& reception) { return reception.budget.transmission_loss.value; }
  // Loss by the powers of the paths, without what their phasors do.
  double power_loss_db(const Reception& reception) {
    return (modem_.source_level - total_level(reception.paths)).value;
  }

  acoustics::Modem modem_;
  SurfaceEnds fixed_{.seed = 1, .heaving = {1, 2}}, floating_{.seed = 1, .floating = {1, 2}};
};

TEST_F(NearSurfaceLink, InAGaleLosesTenDecibelsAndMoreAndDeliversLessThanHalf) {
  const Sea gale{.wind_mps = 14};
  const Reception shallow = level_link(gale, 0.5, 500, fixed_), deep = level_link(gale, 20, 500, fixed_);
  EXPECT_GT(loss_db(shallow), loss_db(deep) + 10);
  EXPECT_LT(delivery(gale, shallow), 0.5);
  EXPECT_GT(delivery(gale, deep), 0.9);
}

TEST_F(NearSurfaceLink, FloatingInABreezeIsWithinTwoDecibelsOfOneWithoutTheLayer) {
  Sea breeze{.wind_mps = 3};
  EXPECT_NEAR(power_loss_db(level_link(breeze, 0.5, 500, floating_)),
              power_loss_db(level_link(breeze, 0.5, 500, {})), 2);
  // In a mixed layer the phasors of the paths agree with that. In water of one speed Lloyd's mirror between
  // paths that differ by 1 mm deepens instead, as their losses become more alike.
  breeze.profile = acoustics::SoundSpeedProfile::from_water(
      {{0, 15, 35}, {200, 15, 35}}, acoustics::SoundSpeedModel::kMackenzie1981, to_radians(45));
  EXPECT_NEAR(loss_db(level_link(breeze, 0.5, 500, floating_)), loss_db(level_link(breeze, 0.5, 500, {})), 2);
}

TEST_F(NearSurfaceLink, BetweenDeepEndsStaysAsItIs) {
  for (const double wind : {3.0, 8.0, 14.0}) {
    const Sea sea{.wind_mps = wind};
    const Reception with = over(sea, model_over(sea, fixed_), {0, 0, 20}, {800, 0, 60});
    const Reception without = over(sea, model_over(sea, {}), {0, 0, 20}, {800, 0, 60});
    EXPECT_NEAR(loss_db(with), loss_db(without), tolerance(0.1)) << wind;
    EXPECT_GT(with.share_under_water, 1 - 1e-12);
  }
}

TEST_F(NearSurfaceLink, FixedEndsDeliverForTheShareThatBothAreUnderWater) {
  const Sea gale{.wind_mps = 14};
  const Reception fixed = level_link(gale, 0.5, 200, fixed_),
                  floating = level_link(gale, 0.5, 200, floating_);
  EXPECT_NEAR(fixed.share_under_water, 0.675281858137 * 0.675281858137, tolerance(1e-9));
  EXPECT_EQ(floating.share_under_water, 1);
  EXPECT_NEAR(delivery(gale, fixed), fixed.share_under_water * delivery(gale, floating), tolerance(1e-9));
}

// (f / c) v |sin(angle)|, at each end.
TEST_F(NearSurfaceLink, HeaveSpreadsSteepPathsMost) {
  const Sea sea{.wind_mps = 10};
  const RayModel still = model_over(sea, SurfaceEnds{}), heaving = model_over(sea, fixed_);
  const Vec3 from(0, 0, 8), to(50, 0, 150);
  const Reception calm = over(sea, still, from, to), moved = over(sea, heaving, from, to);
  ASSERT_EQ(calm.paths.size(), moved.paths.size());
  const auto& [before, after] = std::pair(calm.paths.front(), moved.paths.front());
  const double speed = acoustics::surface_waves(10).heave_mps(8);
  const double spread = modem_.centre_frequency_hz / kSpeedMps * speed * std::sin(before.launch_angle_rad);
  EXPECT_NEAR(after.fading.doppler_spread_hz, std::hypot(before.fading.doppler_spread_hz, spread),
              tolerance(1e-6));
}

TEST_F(NearSurfaceLink, WithoutFadingNothingNearTheSurfaceActs) {
  const Sea gale{.wind_mps = 14};
  RayModel with = model_over(gale, fixed_), without = model_over(gale, {});
  with.fading.enabled = without.fading.enabled = false;
  const Reception a = over(gale, with, {0, 0, 0.5}, {500, 0, 0.5});
  const Reception b = over(gale, without, {0, 0, 0.5}, {500, 0, 0.5});
  EXPECT_EQ(a.budget.received_level, b.budget.received_level);
  EXPECT_EQ(a.share_under_water, 1);
}

TEST_F(NearSurfaceLink, IceReplacesWavesAndBubbles) {
  const Sea open{.depth_m = 50, .wind_mps = 12, .sediment = "MediumSand"};
  Sea ice = open;
  ice.ice = {.kind = acoustics::IceKind::kFast};
  const Vec3 from(0, 0, 20), to(400, 0, 30);
  const Reception under = over(ice, model_over(ice, fixed_), from, to);
  for (const Arrival& path : under.paths) {
    if (path.surface_bounces == 0) continue;
    const double sine = std::sqrt(path.surface_sine_squares / path.surface_bounces);
    EXPECT_NEAR(path.surface_loss_db, path.surface_bounces * (0.8 + 10 * sine), tolerance(1e-6));
    // Gamma^2 by the roughness of the ice.
    const double gamma = 2 * 2 * std::numbers::pi * modem_.centre_frequency_hz / 1500 * 0.2;
    const double coherent = std::exp(-gamma * gamma * path.surface_sine_squares);
    EXPECT_LE(path.fading.coherent, coherent + 1e-9);
  }
  EXPECT_EQ(under.share_under_water, 1);
}

TEST_F(NearSurfaceLink, KeelsTakeTheirLossByTheKilometre) {
  Sea clear{.depth_m = 7.5, .sediment = "SandySilt", .ice = {.kind = acoustics::IceKind::kFast}};
  Sea keels = clear;
  keels.ice.keels_per_km = 2;
  keels.ice.keel_draft_m = 2;
  const Vec3 from(0, 0, 3), to(1500, 0, 4);
  const double lost = power_loss_db(over(keels, model_over(keels, fixed_), from, to)) -
                      power_loss_db(over(clear, model_over(clear, fixed_), from, to));
  EXPECT_NEAR(lost, 1.5 * 2.69397147795, tolerance(1e-6));
}

// An end that follows the tide at 5 m below the surface, one moored 20 m above a bottom 60 m below the mean
// surface: delays of the straight path and of the bounce at the bottom over a tidal day, by the geometry.
TEST_F(NearSurfaceLink, ABounceAtTheBottomFollowsTheTideWithinAMicrosecond) {
  const Sea sea{.depth_m = 60, .wind_mps = 0, .sediment = "MediumSand", .tide = {{{.amplitude_m = 1.5}}}};
  const RayModel model = model_over(sea, floating_);
  for (double t = 0; t < kLunarSemidiurnalS; t += 2713.7) {
    const double height = 1.5 * std::cos(2 * std::numbers::pi * t / kLunarSemidiurnalS);
    const Vec3 from(0, 0, 5 - height), to(300, 0, 40);
    const Reception reception = over(sea, model, from, to, t);
    const auto bounce = std::find_if(reception.paths.begin(), reception.paths.end(), [](const Arrival& path) {
      return path.bottom_bounces == 1 && path.surface_bounces == 0;
    });
    ASSERT_NE(bounce, reception.paths.end()) << t;
    EXPECT_NEAR(bounce->delay_s, std::hypot(300, 55 + height + 20) / kSpeedMps, tolerance(1e-6)) << t;
    const auto surface = std::find_if(
        reception.paths.begin(), reception.paths.end(),
        [](const Arrival& path) { return path.bottom_bounces == 0 && path.surface_bounces == 1; });
    ASSERT_NE(surface, reception.paths.end()) << t;
    EXPECT_NEAR(surface->delay_s, std::hypot(300, 5 + 40 + height) / kSpeedMps, tolerance(1e-6)) << t;
  }
}

}  // namespace
}  // namespace halocline::channel_server
