// SPDX-License-Identifier: BSD-3-Clause
// SCENARIO: its parts, and when the node publishes it.
#include "channel_server/messages/scenario_messages.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "bus/config/scenario.h"
#include "bus/messages/message_checks.h"
#include "channel_server/vehicles/shard.h"
#include "core/names.h"
#include "tests/channel_server/node_bench.h"

namespace halocline::channel_server {
namespace {

using testing::at_s;

constexpr int kMaxPartBytes = 60'000;  // bytes, docs/architecture.md

bus::Scenario scenario_of(int vehicles) {
  bus::Scenario scenario;
  scenario.name = "sound";
  scenario.description = "two in a bay";
  scenario.seed = 42;
  scenario.duration = SimDuration::from_seconds(90);
  scenario.origin_latitude_deg = 59.5;
  scenario.origin_longitude_deg = 10.5;
  scenario.sea_surface_z_m = -0.5;
  for (int i = 1; i <= vehicles; ++i) {
    scenario.vehicles.push_back(
        {.name = "auv-" + std::to_string(i), .id = i, .start_ned_m = {1.0 * i, 2, 3}});
  }
  return scenario;
}

TEST(ScenarioMessages, HoldWhatTheScenarioHas) {
  bus::Scenario scenario = scenario_of(3);
  scenario.vehicles[1].model = "fixed";
  scenario.vehicles[1].heading_rad = 6;
  scenario.vehicles[2].model = "external";
  scenario.configuration = "[scenario]\nseed = 42\n\n[[vehicle]]\n";
  ConfiguredModems modems{testing::quick_modem(), {}};
  modems.of_vehicle["auv-2"] = testing::quick_modem();
  modems.of_vehicle["auv-2"].modem.source_level = {171};
  const auto parts = to_messages(scenario, modems);
  ASSERT_EQ(parts.size(), 1u);
  const scenario_info_t& m = parts[0];
  EXPECT_EQ(bus::problem_in(m), "");
  EXPECT_EQ(m.part_count, 1);
  EXPECT_EQ(m.scenario_name, "sound");
  EXPECT_EQ(m.description, "two in a bay");
  EXPECT_EQ(m.scenario_seed, 42);
  EXPECT_EQ(m.run_duration_s, 90);
  EXPECT_EQ(m.origin_latitude_deg, 59.5);
  EXPECT_EQ(m.sea_surface_z_m, -0.5);
  ASSERT_EQ(m.num_vehicles, 3);
  EXPECT_EQ(m.vehicles[0].moved_by, scenario_vehicle_t::MOVED);
  EXPECT_EQ(m.vehicles[1].moved_by, scenario_vehicle_t::FIXED);
  EXPECT_EQ(m.vehicles[2].moved_by, scenario_vehicle_t::EXTERNAL);
  EXPECT_EQ(m.vehicles[1].vehicle_id, 2);
  EXPECT_EQ(m.vehicles[1].start_ned_m[0], 2);
  EXPECT_NEAR(m.vehicles[1].start_heading_rad, 6 - 6.283185307, 1e-9);
  EXPECT_EQ(m.vehicles[1].source_level_db, 171);
  EXPECT_EQ(m.vehicles[0].source_level_db, testing::quick_modem().modem.source_level.value);
  EXPECT_EQ(m.configuration_line, (std::vector<std::string>{"[scenario]", "seed = 42", "", "[[vehicle]]"}));
}

TEST(ScenarioMessages, ALargeScenarioComesInPartsBelowAPacedMessage) {
  bus::Scenario scenario = scenario_of(4096);
  for (auto& vehicle : scenario.vehicles) vehicle.name.resize(24, 'x');
  for (int i = 0; i < 20'000; ++i) scenario.configuration += "key_" + std::to_string(i) + " = 1\n";
  scenario.description = std::string(999, 'd') + "\xC3\xA9";  // the limit cuts the last letter
  std::string text;
  std::vector<std::int32_t> ids;
  const auto parts = to_messages(scenario, {testing::quick_modem(), {}});
  EXPECT_EQ(parts.size(), 21u);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    EXPECT_EQ(bus::problem_in(parts[i]), "");
    EXPECT_EQ(parts[i].part_number, static_cast<std::int32_t>(i));
    EXPECT_EQ(parts[i].part_count, 21);
    EXPECT_EQ(parts[i].description, std::string(999, 'd'));
    EXPECT_LT(parts[i].getEncodedSize(), kMaxPartBytes);
    for (const auto& vehicle : parts[i].vehicles) ids.push_back(vehicle.vehicle_id);
    for (const std::string& line : parts[i].configuration_line) text += line + "\n";
  }
  EXPECT_EQ(text, scenario.configuration);
  ASSERT_EQ(ids.size(), 4096u);
  for (std::size_t i = 0; i < ids.size(); ++i) EXPECT_EQ(ids[i], static_cast<std::int32_t>(i + 1));
}

// A server of a scenario, and the SCENARIO that it published.
class ScenarioNode : public ::testing::Test {
 protected:
  void run(const Shard& shard, double end_s) {
    ChannelServerConfig config;
    config.propagation.model = PropagationModel::kStraight;
    config.rules.medium.shard = shard;
    node_ = make_channel_server(lcm_, {"channel-server", 4711}, config, scenario_of(201));
    client_.subscribe<scenario_info_t>(bus::channels::kScenario,
                                       [this](const scenario_info_t& m) { received_.push_back(m); });
    for (SimTime now; now <= at_s(end_s);
         now = std::max(now + SimDuration::from_milliseconds(1), node_->due().sim)) {
      node_->step({now, now});
      while (lcm_.handleTimeout(0) > 0) continue;
    }
  }

  lcm::LCM lcm_{"memq://"};
  bus::Bus client_{lcm_, {"client", 1}};
  std::unique_ptr<ChannelServerNode> node_;
  std::vector<scenario_info_t> received_;
};

TEST_F(ScenarioNode, PublishesTheScenarioAtTheStartAndEachMinute) {
  run({}, 121);
  ASSERT_EQ(received_.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(received_[i].utime, static_cast<std::int64_t>(i / 2) * 60'000'000);
    EXPECT_EQ(received_[i].part_number, static_cast<std::int32_t>(i % 2));
    EXPECT_EQ(received_[i].sequence, static_cast<std::int64_t>(i));
    EXPECT_EQ(received_[i].session, 4711);
  }
  EXPECT_EQ(received_[1].num_vehicles, 1);
}

TEST_F(ScenarioNode, OnlyTheFirstOfSeveralServersPublishesIt) {
  run({.index = 0, .count = 2}, 10);
  EXPECT_EQ(received_.size(), 2u);
  received_.clear();
  run({.index = 1, .count = 2}, 10);
  EXPECT_TRUE(received_.empty());
}

TEST_F(ScenarioNode, AfterAJumpOfTimeWhatWasMissedIsNotMadeUpFor) {
  run({}, 1);
  node_->step({at_s(36'000), at_s(2)});
  while (lcm_.handleTimeout(0) > 0) continue;
  ASSERT_EQ(received_.size(), 6u);
  EXPECT_EQ(received_[2].utime, 35'940'000'000);
  EXPECT_EQ(received_[4].utime, 36'000'000'000);
}

TEST_F(ScenarioNode, AnotherRunGetsItAnew) {
  run({}, 1);
  node_->restart({SimTime(), at_s(2)});
  node_->step({SimTime(), at_s(2)});
  while (lcm_.handleTimeout(0) > 0) continue;
  EXPECT_EQ(received_.size(), 4u);
}

}  // namespace
}  // namespace halocline::channel_server
