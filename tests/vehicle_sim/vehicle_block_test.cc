// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_sim/vehicle_block.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/check.h"
#include "core/sim_time.h"
#include "vehicle_sim/fleet.h"

namespace halocline::vehicle_sim {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

bus::Scenario scenario_of(const std::vector<std::string>& names) {
  bus::Scenario scenario;
  for (const std::string& name : names) {
    const bool is_guest = name.starts_with("guest");
    const auto id = static_cast<std::int32_t>(scenario.vehicles.size()) + 1;
    scenario.vehicles.push_back({.name = name, .id = id, .model = is_guest ? "external" : "torpedo"});
  }
  return scenario;
}

std::vector<std::string> names_in(const ScenarioPart& part) {
  std::vector<std::string> names;
  for (const FleetMember& member : members_of(part.scenario, part.config)) names.push_back(member.name);
  return names;
}

TEST(VehicleBlock, EveryVehicleIsInOneAndTheirSizesDifferByOneAtMost) {
  for (const int count : {1, 2, 3, 7, kMaxBlocks}) {
    for (const std::size_t members : {std::size_t{1}, std::size_t{2}, std::size_t{63}, std::size_t{200}}) {
      const VehicleBlock block{.index = 0, .count = count};
      std::vector<std::size_t> sizes(static_cast<std::size_t>(count));
      for (std::size_t i = 0; i < members; ++i) ++sizes.at(block.of(i, members));
      const auto [least, most] = std::minmax_element(sizes.begin(), sizes.end());
      EXPECT_LE(*most - *least, 1u) << members << " in " << count;
    }
  }
}

TEST(VehicleBlock, HasTheVehiclesThatFollowEachOtherInTheScenario) {
  const bus::Scenario scenario = scenario_of({"a", "b", "guest-1", "c", "d", "guest-2", "e"});
  VehicleSimConfig config;
  config.block = {.index = 0, .count = 2};
  EXPECT_THAT(names_in(part_of_block(scenario, config)), ElementsAre("a", "b", "c"));
  config.block.index = 1;
  EXPECT_THAT(names_in(part_of_block(scenario, config)), ElementsAre("d", "e"));
}

TEST(VehicleBlock, HasTheTethersAndFaultsOfItsVehicles) {
  const bus::Scenario scenario = scenario_of({"a", "b", "c", "d"});
  VehicleSimConfig config;
  config.tethers = {{.vehicle = "c", .to_vehicle = "d"}, {.vehicle = "a", .to_vehicle = ""}};
  config.faults = {{"b", {}, SimTime()}, {"d", {}, SimTime()}};
  config.block = {.index = 1, .count = 2};
  const ScenarioPart part = part_of_block(scenario, config);
  ASSERT_EQ(part.config.tethers.size(), 1u);
  EXPECT_EQ(part.config.tethers[0].vehicle, "c");
  ASSERT_EQ(part.config.faults.size(), 1u);
  EXPECT_EQ(part.config.faults[0].vehicle, "d");
}

TEST(VehicleBlock, WhatNoBlockCanDoIsRefused) {
  const bus::Scenario scenario = scenario_of({"a", "b", "c", "d"});
  VehicleSimConfig config;
  config.block = {.index = 0, .count = 2};
  config.tethers = {{.vehicle = "b", .to_vehicle = "c"}};
  try {
    part_of_block(scenario, config);
    FAIL() << "a tether led from block to block";
  } catch (const InvalidArgument& error) {
    EXPECT_THAT(error.what(), HasSubstr("b and c are in different blocks of 2"));
  }
  config.tethers.clear();
  config.faults = {{"nobody", {}, SimTime()}};
  EXPECT_THROW(part_of_block(scenario, config), InvalidArgument);
}

TEST(VehicleBlock, OfSeveralEachHasANameOfItsOwn) {
  EXPECT_EQ(node_name_of({}), "vehicle-sim");
  EXPECT_EQ(node_name_of({.index = 1, .count = 2}), "vehicle-sim-1");
}

}  // namespace
}  // namespace halocline::vehicle_sim
