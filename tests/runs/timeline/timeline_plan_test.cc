// SPDX-License-Identifier: BSD-3-Clause
// SCENARIO, TERRAIN, PLAN and AUTOPILOT in the timeline, and their texts.
#include <cmath>
#include <set>
#include <utility>

#include <gmock/gmock.h>

#include "core/sim_time.h"
#include "runs/timeline/plan_texts.h"
#include "runs/timeline/run_summary.h"
#include "runs/timeline/run_timeline.h"
#include "runs/timeline/vehicle_record.h"
#include "tests/runs/timeline/timeline_fixtures.h"

namespace halocline::clients {
namespace {

using testing::add;
using ::testing::HasSubstr;
using testing::kSecond;
using testing::state;

scenario_info_t scenario_part(std::int32_t number, std::int32_t count, const std::string& vehicle,
                              const std::string& line) {
  scenario_info_t part{};
  part.part_number = number;
  part.part_count = count;
  part.scenario_name = "seamount";
  part.scenario_seed = 7;
  part.vehicles.resize(1);
  part.vehicles[0].vehicle_name = vehicle;
  part.vehicles[0].vehicle_id = number + 1;
  part.vehicles[0].modem_family = part.vehicles[0].framing_profile = "generic";
  part.vehicles[0].center_frequency_hz = 25'000;
  part.vehicles[0].bandwidth_hz = 5000;
  part.vehicles[0].bit_rate_bps = 80;
  part.num_vehicles = 1;
  part.configuration_line = {line};
  part.num_lines = 1;
  return part;
}

vehicle_plan_t plan(std::int32_t waypoint) {
  vehicle_plan_t p{};
  p.waypoint_index = waypoint;
  p.num_behaviours = 1;
  p.behaviours.resize(1);
  p.num_waypoints = 3;
  p.waypoint_behaviour = {0, 0, 0};
  p.waypoint_ned_m = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
  return p;
}

TEST(RunTimeline, PartsOfTheScenarioAreOneScenario) {
  RunTimeline store;
  add(store, "SCENARIO", scenario_part(0, 2, "auv-1", "[scenario]"));
  EXPECT_EQ(store.scenario().name, "");
  add(store, "SCENARIO", scenario_part(1, 2, "auv-2", "seed = 7"));
  EXPECT_EQ(store.scenario().name, "seamount");
  EXPECT_EQ(store.scenario().toml, "[scenario]\nseed = 7\n");
  EXPECT_EQ(store.find("auv-2")->id, 2);
  EXPECT_EQ(store.find("auv-2")->described->center_frequency_hz, 25'000);
}

TEST(RunTimeline, AScenarioThatLacksAPartWaitsForItsRepetition) {
  RunTimeline store;
  add(store, "SCENARIO", scenario_part(0, 3, "auv-1", "a"));
  add(store, "SCENARIO", scenario_part(2, 3, "auv-3", "c"));
  EXPECT_EQ(store.scenario().name, "");
  for (int part = 0; part < 3; ++part)
    add(store, "SCENARIO",
        scenario_part(part, 3, "auv-" + std::to_string(part + 1),
                      std::string(1, static_cast<char>('a' + part))));
  EXPECT_EQ(store.scenario().toml, "a\nb\nc\n");
}

// 0 N 0 E is a place where the scenario says so, and otherwise none is known.
TEST(RunTimeline, TheOriginIsWhatTheScenarioStates) {
  const auto origin_with = [](const std::string& line, double longitude_deg) {
    RunTimeline store;
    scenario_info_t part = scenario_part(0, 1, "auv", line);
    part.origin_longitude_deg = longitude_deg;
    add(store, "SCENARIO", part);
    return store.scenario().origin;
  };
  EXPECT_FALSE(origin_with("seed = 7", 0));
  EXPECT_TRUE(origin_with("origin_longitude_deg = 0.0", 0));
  ASSERT_TRUE(origin_with("seed = 7", 7.25));
  EXPECT_EQ(origin_with("seed = 7", 7.25)->longitude_deg, 7.25);
  EXPECT_FALSE(RunTimeline().scenario().origin);
}

TEST(RunTimeline, TheOriginIsNotSoughtInTheFilesOfTheConfiguration) {
  RunTimeline store;
  scenario_info_t part = scenario_part(0, 1, "auv", "seed = 7");
  part.configuration_line = {"seed = 7", "", "[[file]]", "lines = [", "\"# origin_latitude_deg = 54.3\",",
                             "]"};
  part.num_lines = 6;
  add(store, "SCENARIO", part);
  EXPECT_THAT(store.scenario().toml, ::testing::HasSubstr("54.3"));
  EXPECT_FALSE(store.scenario().origin);
}

TEST(RunTimeline, AFixedVehicleIsAtRestWhateverItsStates) {
  RunTimeline store;
  scenario_info_t part = scenario_part(0, 1, "buoy", "");
  part.vehicles[0].moved_by = scenario_vehicle_t::FIXED;
  add(store, "SCENARIO", part);
  EXPECT_TRUE(store.find("buoy")->is_at_rest());
}

TEST(RunTimeline, TheTerrainIsThatOfTheServiceAndNotOfAnAnswer) {
  terrain_tile_t tile{};
  tile.tile_south_m = -10;
  tile.tile_west_m = -10;
  tile.post_spacing_m = 20;
  tile.tile_rows = tile.tile_columns = 2;
  tile.num_posts = 4;
  tile.seabed_z_m = {100, 100, 120, 0};
  tile.post_known = {1, 1, 1, 0};
  RunTimeline store;
  add(store, "TERRAIN_REPLY.monitor", tile);
  EXPECT_FALSE(store.terrain());
  EXPECT_TRUE(std::isnan(store.seabed_m(0, -10)));
  add(store, "TERRAIN", tile);
  ASSERT_TRUE(store.terrain());
  EXPECT_DOUBLE_EQ(store.seabed_m(0, -10), 110);
  EXPECT_TRUE(std::isnan(store.seabed_m(5, 5)));  // beside the post that is not known
}

TEST(RunTimeline, APlanIsKeptAtItsChanges) {
  RunTimeline store;
  for (const auto& [second, waypoint] : {std::pair{0, 0}, {60, 0}, {70, 1}, {120, 1}}) {
    vehicle_plan_t p = plan(waypoint);
    p.utime = second * kSecond;
    add(store, "PLAN.auv-1", p);
  }
  const VehicleRecord& vehicle = *store.find("auv-1");
  EXPECT_EQ(vehicle.plans.size(), 2u);
  EXPECT_EQ(vehicle.plan_at(SimTime::from_seconds(69))->waypoint_index, 0);
  EXPECT_EQ(vehicle.plan_at(SimTime::from_seconds(71))->waypoint_index, 1);
  EXPECT_EQ(vehicle.plan_at(SimTime::from_seconds(-1)), nullptr);
}

TEST(PlanTexts, EveryActivityHasWordsOfItsOwn) {
  std::set<std::string> texts;
  for (std::int8_t activity = 0; activity <= autopilot_status_t::CIRCLING_SAFELY; ++activity) {
    autopilot_status_t status{};
    status.autopilot_activity = activity;
    texts.insert(activity_text(status, nullptr));
  }
  EXPECT_EQ(texts.size(), static_cast<std::size_t>(autopilot_status_t::CIRCLING_SAFELY) + 1);
  EXPECT_FALSE(texts.contains(""));
}

TEST(PlanTexts, ALegIsOneOfThePlansAndTheSeabedIsAReason) {
  autopilot_status_t status{};
  status.autopilot_activity = autopilot_status_t::FOLLOWING_LEG;
  status.waypoint_index = 1;
  const vehicle_plan_t p = plan(1);
  EXPECT_EQ(activity_text(status, &p), "follows leg 2 of 3");
  status.depth_rule = autopilot_status_t::DEPTH_AVOIDING_SEABED;
  EXPECT_EQ(activity_text(status, &p), "follows leg 2 of 3, kept above the seabed");
}

TEST(PlanTexts, ProgressEndsWithThePlan) {
  vehicle_plan_t p = plan(2);
  EXPECT_EQ(progress_text(p), "steers for waypoint 3 of 3");
  p.plan_ended = 1;
  p.at_end = vehicle_plan_t::STOP;
  EXPECT_EQ(progress_text(p), "has done its plan and stopped");
}

TEST(RunSummary, StatesWhoWentWhereAndHowFarItsPlanCame) {
  RunTimeline store;
  add(store, "STATE.auv-1", state(1, 0, 0, 0, 20));
  add(store, "STATE.auv-1", state(1, kSecond, 300, 400, 40));
  add(store, "PLAN.auv-1", plan(1));
  const auto rows = run_summary(store);
  EXPECT_EQ(rows[0].key, "auv-1");
  EXPECT_EQ(rows[0].text, "went 500 m, 20 to 40 m deep; steers for waypoint 2 of 3");
  EXPECT_EQ(rows[1].text, "none");
}

// A hull at the surface lies a little above or below it.
TEST(RunSummary, ADepthThatRoundsToZeroHasNoSign) {
  RunTimeline store;
  add(store, "STATE.auv-1", state(1, 0, 0, 0, -0.3));
  add(store, "STATE.auv-1", state(1, kSecond, 300, 400, 80.6));
  EXPECT_EQ(run_summary(store)[0].text, "went 500 m, 0 to 81 m deep");
}

}  // namespace
}  // namespace halocline::clients
