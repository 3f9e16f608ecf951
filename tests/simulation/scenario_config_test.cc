// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bus/config/config.h"
#include "channel_server/vehicles/state_history.h"
#include "core/atomic_file.h"
#include "core/sim_time.h"
#include "simulation/composition.h"

namespace halocline::clients {
namespace {

const std::string kScenarios = std::string(HALOCLINE_SOURCE_DIR) + "/scenarios";

// By their paths in scenarios/, without the ending. Plans of sweeps are none.
std::vector<std::string> shipped() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kScenarios)) {
    const bool is_plan = entry.path().stem().string().starts_with("sweep_");
    if (entry.path().extension() == ".toml" && !is_plan)
      names.push_back(std::filesystem::relative(entry.path(), kScenarios).replace_extension("").string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

class ShippedScenario : public ::testing::TestWithParam<std::string> {
 protected:
  ScenarioConfig load() { return load_scenario(kScenarios + "/" + GetParam() + ".toml", {}); }
};

TEST_P(ShippedScenario, HasNoUnreadKey) {
  std::string name = load().scenario.name;
  std::replace(name.begin(), name.end(), '-', '_');
  EXPECT_EQ(name, std::filesystem::path(GetParam()).filename());
}

TEST_P(ShippedScenario, ReadsBackFromItsEffectiveConfiguration) {
  const std::string text = effective_toml(load());
  const std::string path = ::testing::TempDir() + "effective-" + load().scenario.name + ".toml";
  replace_file(path, text);
  EXPECT_EQ(effective_toml(load_scenario(path, {})), text);
  std::filesystem::remove(path);
}

// As SCENARIO carries it, with the files that it names: read anywhere, it makes the same run.
TEST_P(ShippedScenario, ReadsBackFromTheConfigurationThatTheLogHolds) {
  const ScenarioConfig config = load();
  auto file = bus::ConfigFile::parse(config.scenario.configuration, "nowhere/SCENARIO");
  const ScenarioConfig again = load_scenario(file, ScenarioUse::kRun);
  EXPECT_EQ(portable_toml(again), portable_toml(config));
  EXPECT_EQ(again.scenario.configuration, config.scenario.configuration);
}

TEST_P(ShippedScenario, MakesSenseOnItsTerrain) {
  EXPECT_THAT(load_checked(kScenarios + "/" + GetParam() + ".toml", {}).warnings, ::testing::IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(All, ShippedScenario, ::testing::ValuesIn(shipped()), [](const auto& test) {
  std::string name = test.param;
  std::replace(name.begin(), name.end(), '/', '_');
  return name;
});

// Keys that no shipped scenario sets, each with a value of its own.
TEST(ScenarioConfig, KeysThatTuneReachTheConfiguration) {
  const std::string path = std::string(HALOCLINE_SOURCE_DIR) + "/tests/data/scenarios/tuned.toml";
  const std::string effective = effective_toml(load_checked(path, {}).config);
  std::ifstream lines(path);
  for (std::string line; std::getline(lines, line);) {
    if (line.find(" = ") == std::string::npos) continue;
    EXPECT_THAT(effective, ::testing::HasSubstr("\n" + line + "\n"));
  }
}

TEST(ScenarioConfig, TheListOfCommonKeysIsAScenario) {
  auto file = bus::ConfigFile::parse(key_list(bus::KeyClass::kCommon), "keys.toml");
  const ScenarioConfig config = load_scenario(file, ScenarioUse::kRun);
  EXPECT_EQ(config.vehicle_sim.vehicles.at(0).sensors, config.vehicle_sim.sensors);
  EXPECT_EQ(config.channel_server.vehicles.at(0).modem, config.channel_server.modem);
}

// The vehicle simulator knows the receivers' keys, and their defaults, without knowing the receivers.
TEST(ScenarioConfig, StatesMayBeSilentByTheDefaultsOfTheirReceivers) {
  const ScenarioConfig defaults;
  const channel_server::PositionRule& channel = defaults.channel_server.rules.position;
  const SimDuration longest =
      std::min(channel.state_timeout, defaults.autopilot.state_timeout) - channel.state_lag;
  const auto load_with = [](SimDuration silence) {
    return load_scenario(kScenarios + "/seamount.toml",
                         {"vehicle_sim.state_deviation_m=1",
                          "vehicle_sim.state_longest_silence_s=" + std::to_string(silence.seconds())});
  };
  EXPECT_EQ(load_with(longest).vehicle_sim.states.longest_silence, longest);
  EXPECT_THROW(load_with(longest + SimDuration::from_milliseconds(1)), bus::ConfigErrors);
}

TEST(ScenarioConfig, EffectiveConfigurationListsEachVehicleOnce) {
  const std::string text = effective_toml(load_scenario(kScenarios + "/seamount.toml", {}));
  std::size_t count = 0;
  for (auto at = text.find("[[vehicle]]"); at != std::string::npos; at = text.find("[[vehicle]]", at + 1))
    ++count;
  EXPECT_EQ(count, 3u);
}

TEST(ScenarioConfig, TheConfigurationThatTheLogHoldsHasOverridesAndNotHowTheWorkIsShared) {
  const auto configuration_with = [](const std::vector<std::string>& overrides) {
    return load_scenario(kScenarios + "/seamount.toml", overrides).scenario.configuration;
  };
  const std::string plain = configuration_with({});
  EXPECT_EQ(
      configuration_with({"channel_server.shards=3", "channel_server.threads=2", "vehicle_sim.blocks=2"}),
      plain);
  EXPECT_EQ(configuration_with({"vehicle_sim.threads=2"}), plain);
  EXPECT_NE(configuration_with({"channel_server.link_rate_hz=2"}), plain);
  EXPECT_NE(configuration_with({"scenario.seed=99"}).find("seed = 99"), std::string::npos);
}

TEST(ScenarioConfig, OverridesReachEverySection) {
  const ScenarioConfig config = load_scenario(
      kScenarios + "/seamount.toml",
      {"scenario.duration_s=12", "modem.source_level_db=170", "vehicle.0.mission.speed_mps=1.1"});
  EXPECT_EQ(config.scenario.duration, SimDuration::from_seconds(12));
  EXPECT_EQ(config.channel_server.modem.modem.source_level.value, 170);
  EXPECT_EQ(config.autopilot.vehicles.at(0).mission.speed_mps, 1.1);
}

TEST(ScenarioConfig, UnknownKeysOfEverySectionAreErrors) {
  for (const std::string key :
       {"terrain.shape=1", "vehicle.0.colour=1", "vehicle.0.mission.speed=1", "weather.x=1"}) {
    EXPECT_THROW(load_scenario(kScenarios + "/seamount.toml", {key}), bus::ConfigErrors) << key;
  }
}

}  // namespace
}  // namespace halocline::clients
