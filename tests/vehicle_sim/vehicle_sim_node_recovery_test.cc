// SPDX-License-Identifier: BSD-3-Clause
// A vehicle simulator that is killed goes on where it was.
#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "core/sim_time.h"
#include "tests/bus/runtime/journal_files.h"
#include "tests/vehicle_sim/vehicle_sim_node_fixture.h"
#include "vehicle_sim/faults.h"

namespace halocline::vehicle_sim {
namespace {

// Turns in a changed current with a leak, is killed after 3 s and comes back after `gap_ms`; 0: is never
// killed.
class KilledVehicleSim : public VehicleSimNodeTest {
 protected:
  void run(std::int64_t gap_ms) {
    states_.clear();
    now_ = SimTime();
    const bus::testing::JournalFiles files;
    start(files);
    run_until(at_ms(100));
    current_change_t current{};
    current.utime = 1'000'000;
    current.uniform_ned_mps[1] = 0.3;
    current.tide_period_s = 40'000;
    current.random_time_s = 600;
    ear_.publish(std::string(bus::channels::kSetCurrent), current);
    vehicle_fault_t leak{};
    leak.utime = 3'500'000;
    leak.fault_kind = vehicle_fault_t::LEAK;
    leak.leak_rate_kg_s = 0.5;
    leak.leak_volume_m3 = 0.01;
    ear_.publish(bus::channels::kFault.of("sub"), leak);
    for (const int ms : {100, 2900}) {
      run_until(at_ms(ms));
      command(at_ms(ms), {0.1, 0.05, 20});
    }
    run_until(at_ms(3000));
    if (gap_ms > 0) {
      node_.reset();
      now_ = at_ms(3000 + gap_ms);
      start(files);
    }
    run_until(at_ms(9000));
  }
  void start(const bus::testing::JournalFiles& files) {
    make_node();
    node_->enable_repair();
    node_->keep_state_in(files.open());
  }
};

// To the last bit: the time of its absence is integrated as if it had been there.
TEST_F(KilledVehicleSim, MovesAsOneThatWasNotKilled) {
  run(0);
  const auto whole = states_["sub"];
  ASSERT_EQ(whole.size(), 91u);
  EXPECT_EQ(node_->counters().refused, 0);
  run(1500);
  const auto& killed = states_["sub"];
  ASSERT_EQ(killed.size(), whole.size());
  for (std::size_t k = 0; k < whole.size(); ++k) {
    EXPECT_EQ(killed[k].utime, whole[k].utime);
    EXPECT_EQ(killed[k].sequence, whole[k].sequence);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(killed[k].position_ned_m[axis], whole[k].position_ned_m[axis]) << k;
      EXPECT_EQ(killed[k].velocity_ned_mps[axis], whole[k].velocity_ned_mps[axis]) << k;
    }
  }
}

TEST_F(KilledVehicleSim, PublishesOnlyTheLatestOfALongAbsence) {
  run(4000);
  const auto& states = states_["sub"];
  const auto after =
      std::find_if(states.begin(), states.end(), [](const auto& s) { return s.utime > 3'000'000; });
  ASSERT_NE(after, states.end());
  EXPECT_EQ(after->utime, 5'000'000);
  EXPECT_EQ(after->sequence, (after - 1)->sequence + 1);
}

TEST_F(KilledVehicleSim, ItsSensorsMeasureOnWithTheSameErrors) {
  config_.sensors.depth.errors = {.noise = 0.1, .walk = 0.1};
  const auto depths_after = [&](std::int64_t gap_ms) {
    sensors_.clear();
    run(gap_ms);
    std::vector<std::pair<std::int64_t, double>> depths;
    for (const auto& s : sensors_["sub"]) {
      if (s.utime > 5'000'000) depths.emplace_back(s.utime, s.depth_m);
    }
    return depths;
  };
  const auto whole = depths_after(0);
  EXPECT_EQ(whole.size(), 20u);
  EXPECT_EQ(depths_after(1500), whole);
}

TEST_F(KilledVehicleSim, PublishesEachFaultOfTheScenarioOnce) {
  for (const std::int64_t ms : {2000, 4000, 8000}) {
    const Fault dead{.from = at_ms(ms), .kind = FaultKind::kDeadSensor, .sensor = SensorKind::kDepth};
    config_.faults.push_back({"sub", dead, SimTime()});
  }
  std::vector<std::int64_t> begun;
  ear_.subscribe<vehicle_fault_t>(bus::channels::kFault.of("sub"), [&](const vehicle_fault_t& m) {
    if (m.from_scenario) begun.push_back(m.utime);
  });
  run(1500);
  EXPECT_EQ(begun, (std::vector<std::int64_t>{2'000'000, 4'000'000, 8'000'000}));
}

}  // namespace
}  // namespace halocline::vehicle_sim
