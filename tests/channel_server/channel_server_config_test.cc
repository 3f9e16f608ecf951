// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/channel_server_config.h"

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
#include "tests/channel_server/channel_fixtures.h"
#include "tests/channel_server/read_config.h"

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
      "wind_mps = 7\nshipping = 0.25\nacidity_ph = 7.9\nabsorption_model = \"thorp\"");
  EXPECT_EQ(water.profile.water(50).temperature_degc, 15);
  EXPECT_EQ(water.noise.wind_mps, 7);
  EXPECT_EQ(water.noise.shipping, 0.25);
  EXPECT_EQ(water.ph, 7.9);
  EXPECT_EQ(water.absorption_model, acoustics::AbsorptionModel::kThorp1967);
}

TEST(ChannelServerConfig, ATableOfSpeedsIsTaken) {
  const auto water = water_of(
      "[environment]\nprofile = \"speed-table\"\nspeed_depths_m = [0, 100]\nspeeds_mps = [1500, 1520]\n"
      "assumed_temperature_degc = 4");
  EXPECT_EQ(water.profile.sound_speed_mps(50), 1510);
  EXPECT_EQ(water.profile.water(50).temperature_degc, 4);
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
  EXPECT_THAT(errors_of("[environment]\nprofile = \"speed-table\"\nspeeds_mps = [1500]"),
              HasSubstr("speeds_mps"));
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

TEST(ChannelServerConfig, WhatRaysLookForIsTaken) {
  const auto rays = make_rays(
      read("[propagation]\nfading = \"none\"\nsurface_loss_model = \"eckart\"\nsolver = "
           "\"arcs\"\nmax_bounces = 12\n"
           "max_launch_angle_deg = 60\nmin_amplitude_db = -80\nshadow_loss_db = 110\ncoherent = true"));
  EXPECT_EQ(rays.surface, acoustics::SurfaceModel::kEckart);
  EXPECT_EQ(rays.solver, acoustics::RaySolver::kArcs);
  EXPECT_EQ(rays.options.max_bounces, 12);
  EXPECT_FALSE(rays.bounces_follow_range);
  EXPECT_FALSE(make_rays(read("[propagation]\nmax_bounces = 0")).bounces_follow_range);
  EXPECT_DOUBLE_EQ(rays.options.max_launch_angle_rad, to_radians(60));
  EXPECT_DOUBLE_EQ(rays.options.min_amplitude, 1e-4);
  EXPECT_EQ(rays.shadow_loss->value, 110);
  EXPECT_TRUE(rays.coherent);
}

TEST(ChannelServerConfig, ALossOfTheCoherentPartAloneIsRefusedInASeaThatFades) {
  const std::string errors = errors_of("[propagation]\nsurface_loss_model = \"eckart\"");
  EXPECT_THAT(errors, HasSubstr("test.toml:2: propagation.surface_loss_model"));
  EXPECT_THAT(errors, HasSubstr("apl-bubbles"));
}

TEST(ChannelServerConfig, FadingIsTaken) {
  const auto fading =
      make_rays(read("[propagation]\nrice_factor_db = 3\nmedium_coherence_s = 5\nlarge_scale_fading_db = 1\n"
                     "large_scale_fading_s = 60\nbottom_roughness_m = 0.1"))
          .fading;
  EXPECT_EQ(fading, (acoustics::FadingModel{.enabled = true,
                                            .rice_factor_db = 3,
                                            .medium_coherence_s = 5,
                                            .large_scale_db = 1,
                                            .large_scale_time_s = 60,
                                            .bottom_roughness_m = 0.1}));
  EXPECT_FALSE(make_rays(read("[propagation]\nfading = \"none\"")).fading.enabled);
  EXPECT_EQ(make_rays(read("[propagation]\nreverberation = \"lambert\"\nbottom_scattering_db = -30\n"
                           "surface_scattering_db = -35\nreverberation_bounce_loss_db = 2"))
                .reverberation,
            (acoustics::Reverberation{true, -30, -35, 2}));
  EXPECT_THAT(errors_of("[propagation]\nfading = \"none\"\nreverberation = \"lambert\""),
              HasSubstr("reverberation"));
}

TEST(ChannelServerConfig, AnUnknownSedimentIsRefusedWithLineKeyAndWhatIsAllowed) {
  const std::string errors = errors_of("[propagation]\nsediment = \"Porridge\"");
  EXPECT_THAT(errors, HasSubstr("test.toml:2"));
  EXPECT_THAT(errors, HasSubstr("sediment"));
  EXPECT_THAT(errors, HasSubstr("MediumSand"));
}

TEST(ChannelServerConfig, ChangesOfTheWaterHoldFromTheirInstantsAndSetTheirKeysOnly) {
  const auto config = read(
      "[environment]\nwind_mps = 3\n[[environment_change]]\nat_s = 10\nshipping = 0.75\n"
      "[[environment_change]]\nat_s = 20\nwind_mps = 9\nprofile = \"isovelocity\"\nisovelocity_mps = 1450");
  EnvironmentTimeline timeline(make_environment(config.environment, {}));
  schedule_changes(config, {}, timeline);
  const auto at = [&](double time_s) { return timeline.at(SimTime::from_seconds(time_s)); };
  EXPECT_EQ(at(9).noise.shipping, 0.5);
  EXPECT_EQ(at(10).noise.shipping, 0.75);
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
