// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <tuple>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "acoustics/fading/path_fading.h"
#include "acoustics/fading/slow_fading.h"
#include "acoustics/modem/beam_pattern.h"
#include "acoustics/modem/error_model.h"
#include "acoustics/modem/modem.h"
#include "acoustics/noise/noise_variation.h"
#include "acoustics/noise/place_noise.h"
#include "acoustics/prediction/platform_jitter.h"
#include "acoustics/sea/absorption.h"
#include "acoustics/sea/boundary_reflection.h"
#include "acoustics/sea/fine_structure.h"
#include "acoustics/sea/noise.h"
#include "acoustics/sea/profile_drift.h"
#include "bus/config/scenario.h"
#include "channel_server/channel_server_config.h"
#include "channel_server/modems/modem_config.h"
#include "channel_server/propagation/environment_timeline.h"
#include "channel_server/propagation/path_search.h"
#include "channel_server/water_model.h"
#include "core/check.h"
#include "core/units.h"
#include "tests/channel_server/channel_fixtures.h"
#include "tests/channel_server/read_config.h"
#include "tests/ocean/sea_file.h"

namespace halocline::channel_server {
namespace {

using testing::errors_of;
using testing::for_s;
using ::testing::HasSubstr;
using testing::read;

TEST(ChannelServerConfig, RaysOverSandAreTheDefault) {
  const auto config = read("");
  EXPECT_EQ(config.propagation.model, PropagationModel::kRays);
  EXPECT_EQ(make_rays(config).bottom, *acoustics::sediment("MediumSand"));
  EXPECT_FALSE(make_rays(config).solver);
  EXPECT_EQ(make_rays(config).shadow_loss->value, 120);
  EXPECT_TRUE(make_rays(config).fading.enabled);
  EXPECT_FALSE(make_rays(config).reverberation.enabled);
  EXPECT_TRUE(make_rays(config).bounces_follow_range);
}

TEST(ChannelServerConfig, ABottomIsGivenByNameOrByNumbers) {
  EXPECT_EQ(make_rays(read("[propagation]\nsediment = \"Clay\"")).bottom, *acoustics::sediment("Clay"));
  const auto custom = make_rays(
      read("[propagation]\nsediment = \"custom\"\nbottom_density_ratio = 2.1\nbottom_sound_speed_mps = 1800\n"
           "bottom_attenuation_db_per_wavelength = 0.5"));
  EXPECT_EQ(custom.bottom, acoustics::fluid_bottom(2.1, 1800, 0.5));
}

TEST(ChannelServerConfig, FineStructureIsTaken) {
  const auto options =
      make_rays(read("[propagation]\nfine_structure_mps = 0.1\ninternal_wave_m = 2")).options;
  EXPECT_EQ(options.fine_structure, (acoustics::FineStructure{.speed_mps = 0.1, .internal_wave_m = 2}));
}

TEST(ChannelServerConfig, ASeaThatDoesNotFadeIsSmoothedNowhere) {
  EXPECT_TRUE(make_rays(read("[propagation]\nfading = \"none\"")).options.fine_structure.is_perfect());
}

TEST(ChannelServerConfig, FadingIsTaken) {
  const auto fading = make_rays(read("[propagation]\nlarge_scale_fading_db = 1\nlarge_scale_fading_s = 60\n"
                                     "bottom_roughness_m = 0.1\nscattering = \"none\""))
                          .fading;
  EXPECT_EQ(fading, (acoustics::FadingModel{.enabled = true,
                                            .large_scale_db = 1,
                                            .large_scale_time_s = 60,
                                            .bottom_roughness_m = 0.1,
                                            .slow = {3, 21600, 1, 1},
                                            .platform_jitter_m = acoustics::kPlatformJitterM}));
}

TEST(ChannelServerConfig, ASlowSeaIsTaken) {
  const ChannelServerConfig config = read(
      "[environment]\nnoise_spread_db = 2\nnoise_spread_s = 1200\nprofile_spread_mps = 0.4\n"
      "[propagation]\nslow_fading_db = 2.5\nslow_fading_s = 9000\ntidal_fading_db = 0.5\ndaily_fading_db = "
      "0.7");
  EXPECT_EQ(config.propagation.fading.slow, (acoustics::SlowFading{2.5, 9000, 0.5, 0.7}));
  EXPECT_EQ(config.environment.noise_variation,
            (acoustics::NoiseVariation{.spread_db = 2, .spread_time_s = 1200}));
  bus::Scenario scenario;
  scenario.seed = 6;
  scenario.water_depth_m = 15;
  const acoustics::ProfileDrift drift = make_environment(config.environment, scenario).drift;
  EXPECT_EQ(drift.spread_mps, 0.4);
  EXPECT_EQ(drift.depth_m, 15);
  EXPECT_EQ(drift.seed, 6u);
  scenario.water_depth_m = 3000;
  EXPECT_EQ(make_environment(config.environment, scenario).drift.depth_m, 200);
}

TEST(ChannelServerConfig, ScatteredSoundStaysOnItsPathOrTurns) {
  EXPECT_FALSE(make_rays(read("[propagation]\nscattering = \"none\"")).fading.turns);
  const auto fading = make_rays(read("[propagation]\nscattering = \"turns\"\nbottom_slope = 0.1")).fading;
  EXPECT_TRUE(fading.turns);
  EXPECT_EQ(fading.bottom_slope, 0.1);
}

TEST(ChannelServerConfig, AScenarioHasASlowSeaWhereItFadesAndSaysNothingOfIt) {
  const ChannelServerConfig sea = read("");
  EXPECT_EQ(sea.propagation.fading.slow, (acoustics::SlowFading{3, 21600, 1, 1}));
  EXPECT_EQ(sea.environment.noise_variation,
            (acoustics::NoiseVariation{.spread_db = 3, .spread_time_s = 3600}));
  EXPECT_EQ(sea.environment.profile_spread_mps, 0.3);
  const ChannelServerConfig structs;
  EXPECT_FALSE(structs.propagation.fading.slow.any());
  EXPECT_EQ(structs.environment.noise_variation.spread_db, 0);
  for (const std::string way : {"none", "coherent"}) {
    const ChannelServerConfig still = read("[propagation]\nfading = \"" + way + "\"");
    EXPECT_EQ(still.environment.noise_variation.spread_db, 0) << way;
    EXPECT_EQ(still.environment.profile_spread_mps, 0) << way;
    const ChannelServerConfig given =
        read("[environment]\nnoise_spread_db = 2\nprofile_spread_mps = 0.1\n[propagation]\nfading = \"" +
             way + "\"");
    EXPECT_EQ(given.environment.noise_variation.spread_db, 2) << way;
    EXPECT_EQ(given.environment.profile_spread_mps, 0.1) << way;
  }
}

TEST(ChannelServerConfig, PathsFadeOrTheirPowersAddOrTheirPhasorsAdd) {
  for (const auto& [way, fades, coherent] :
       {std::tuple("sea", true, false), {"none", false, false}, {"coherent", false, true}}) {
    const RayModel rays = make_rays(read("[propagation]\nfading = \"" + std::string(way) + "\""));
    EXPECT_EQ(rays.fading.enabled, fades) << way;
    EXPECT_EQ(rays.coherent, coherent) << way;
  }
}

TEST(ChannelServerConfig, ReverberationNeedsASeaThatFades) {
  EXPECT_TRUE(make_rays(read("[propagation]\nreverberation = \"lambert\"")).reverberation.enabled);
  EXPECT_THAT(errors_of("[propagation]\nfading = \"none\"\nreverberation = \"lambert\""),
              HasSubstr("reverberation"));
}

TEST(ChannelServerConfig, TheDetailOfAnEmptyScenarioIsThatOfItsStructs) {
  const ChannelServerConfig structs, exact = read("[channel_server]\ndetail = \"exact\"");
  const RayModel &rays = exact.propagation.rays, &plain = structs.propagation.rays;
  EXPECT_EQ(rays.diffuse_below_noise, plain.diffuse_below_noise);
  EXPECT_EQ(rays.weak_below_diffuse, plain.weak_below_diffuse);
  EXPECT_EQ(rays.options, plain.options);
  EXPECT_EQ(rays.reuse_for_packets, plain.reuse_for_packets);
  EXPECT_EQ(rays.max_searches_per_tick, plain.max_searches_per_tick);
  EXPECT_EQ(exact.rules.reach.below_noise, structs.rules.reach.below_noise);
  EXPECT_EQ(exact.rules.reach.acquired_once_in, structs.rules.reach.acquired_once_in);
  EXPECT_EQ(exact.rules.reach.table_range_m, structs.rules.reach.table_range_m);
}

TEST(ChannelServerConfig, FastLeavesOutWeakSoundAndSearchesForHalfAsManyLinksAsVehicles) {
  const std::string vehicles =
      "[[vehicle]]\nname = \"a\"\n[[vehicle]]\nname = \"b\"\n[[vehicle]]\nname = \"c\"";
  const auto fast = read("[channel_server]\ndetail = \"fast\"\n" + vehicles);
  EXPECT_EQ(fast.propagation.rays.max_searches_per_tick, 2);
  EXPECT_TRUE(fast.propagation.rays.reuse_for_packets);
  EXPECT_EQ(fast.propagation.rays.weak_below_diffuse, Decibels{0});
  EXPECT_EQ(fast.rules.reach.table_range_m, 4000);
}

TEST(ChannelServerConfig, AnUnknownSedimentIsRefusedWithLineKeyAndWhatIsAllowed) {
  const std::string errors = errors_of("[propagation]\nsediment = \"Porridge\"");
  EXPECT_THAT(errors, HasSubstr("test.toml:2"));
  EXPECT_THAT(errors, HasSubstr("sediment"));
  EXPECT_THAT(errors, HasSubstr("MediumSand"));
}

TEST(ChannelServerConfig, ChangesOfTheWaterHoldFromTheirInstantsAndSetTheirKeysOnly) {
  const auto config = read(
      "[environment]\nwind_mps = 3\nprofile_spread_mps = 0\n[[environment_change]]\nat_s = 10\nshipping = "
      "0.75\n"
      "rain_mm_per_h = 4\nsea_surface_z_m = -1\n[[environment_change]]\nat_s = 20\nwind_mps = 9\nprofile = "
      "\"isovelocity\"\nisovelocity_mps = 1450");
  EnvironmentTimeline timeline(make_environment(config.environment, {}));
  schedule_changes(config, {}, timeline);
  const auto at = [&](double time_s) { return timeline.at(SimTime::from_seconds(time_s)); };
  EXPECT_EQ(at(9).noise.shipping, 0.5);
  EXPECT_EQ(at(10).noise.shipping, 0.75);
  EXPECT_EQ(at(10).noise.rain_mm_per_h, 4);
  EXPECT_EQ(at(10).sea_surface_z_m, -1);
  EXPECT_EQ(at(10).noise.wind_mps, 3);
  EXPECT_EQ(at(20).noise.wind_mps, 9);
  EXPECT_EQ(at(20).profile.sound_speed_mps(70), 1450);
}

TEST(ChannelServerConfig, ChangesOfTheWaterAreWrittenAsTheyWereRead) {
  ChannelServerConfig config = read("[[environment_change]]\nat_s = 10\nshipping = 0.75");
  const std::string toml = bus::to_toml([&](bus::ConfigVisitor& v) { visit(v, config); }, false);
  const auto again = read(toml).changes;
  ASSERT_EQ(again.size(), 1u);
  EXPECT_EQ(again[0].at_s, 10);
  EXPECT_EQ(again[0].shipping, 0.75);
  EXPECT_FALSE(again[0].wind_mps);
  EXPECT_FALSE(again[0].profile);
}

}  // namespace
}  // namespace halocline::channel_server
