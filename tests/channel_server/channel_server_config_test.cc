// SPDX-License-Identifier: BSD-3-Clause
#include "channel_server/channel_server_config.h"

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <tuple>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "acoustics/fading/slow_fading.h"
#include "acoustics/modem/beam_pattern.h"
#include "acoustics/modem/error_model.h"
#include "acoustics/modem/modem.h"
#include "acoustics/noise/place_noise.h"
#include "acoustics/sea/absorption.h"
#include "acoustics/sea/boundary_reflection.h"
#include "acoustics/sea/fine_structure.h"
#include "acoustics/sea/noise.h"
#include "acoustics/sea/profile_drift.h"
#include "bus/config/scenario.h"
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

// Level over the ambient noise of the open sea at 25 kHz, in powers.
double added_db(const std::string& toml) {
  const auto density = [](const std::string& text) {
    return acoustics::noise_power_density(25e3, noise_sources(read(text).environment)).value;
  };
  return 10 * std::log10(density(toml) - density("[environment]\nnoise_place = \"open\""));
}

TEST(ChannelServerConfig, ThePlaceOrWhatWasMeasuredThereAddsItsNoise) {
  EXPECT_NEAR(added_db("[environment]\nnoise_place = \"harbour\""), 52 - 17 * std::log10(1.25), 1e-9);
  EXPECT_NEAR(added_db("[environment]\nnoise_place = \"reef\"\n"
                       "site_noise = [[2, 60], [10, 55], [25, 50], [80, 40]]"),
              50, 1e-9);
  const std::string path = ::testing::TempDir() + "site-noise.csv";
  std::ofstream(path) << "frequency_khz,level_db\n1,70\n25,51\n";
  EXPECT_NEAR(added_db("[environment]\nsite_noise = \"" + path + "\""), 51, 1e-9);
  std::filesystem::remove(path);
}

TEST(ChannelServerConfig, NoiseOfAPlaceThatIsNoneIsRefused) {
  EXPECT_THAT(errors_of("[environment]\nnoise_place = \"moon\""), HasSubstr("harbour"));
  EXPECT_THAT(errors_of("[environment]\nsite_noise = [[2, 60], [1, 50]]"), HasSubstr("must rise"));
  EXPECT_THAT(errors_of("[environment]\nsite_noise = [[2, 60, 1]]"), HasSubstr("two numbers"));
  EXPECT_THAT(errors_of("[environment]\nsite_noise = \"gone.csv\""), HasSubstr("gone.csv"));
}

TEST(ChannelServerConfig, APlaceLeftToTheDepthIsAShelfOrOpen) {
  EnvironmentConfig config = read("[environment]\nnoise_place = \"by-depth\"").environment;
  EnvironmentConfig deep = config;
  ASSERT_TRUE(needs_depth(config));
  EXPECT_EQ(noise_sources(config).place, acoustics::NoisePlace::kOpen);
  use_depth(120, config);
  use_depth(900, deep);
  EXPECT_EQ(noise_sources(config).place, acoustics::NoisePlace::kShelf);
  EXPECT_EQ(noise_sources(deep).place, acoustics::NoisePlace::kOpen);
  EXPECT_FALSE(needs_depth(config) || needs_depth(deep));
  EXPECT_FALSE(
      needs_depth(read("[environment]\nnoise_place = \"by-depth\"\nsite_noise = [[1, 60]]").environment));
}

// Noon is 12 h local solar time: at 90 degrees east, six hours before that of Greenwich.
TEST(ChannelServerConfig, AReefSnapsAndIsLouderByNight) {
  const EnvironmentConfig reef = read("[environment]\nnoise_place = \"reef\"").environment;
  bus::Scenario scenario;
  const acoustics::NoiseVariation from_noon = make_noise_variation(reef, scenario);
  EXPECT_EQ(from_noon.day_night_db, 4);
  EXPECT_EQ(from_noon.noon_s, 0);
  EXPECT_TRUE(from_noon.has_bursts());
  EXPECT_FALSE(from_noon.draws_bursts());
  scenario.ocean.start_date = "2026-05-02T03:00:00Z";
  scenario.origin_longitude_deg = 90;
  EXPECT_NEAR(make_noise_variation(reef, scenario).noon_s, 3 * 3600, 1e-6);
  EXPECT_FALSE(make_noise_variation(read("").environment, scenario).has_bursts());
  const auto own = read("[environment]\nnoise_place = \"reef\"\nimpulse_exponent = 1.5").environment;
  EXPECT_TRUE(make_noise_variation(own, scenario).draws_bursts());
  EXPECT_EQ(make_noise_variation(own, scenario).burst_exponent, 1.5);
}

