// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/channel_server_config.h"

#include <string>
#include <tuple>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "acoustics/modem/beam_pattern.h"
#include "acoustics/modem/error_model.h"
#include "acoustics/modem/modem.h"
#include "acoustics/sea/absorption.h"
#include "acoustics/sea/boundary_reflection.h"
#include "channel_server/modems/modem_config.h"
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

acoustics::Environment water_of(const std::string& toml) {
  return make_environment(read(toml).environment, {});
}

TEST(ChannelServerConfig, AnEmptyScenarioHasTheWaterOfTheReferenceFiguresInABreeze) {
  const auto water = water_of("");
  EXPECT_EQ(water.noise.shipping, 0.5);
  EXPECT_EQ(water.noise.wind_mps, 5);
  EXPECT_EQ(to_name(water.absorption_model), "francois-garrison");
  EXPECT_EQ(water.profile.row_depths_m().size(), 15u);
}

TEST(ChannelServerConfig, EveryBuiltInProfileCanBeNamed) {
  for (const std::string name :
       {"global-mean", "global-mean-salinity-35", "harris-zorzi", "munk", "isovelocity"}) {
    EXPECT_GT(water_of("[environment]\nprofile = \"" + name + "\"").profile.sound_speed_mps(500), 1400)
        << name;
  }
}

TEST(ChannelServerConfig, ATableOfWaterIsTaken) {
  const auto water = water_of(
      "[environment]\nprofile = \"water-table\"\nwater_rows = [[0, 20, 35], [100, 10, 36]]\n"
      "wind_mps = 7\nshipping = 0.25\nspreading_exponent = 2\nabsorption_model = \"thorp\"\n"
      "sound_speed_model = \"unesco\"");
  EXPECT_EQ(water.profile.water(50).temperature_degc, 15);
  EXPECT_EQ(water.noise.wind_mps, 7);
  EXPECT_EQ(water.noise.shipping, 0.25);
  EXPECT_EQ(water.spreading_exponent, 2);
  EXPECT_EQ(water.absorption_model, acoustics::AbsorptionModel::kThorp1967);
  EXPECT_EQ(to_name(water.profile.model()), "unesco");
}

TEST(ChannelServerConfig, WaterIsAssumedWhereAProfileHasSpeedsAlone) {
  const auto water = water_of(
      "[environment]\nprofile = \"isovelocity\"\nisovelocity_mps = 1450\n"
      "assumed_temperature_degc = 4\nassumed_salinity_psu = 1");
  EXPECT_EQ(water.profile.sound_speed_mps(50), 1450);
  EXPECT_EQ(water.profile.water(50).temperature_degc, 4);
  EXPECT_EQ(water.profile.water(50).salinity_psu, 1);
}

TEST(ChannelServerConfig, AGriddedFileGivesTheColumnAtTheOriginAtOneOfItsTimes) {
  ocean::testing::SeaFile warm, salty;
  warm.time.values = salty.time.values = {0, 1};
  warm.degrees = [](double hours, double, double, double) { return 10 + hours; };
  warm.salinity = {{"standard_name", "none"}};
  const auto config =
      read("[environment]\nprofile = \"file\"\nprofile_time_index = 1\nprofile_file = \"" +
           warm.write("warm") + "\"\nprofile_salinity_file = \"" + salty.write("salty") + "\"");
  bus::Scenario scenario;
  scenario.origin_latitude_deg = 43.2;
  scenario.origin_longitude_deg = 7.3;
  const auto water = make_environment(config.environment, scenario);
  EXPECT_NEAR(water.profile.water(50).temperature_degc, 11, 1e-4);
  EXPECT_NEAR(water.profile.water(50).salinity_psu, 36, 1e-4);
}

TEST(ChannelServerConfig, AFileThatIsNotThereIsAnErrorThatNamesIt) {
  try {
    water_of("[environment]\nprofile = \"file\"\nprofile_file = \"no-such.csv\"");
    FAIL();
  } catch (const InvalidArgument& error) {
    EXPECT_THAT(error.what(),
                HasSubstr("test.toml:3: environment.profile_file is 'no-such.csv'; cannot read"));
  }
}

TEST(ChannelServerConfig, TheScenariosSurfaceAndLatitudeEnterTheWater) {
  bus::Scenario scenario;
  scenario.sea_surface_z_m = -1.5;
  scenario.origin_latitude_deg = 60;
  const auto water = make_environment({}, scenario);
  EXPECT_EQ(water.sea_surface_z_m, -1.5);
  EXPECT_NEAR(water.latitude_rad, 1.0472, 1e-4);
}

