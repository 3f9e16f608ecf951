// SPDX-License-Identifier: BSD-3-Clause
// What a source makes of the scenario: modems, and changes of the water.
#include <chrono>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "bus/config/config.h"
#include "core/sim_time.h"
#include "simulation/composition.h"
#include "viewer/sources/log_nodes.h"
#include "viewer/sources/modems.h"
#include "viewer/sources/water_changes.h"

namespace halocline::monitor {
namespace {

using ::testing::ElementsAre;

TEST(Modems, AreThoseOfTheConfiguration) {
  const std::vector<std::string> names{"auv-1", "auv-2"};
  const auto messages = modems_in(
      "[scenario]\nname = \"two\"\n[modem]\nguard_time_s = 0.002\n"
      "[[vehicle]]\nname = \"auv-1\"\nid = 1\n"
      "[[vehicle]]\nname = \"auv-2\"\nid = 2\n[vehicle.modem]\nprofile = \"janus\"\n",
      names, SimTime::from_seconds(5));
  ASSERT_EQ(messages.size(), 2u);
  EXPECT_EQ(messages[0].channel, "MODEM.auv-1");
  EXPECT_EQ(messages[1].channel, "MODEM.auv-2");
  EXPECT_EQ(bus::decoded<modem_config_t>(messages[0].bytes)->guard_time_s, 0.002);
  const auto janus = bus::decoded<modem_config_t>(messages[1].bytes);
  EXPECT_EQ(janus->modem_profile, "janus");
  EXPECT_EQ(janus->utime, 5'000'000);
  EXPECT_TRUE(modems_in("[modem]\nprofile = \"away.toml\"", names, SimTime()).empty());
  EXPECT_TRUE(modems_in("[modem", names, SimTime()).empty());
}

// A configuration that carries its files, as a log has it; away from where it was written.
TEST(LogNodes, ComputeWithTheOwnModemThatTheConfigurationCarries) {
  const std::string folder = ::testing::TempDir() + "own-modem-" + std::to_string(getpid());
  std::filesystem::create_directories(folder);
  std::ofstream(folder + "/own.toml") << "source_level_db = 171\nbit_rate_bps = 250\n";
  std::ofstream(folder + "/sea.toml")
      << "[modem]\nprofile = \"own.toml\"\n[[vehicle]]\nname = \"a\"\nid = 1\n";
  auto scenario = bus::ConfigFile::load(folder + "/sea.toml");
  const std::string carried =
      clients::load_scenario(scenario, clients::ScenarioUse::kWater).scenario.configuration;
  std::filesystem::remove_all(folder);
  LogNodes nodes([&] { return bus::ConfigFile::parse(carried, "SCENARIO"); });
  std::optional<modem_config_t> modem;
  while (!nodes.is_ready() && nodes.problem().empty())
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_EQ(nodes.problem(), "");
  for (const BusMessage& message : nodes.take()) {
    if (message.channel == "MODEM.a") modem = bus::decoded<modem_config_t>(message.bytes);
  }
  ASSERT_TRUE(modem);
  EXPECT_EQ(modem->source_level_db, 171);
  EXPECT_EQ(modem->bit_rate_bps, 250);
}

TEST(Modems, ThresholdIsThatOfTheModem) {
  const std::vector<std::string> names{"auv-1"};
  const auto modem = [&](const std::string& keys) {
    return *bus::decoded<modem_config_t>(modems_in("[modem]\n" + keys, names, SimTime()).at(0).bytes);
  };
  ModemThresholds thresholds;
  const auto slow = thresholds.of(modem("bit_rate_bps = 80\n")),
             fast = thresholds.of(modem("bit_rate_bps = 800\n"));
  ASSERT_TRUE(slow && fast);
  EXPECT_NEAR(*fast - *slow, 10, 0.01);  // Eb / N0 is the same
  EXPECT_EQ(thresholds.of(modem("error_model = \"none\"\n")), std::nullopt);
  modem_config_t impossible = modem("");
  impossible.error_model = 99;
  EXPECT_EQ(thresholds.of(impossible), std::nullopt);
}

environment_t water(double wind_mps, std::vector<double> temperature_degc, std::vector<double> speed_mps) {
  environment_t water{};
  water.num_layers = 2;
  water.layer_depth_m = {0, 50};
  water.layer_temperature_degc = std::move(temperature_degc);
  water.layer_salinity_psu = {35, 35};
  water.layer_sound_speed_mps = std::move(speed_mps);
  water.wind_speed_mps = wind_mps;
  return water;
}

TEST(WaterChanges, SetWhatDiffersAlone) {
  const environment_t before = water(5, {15, 10}, {1507, 1490});
  EXPECT_FALSE(change_between(before, before));
  const auto wind = change_between(before, water(9, {15, 10}, {1507, 1490}));
  ASSERT_TRUE(wind);
  EXPECT_TRUE(wind->sets_wind);
  EXPECT_EQ(wind->wind_speed_mps, 9);
  EXPECT_FALSE(wind->sets_shipping || wind->sets_sea_surface);
  EXPECT_EQ(wind->profile_set, environment_change_t::PROFILE_UNCHANGED);
  const auto warmer = change_between(before, water(5, {20, 10}, {1521, 1490}));
  ASSERT_TRUE(warmer);
  EXPECT_FALSE(warmer->sets_wind);
  EXPECT_EQ(warmer->profile_set, environment_change_t::PROFILE_WATER);
  EXPECT_THAT(warmer->layer_temperature_degc, ElementsAre(20, 10));
  const auto speeds = change_between(before, water(5, {10, 10}, {1500, 1480}));
  ASSERT_TRUE(speeds);
  EXPECT_EQ(speeds->profile_set, environment_change_t::PROFILE_SPEED);
  EXPECT_THAT(speeds->layer_sound_speed_mps, ElementsAre(1500, 1480));
}

}  // namespace
}  // namespace halocline::monitor