TEST(ChannelServerConfig, WhatTheWaterCarriesIsTaken) {
  const auto water = water_of("[water_load]\nparticles_kg_m3 = 0.2\nparticle_um = 3\nplants_db_per_km = 12");
  EXPECT_EQ(water.load.particles_kg_m3, 0.2);
  EXPECT_NEAR(water.load.particle_radius_m, 3e-6, 1e-20);
  EXPECT_EQ(water.load.plants_db_per_km, 12);
}

TEST(ChannelServerConfig, BeyondTheTerrainThereIsItsLastDepthOrNone) {
  EXPECT_TRUE(make_rays(read("[propagation]\nbeyond = \"hold\"")).holds_terrain);
  EXPECT_FALSE(make_rays(read("[propagation]\nbeyond = \"none\"")).holds_terrain);
}

TEST(ChannelServerConfig, APropellerIsHeardAtItsOwnHydrophoneAlone) {
  bus::Scenario scenario;
  std::string vehicles;
  for (const char* model : {"torpedo", "hover", "glider", "fixed"}) {
    bus::VehicleEntry entry;
    entry.name = model;
    entry.id = static_cast<std::int32_t>(scenario.vehicles.size()) + 1;
    entry.model = model;
    scenario.vehicles.push_back(entry);
    vehicles += "[[vehicle]]\nown_noise = true\nname = \"" + std::string(model) + "\"\n";
  }
  const auto equipment = make_equipment(read(vehicles), scenario);
  ASSERT_EQ(equipment.noise.sources().size(), 2U);
  // 11 m/s at the tips of propellers of 0.14 and 0.076 m.
  EXPECT_NEAR(equipment.noise.sources().at(1).reference, 11 / (std::numbers::pi * 0.14), 1e-9);
  EXPECT_NEAR(equipment.noise.sources().at(2).reference, 11 / (std::numbers::pi * 0.076), 1e-9);
  EXPECT_FALSE(equipment.noise.are_heard());
  const auto silent = make_equipment(read("[[vehicle]]\nname = \"torpedo\"\nown_noise = false"), scenario);
  EXPECT_TRUE(silent.noise.sources().empty());
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

TEST(ChannelServerConfig, IceIsTakenAndStopsTheWind) {
  const ChannelServerConfig config = read(R"([environment]
wind_mps = 12
[ice]
cover = "fast"
roughness_m = 0.1
slope = 0.05
loss_db = 1
loss_per_sine_db = 8
keels_per_km = 3
keel_draft_m = 4
)");
  const acoustics::IceCover& ice = config.environment.ice;
  EXPECT_EQ(ice, (acoustics::IceCover{acoustics::IceKind::kFast, 0.1, 0.05, 1, 8, 3, 4}));
  const acoustics::Environment water = make_environment(config.environment, {});
  EXPECT_EQ(water.ice, ice);
  EXPECT_EQ(water.noise.wind_mps, 0);
  EXPECT_EQ(make_rays(config).fading.large_scale_still_s, acoustics::kIceCoherenceS);
  EXPECT_EQ(make_rays(read("[ice]\ncover = \"pack\"\n")).fading.large_scale_still_s, 0);
  EXPECT_FALSE(make_environment({}, {}).ice.covers());
  EXPECT_THAT(errors_of("[ice]\ncover = \"thin\"\n"), HasSubstr("ice.cover"));
}

TEST(ChannelServerConfig, BelowFastIceIsItsNoise) {
  const auto place_of = [](const std::string& toml) {
    ChannelServerConfig config = read(toml);
    use_depth(30, config.environment);
    return config.environment.noise_place;
  };
  EXPECT_EQ(place_of("[ice]\ncover = \"fast\"\n"), "fast-ice");
  EXPECT_EQ(place_of("[ice]\ncover = \"pack\"\n"), "shelf");
  EXPECT_EQ(place_of("[environment]\nnoise_place = \"harbour\"\n[ice]\ncover = \"fast\"\n"), "harbour");
}

// Modems of vehicles and rates included; the bounds of both keys hold.
TEST(ChannelServerConfig, CalibratedReceiversAreThoseOfAllModems) {
  const auto modems_of = [](const std::string& calibration) {
    return make_modems(read("[calibration]\n" + calibration +
                            "[[vehicle]]\nname = \"a\"\nid = 1\n[vehicle.modem]\nprofile = "
                            "\"micromodem-psk-1\"\n[[vehicle]]\nname = \"b\"\nid = 2\n"));
  };
  const ConfiguredModems before = modems_of(""),
                         after = modems_of("receiver_loss_db = -2.5\necho_factor = 0.5\n"),
                         most = modems_of("receiver_loss_db = 40\necho_factor = 100\n");
  const auto expect_changed = [](const acoustics::Modem& old, const acoustics::Modem& now) {
    EXPECT_EQ(now.receiver_loss.value, old.receiver_loss.value - 2.5);
    EXPECT_EQ(now.late_echo_share, 0.5 * old.late_echo_share);
  };
  for (const char* name : {"a", "b"}) {
    const VehicleModem &old = before.of(name), &now = after.of(name);
    expect_changed(old.modem, now.modem);
    ASSERT_EQ(now.rates.all().size(), old.rates.all().size());
    for (std::size_t i = 0; i < old.rates.all().size(); ++i)
      expect_changed(old.rates.all()[i].modem, now.rates.all()[i].modem);
    EXPECT_EQ(most.of(name).modem.receiver_loss.value, acoustics::kMaxReceiverLossDb);
    EXPECT_EQ(most.of(name).modem.late_echo_share, acoustics::kMaxLateEchoShare);
  }
}

TEST(ChannelServerConfig, EndsNearTheSurfaceAreThoseOfTheScenario) {
  ChannelServerConfig config;
  bus::Scenario scenario;
  scenario.seed = 9;
  const auto add = [&](std::int32_t id, const char* model, bus::Mount mount) {
    scenario.vehicles.push_back({.name = "v" + std::to_string(id), .id = id, .model = model, .mount = mount});
  };
  add(1, "torpedo", bus::Mount::kFixed);
  add(2, "fixed", bus::Mount::kFixed);
  add(3, "fixed", bus::Mount::kFloating);
  add(4, "lander", bus::Mount::kFixed);
  const auto ends = make_surface_ends(config, scenario);
  ASSERT_TRUE(ends);
  EXPECT_EQ(ends->seed, 9u);
  EXPECT_THAT(ends->floating, ::testing::ElementsAre(3));
  EXPECT_THAT(ends->heaving, ::testing::ElementsAre(1, 3));
  EXPECT_TRUE(make_rules(config, scenario).medium.near_surface);
  config.propagation.fading.enabled = false;
  EXPECT_FALSE(make_surface_ends(config, scenario));
  config.propagation.fading.enabled = true;
  config.propagation.fading.turns = false;
  EXPECT_FALSE(make_surface_ends(config, scenario));
  config.propagation.fading.turns = true;
  config.propagation.model = PropagationModel::kStraight;
  EXPECT_FALSE(make_surface_ends(config, scenario));
}

TEST(ChannelServerConfig, TheScenariosTideEntersTheWater) {
  bus::Scenario scenario;
  scenario.tide.constituents = {{.amplitude_m = 2}};
  EXPECT_EQ(make_environment({}, scenario).tide, scenario.tide);
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
  EXPECT_EQ(read("[channel_server]\npredicted_payload_bytes = 0").rules.predicted_payload_bytes, 0);
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

}  // namespace
}  // namespace halocline::channel_server