TEST(ChannelServerConfig, RatesAndTimesAreTaken) {
  const auto rules =
      read("[channel_server]\nlink_rate_hz = 4\nstate_lag_s = 0.1\nstate_timeout_s = 3\n").rules;
  EXPECT_EQ(rules.link_period, for_s(0.25));
  EXPECT_EQ(rules.position.state_lag, for_s(0.1));
  EXPECT_EQ(rules.position.state_timeout, for_s(3));
}

TEST(ChannelServerConfig, SharesOfTheWorkAreTaken) {
  const auto rules =
      read("[channel_server]\nthreads = 2\nshards = 3\nshard = 1\npredicted_payload_bytes = 16").rules;
  EXPECT_EQ(rules.threads, 2);
  EXPECT_EQ(rules.medium.shard.count, 3);
  EXPECT_EQ(rules.medium.shard.index, 1);
  EXPECT_EQ(rules.predicted_payload_bytes, 16);
}

TEST(ChannelServerConfig, EveryErrorIsReportedAtOnceWithItsPlace) {
  const std::string errors = errors_of(
      "[environment]\nwind_mps = 99\nprofile = \"lake\"\n[modem]\nbandwidth_hz = 60000\n"
      "[channel_server]\nlink_rate = 3\n");
  EXPECT_THAT(errors, HasSubstr("test.toml:2"));
  EXPECT_THAT(errors, HasSubstr("profile"));
  EXPECT_THAT(errors, HasSubstr("bandwidth_hz"));
  EXPECT_THAT(errors, HasSubstr("link_rate"));
}

TEST(ChannelServerConfig, ImpossibleTablesAreErrorsOfTheFile) {
  EXPECT_THAT(
      errors_of("[environment]\nprofile = \"water-table\"\nwater_rows = [[100, 20, 35], [0, 10, 36]]"),
      HasSubstr("water_rows"));
  EXPECT_THAT(errors_of("[environment]\nprofile = \"water-table\""), HasSubstr("water_rows"));
  EXPECT_THAT(errors_of("[environment]\nprofile = \"file\""), HasSubstr("profile_file"));
}

TEST(ChannelServerConfig, WhatIsPrintedReadsBackTheSame) {
  ChannelServerConfig config =
      read("[environment]\nprofile = \"munk\"\n[channel_server]\nlink_rate_hz = 3\n");
  const std::string printed = bus::to_toml([&](bus::ConfigVisitor& v) { visit(v, config); }, true);
  ChannelServerConfig again = read(printed);
  EXPECT_EQ(again.environment.profile.source, ProfileSource::kMunk);
  EXPECT_EQ(again.rules.link_period, config.rules.link_period);
  EXPECT_EQ(again.modem, config.modem);
}

TEST(ChannelServerConfig, EveryProfilePrintedReadsBackTheSame) {
  for (const std::string& profile : built_in_modems()) {
    ChannelServerConfig config;
    config.modem = load_modem(profile);
    config.modem.modem.directivity_index = {6};
    config.modem.max_payload_bytes = 20;
    config.modem.when_busy = WhenBusy::kQueue;
    set_rates_of(load_modem(profile), config.modem);
    const std::string printed = bus::to_toml([&](bus::ConfigVisitor& v) { visit(v, config); }, true);
    EXPECT_EQ(read(printed).modem, config.modem) << printed;
  }
}

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

TEST(ChannelServerConfig, FadingIsTaken) {
  const auto fading = make_rays(read("[propagation]\nlarge_scale_fading_db = 1\nlarge_scale_fading_s = 60\n"
                                     "bottom_roughness_m = 0.1\nscattering_loss = \"lambert\""))
                          .fading;
  EXPECT_EQ(fading, (acoustics::FadingModel{.enabled = true,
                                            .large_scale_db = 1,
                                            .large_scale_time_s = 60,
                                            .bottom_roughness_m = 0.1,
                                            .scattering_loss = true}));
}

TEST(ChannelServerConfig, ScatteredSoundStaysOnItsPathOrTurns) {
  EXPECT_FALSE(make_rays(read("[propagation]\nscattering = \"none\"")).fading.turns);
  const auto fading = make_rays(read("[propagation]\nscattering = \"turns\"\nbottom_slope = 0.1")).fading;
  EXPECT_TRUE(fading.turns);
  EXPECT_EQ(fading.bottom_slope, 0.1);
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
      "[environment]\nwind_mps = 3\n[[environment_change]]\nat_s = 10\nshipping = 0.75\nrain_mm_per_h = 4\n"
      "sea_surface_z_m = -1\n[[environment_change]]\nat_s = 20\nwind_mps = 9\nprofile = "
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
