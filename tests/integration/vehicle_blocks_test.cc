// SPDX-License-Identifier: BSD-3-Clause
// Vehicle simulators that share the vehicles in blocks.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "bus/logs/log_reader.h"
#include "core/frames.h"
#include "core/sim_time.h"
#include "runs/analysis/simulation_output.h"
#include "simulation/composition.h"
#include "tests/integration/embedded_fixture.h"
#include "tests/support/tolerance.h"

namespace halocline::clients {
namespace {

using halocline::testing::tolerance;

class VehicleBlocks : public testing::EmbeddedTest {
 protected:
  // The output of a run whose vehicles are in so many blocks.
  std::string output_of(const std::string& scenario, std::vector<std::string> settings, int blocks) {
    settings.push_back("vehicle_sim.blocks=" + std::to_string(blocks));
    LogReader log(run(load(scenario, settings), "log"));
    const std::string path = log_path("output");
    write_simulation_output(log, path);
    return bytes_of(path);
  }

  // The least distance of two vehicles that run at each other head on, at 1.5 m/s each.
  double least_distance_m(int blocks) {
    ScenarioConfig config = load("harbour", {"scenario.duration_s=60"});
    config.vehicle_sim.block.count = blocks;
    config.autopilot.vehicles.clear();
    config.traffic.vehicles.clear();
    config.localiser.vehicles.clear();
    config.scenario.vehicles = {
        {.name = "a", .id = 1, .start_ned_m = {-20, -100, 6}, .heading_rad = 0, .speed_mps = 1.5},
        {.name = "b", .id = 2, .start_ned_m = {-10, -100, 6}, .heading_rad = M_PI, .speed_mps = 1.5}};
    std::map<std::int64_t, Vec3> places;
    double least = 1e9;
    for (const auto& [channel, state] : messages_in<vehicle_state_t>(run(config, "head-on"))) {
      const Vec3 place(state.position_ned_m);
      const auto [other, is_first] = places.emplace(state.utime, place);
      if (!is_first) least = std::min(least, (place - other->second).norm());
    }
    return least;
  }
};

// With bearings, echoes, satellite fixes and errors of sensors; with faults; with packets that ping.
TEST_F(VehicleBlocks, TogetherPublishWhatOneSimulatorPublishes) {
  const std::vector<std::pair<std::string, std::vector<std::string>>> runs{
      {"navigation", {"scenario.duration_s=40"}},
      {"faults", {"scenario.duration_s=40"}},
      {"harbour", {"scenario.duration_s=20", "vehicle_sim.state_deviation_m=0.2"}}};
  for (const auto& [scenario, settings] : runs) {
    const std::string one = output_of(scenario, settings, 1);
    EXPECT_GT(one.size(), 100'000u);
    for (const int blocks : {2, 3, 40}) {
      EXPECT_TRUE(output_of(scenario, settings, blocks) == one) << scenario << ' ' << blocks;
    }
  }
}

TEST_F(VehicleBlocks, HullsOfDifferentBlocksPassThroughEachOther) {
  EXPECT_GT(least_distance_m(1), 0.5) << "hulls of 1.6 m in one block meet nose to nose";
  EXPECT_LT(least_distance_m(2), 0.2);
}

}  // namespace
}  // namespace halocline::clients
