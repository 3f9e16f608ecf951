// SPDX-License-Identifier: BSD-3-Clause
// Separate processes in lockstep over udpm write the log of one process, byte for byte, under faults as well.
// Runs inside a network namespace of its own (scripts/isolated).
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <random>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/integration/lockstep_fleet.h"

namespace halocline {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using testing::LockstepFleet;
using testing::NetworkFaults;
using ::testing::Not;
using testing::Process;

// Bytes of the log by which a run is under way: all have joined, and the first instant, of 55 kB with terrain
// and scenario, is over.
constexpr std::size_t kUnderWay = 80'000;

LockstepFleet fleet_of(const std::string& duration_s, NetworkFaults faults = {}) {
  return LockstepFleet("two_vehicles", {"scenario.duration_s=" + duration_s}, faults);
}

void expect_the_log_of_one_process(LockstepFleet& fleet) {
  const std::string one = fleet.log_of_one_process();
  EXPECT_GT(one.size(), 50'000u);
  EXPECT_TRUE(fleet.log_bytes() == one) << fleet.conductor_output();
}

TEST(LockstepProcesses, WriteTheLogOfOneProcess) {
  LockstepFleet fleet = fleet_of("12");
  fleet.start_all();
  ASSERT_TRUE(fleet.run_to_the_end()) << fleet.conductor_output();
  expect_the_log_of_one_process(fleet);
  for (const std::string& name : fleet.participants()) EXPECT_EQ(fleet.at(name).wait(), 0) << name;
}

TEST(LockstepProcesses, WriteItWithoutLookahead) {
  LockstepFleet fleet = fleet_of("6");
  fleet.start_all({"--no-lookahead"});
  ASSERT_TRUE(fleet.run_to_the_end()) << fleet.conductor_output();
  expect_the_log_of_one_process(fleet);
}

TEST(LockstepProcesses, WriteItWithTwoThreads) {
  LockstepFleet fleet("two_vehicles", {"scenario.duration_s=6", "channel_server.threads=2"});
  fleet.start_all();
  ASSERT_TRUE(fleet.run_to_the_end()) << fleet.conductor_output();
  EXPECT_TRUE(fleet.log_bytes() == fleet.log_of_one_process({"channel_server.threads=1"}));
}

class SplitOverShards : public ::testing::TestWithParam<std::tuple<int, NetworkFaults>> {};

TEST_P(SplitOverShards, WriteTheOutputOfOneServerAndTheLogOfOneProcess) {
  const auto& [shards, faults] = GetParam();
  LockstepFleet fleet("ten_vehicles", {"scenario.duration_s=15"}, faults, shards);
  fleet.start_all();
  ASSERT_TRUE(fleet.run_to_the_end()) << fleet.conductor_output();
  const std::string one = fleet.output_of_one_process();
  EXPECT_GT(one.size(), 200'000u);
  EXPECT_TRUE(fleet.output_bytes() == one) << fleet.conductor_output();
  EXPECT_TRUE(fleet.log_bytes() ==
              fleet.log_of_one_process({"channel_server.shards=" + std::to_string(shards)}));
}

std::string name_of_split(const ::testing::TestParamInfo<std::tuple<int, NetworkFaults>>& info) {
  const auto& [shards, faults] = info.param;
  return std::to_string(shards) + "Shards" + (faults.loss > 0 ? "5PercentLost" : "");
}

INSTANTIATE_TEST_SUITE_P(LockstepProcesses, SplitOverShards,
                         ::testing::Combine(::testing::Values(2, 3),
                                            ::testing::Values(NetworkFaults{},
                                                              NetworkFaults{0.05, 0.05, 0.05})),
                         name_of_split);

TEST(LockstepProcesses, AKilledShardReturns) {
  LockstepFleet fleet("ten_vehicles", {"scenario.duration_s=60"}, {}, 2);
  const std::string one = fleet.output_of_one_process();
  const std::size_t size = fleet.log_of_one_process({"channel_server.shards=2"}).size();
  fleet.start_all();
  int kills = 0;
  for (const char* shard : {"channel-server-0", "channel-server-1", "channel-server-0"}) {
    ASSERT_TRUE(fleet.wait_for_log(size * ++kills / 5)) << fleet.conductor_output();
    fleet.kill_and_restart(shard);
  }
  ASSERT_TRUE(fleet.run_to_the_end()) << fleet.conductor_output();
  EXPECT_THAT(fleet.conductor_output(), HasSubstr("returned participant=channel-server-"));
  EXPECT_TRUE(fleet.output_bytes() == one);
}

// States by dead reckoning, vehicles in two blocks: one of the simulators is killed, and so is the other.
TEST(LockstepProcesses, AKilledBlockOfVehiclesReturns) {
  LockstepFleet fleet("ten_vehicles", {"scenario.duration_s=60", "vehicle_sim.state_deviation_m=0.2"}, {}, 1,
                      2);
  const std::string one = fleet.output_of_one_process();
  const std::string whole = fleet.log_of_one_process({"vehicle_sim.blocks=2"});
  fleet.start_all();
  std::size_t kills = 0;
  for (const char* block : {"vehicle-sim-0", "vehicle-sim-1", "vehicle-sim-0"}) {
    ASSERT_TRUE(fleet.wait_for_log(whole.size() * ++kills / 5)) << fleet.conductor_output();
    fleet.kill_and_restart(block);
  }
  ASSERT_TRUE(fleet.run_to_the_end()) << fleet.conductor_output();
  EXPECT_THAT(fleet.conductor_output(), HasSubstr("returned participant=vehicle-sim-"));
  EXPECT_TRUE(fleet.output_bytes() == one);
  EXPECT_TRUE(fleet.log_bytes() == whole);
}

class WithFaults : public ::testing::TestWithParam<NetworkFaults> {};

TEST_P(WithFaults, WriteTheLogOfOneProcess) {
  LockstepFleet fleet = fleet_of("5", GetParam());
  fleet.start_all();
  ASSERT_TRUE(fleet.run_to_the_end()) << fleet.conductor_output();
  EXPECT_THAT(fleet.conductor_output(), Not(HasSubstr("retransmissions=0"))) << "no datagram was lost";
  expect_the_log_of_one_process(fleet);
}

INSTANTIATE_TEST_SUITE_P(LockstepProcesses, WithFaults,
                         ::testing::Values(NetworkFaults{0.01, 0.01, 0.01}, NetworkFaults{0.05, 0.05, 0.05},
                                           NetworkFaults{0.2, 0.1, 0.2}),
                         [](const auto& parameter) {
                           return "Loss" + std::to_string(static_cast<int>(100 * parameter.param.loss)) +
                                  "Percent";
                         });

// Kills the processes one after the other, at equal parts of the log.
void kill_each(LockstepFleet& fleet, const std::vector<std::string>& names) {
  const std::size_t size = fleet.log_of_one_process().size();
  std::size_t kills = 0;
  fleet.start_all();
  for (const std::string& name : names) {
    ASSERT_TRUE(fleet.wait_for_log(size * ++kills / (names.size() + 2))) << fleet.conductor_output();
    ASSERT_TRUE(fleet.at("conductor").running()) << "the run was too short";
    fleet.kill_and_restart(name);
  }
}

TEST(LockstepProcesses, AKilledParticipantReturns) {
  LockstepFleet fleet = fleet_of("120");
  kill_each(fleet, fleet.participants());
  ASSERT_TRUE(fleet.run_to_the_end()) << fleet.conductor_output();
  EXPECT_THAT(fleet.conductor_output(), HasSubstr("returned participant="));
  expect_the_log_of_one_process(fleet);
}

TEST(LockstepProcesses, AKilledConductorReturns) {
  LockstepFleet fleet = fleet_of("120");
  kill_each(fleet, {"conductor", "conductor", "conductor", "conductor"});
  ASSERT_TRUE(fleet.run_to_the_end()) << fleet.conductor_output();
  EXPECT_THAT(fleet.conductor_output(), HasSubstr("resumed t="));
  expect_the_log_of_one_process(fleet);
}

// A fixed bug: killed between its last step and the end of its log, it refused the journal of a run that is
// over.
TEST(LockstepProcesses, AConductorKilledBeforeTheEndOfItsLogWritesIt) {
  LockstepFleet fleet = fleet_of("6");
  fleet.start_all();
  ASSERT_TRUE(fleet.run_to_the_end()) << fleet.conductor_output();
  fleet.cut_log_in_half();
  fleet.start_conductor();
  EXPECT_EQ(fleet.at("conductor").wait(), 0) << fleet.conductor_output();
  expect_the_log_of_one_process(fleet);
}

TEST(LockstepProcesses, AConductorThatRefusesItsJournalLeavesTheLogAsItWas) {
  LockstepFleet fleet = fleet_of("6");
  fleet.start_all();
  ASSERT_TRUE(fleet.run_to_the_end()) << fleet.conductor_output();
  const std::string log = fleet.log_bytes();
  fleet.start_conductor({"--set", "scenario.seed=77"});
  EXPECT_NE(fleet.at("conductor").wait(), 0);
  EXPECT_THAT(fleet.conductor_output(),
              HasSubstr("the journal is of another run; remove it or name another: scenario"));
  EXPECT_EQ(fleet.log_bytes(), log);
}

// HALOCLINE_CHAOS_KILLS: how often each is killed; scripts/determinism asks for 50.
TEST(LockstepProcesses, AllReturnWhereverTheyAreKilled) {
  const char* requested = std::getenv("HALOCLINE_CHAOS_KILLS");
  const int kills = requested == nullptr ? 3 : std::atoi(requested);
  LockstepFleet fleet = fleet_of(std::to_string(30 + 15 * kills), {0.01, 0.01, 0.01});
  std::vector<std::string> victims;
  for (int i = 0; i < kills; ++i) {
    victims.insert(victims.end(), {"conductor", "bathymetry", "vehicle-sim", "autopilot", "channel-server"});
  }
  std::mt19937 random(20261122);
  std::shuffle(victims.begin(), victims.end(), random);
  kill_each(fleet, victims);
  ASSERT_TRUE(fleet.run_to_the_end()) << fleet.conductor_output();
  expect_the_log_of_one_process(fleet);
}

TEST(LockstepProcesses, ASlowParticipantIsWaitedFor) {
  LockstepFleet fleet = fleet_of("20");
  fleet.start_all();
  ASSERT_TRUE(fleet.wait_for_log(kUnderWay)) << fleet.conductor_output();
  fleet.at("autopilot").signal(SIGSTOP);
  std::this_thread::sleep_for(1500ms);
  fleet.at("autopilot").signal(SIGCONT);
  ASSERT_TRUE(fleet.run_to_the_end()) << fleet.conductor_output();
  expect_the_log_of_one_process(fleet);
}

TEST(LockstepProcesses, ASilentParticipantIsDroppedAfterTheTimeoutAndMayReturn) {
  LockstepFleet fleet = fleet_of("6000");
  fleet.start_all({"--drop-after", "0.5", "--rate", "10"});
  ASSERT_TRUE(fleet.wait_for_log(kUnderWay)) << fleet.conductor_output();
  fleet.at("localiser").signal(SIGKILL);
  fleet.at("localiser").wait();
  EXPECT_TRUE(fleet.wait_for_output("dropped participant=localiser")) << fleet.conductor_output();
  fleet.start("localiser");
  EXPECT_TRUE(fleet.wait_for_output("returned participant=localiser")) << fleet.conductor_output();
  fleet.at("conductor").signal(SIGTERM);
  EXPECT_EQ(fleet.at("conductor").wait(), 0) << fleet.conductor_output();
  EXPECT_EQ(fleet.at("localiser").wait(), 0);
}

TEST(LockstepProcesses, AParticipantThatIsStoppedLeavesAndTheOthersContinue) {
  LockstepFleet fleet = fleet_of("6000");
  fleet.start_all({"--rate", "20"});
  ASSERT_TRUE(fleet.wait_for_log(kUnderWay)) << fleet.conductor_output();
  fleet.at("traffic").signal(SIGTERM);
  EXPECT_EQ(fleet.at("traffic").wait(), 0);
  EXPECT_TRUE(fleet.wait_for_output("leaves participant=traffic")) << fleet.conductor_output();
  EXPECT_TRUE(fleet.wait_for_log(fleet.log_bytes().size() + kUnderWay)) << fleet.conductor_output();
  EXPECT_TRUE(fleet.at("conductor").running());
}

TEST(LockstepProcesses, AParticipantThatWasNotExpectedJoinsAtTheInstantReported) {
  LockstepFleet fleet = fleet_of("6000");
  fleet.start_conductor(
      {"--rate", "20", "--expect", "bathymetry,vehicle-sim,autopilot,localiser,channel-server"});
  for (const std::string& name : fleet.participants()) {
    if (name != "traffic") fleet.start(name);
  }
  ASSERT_TRUE(fleet.wait_for_log(kUnderWay)) << fleet.conductor_output();
  fleet.start("traffic");
  EXPECT_TRUE(fleet.wait_for_output("joined participant=traffic t=")) << fleet.conductor_output();
  EXPECT_THAT(fleet.conductor_output(), Not(HasSubstr("joined participant=traffic t=0.000000")));
}

TEST(LockstepProcesses, AConductorThatIsStoppedEndsTheRunOfAll) {
  LockstepFleet fleet = fleet_of("6000");
  fleet.start_all({"--rate", "20"});
  ASSERT_TRUE(fleet.wait_for_log(kUnderWay)) << fleet.conductor_output();
  fleet.at("conductor").signal(SIGTERM);
  EXPECT_EQ(fleet.at("conductor").wait(), 0) << fleet.conductor_output();
  for (const std::string& name : fleet.participants()) EXPECT_EQ(fleet.at(name).wait(), 0) << name;
}

// Two vehicles that know LCM and the message types alone join the scenario's; the conductor is killed once.
TEST(LockstepProcesses, VehiclesOnTheOrdinaryBusTakePart) {
  LockstepFleet fleet = fleet_of("30");
  fleet.start_all({"--bridge-bus", "--rate", "2"});
  Process visitor({HALOCLINE_BIN_DIR "/foreign-vehicle", "--name", "visitor", "--id", "77", "--depth", "30",
                   "--every", "1.7"});
  Process neighbour({HALOCLINE_BIN_DIR "/foreign-vehicle", "--name", "neighbour", "--id", "78", "--depth",
                     "40", "--north", "300", "--every", "0"});
  ASSERT_TRUE(fleet.wait_for_log(fleet.log_of_one_process().size() / 3)) << fleet.conductor_output();
  fleet.kill_and_restart("conductor");
  ASSERT_TRUE(fleet.run_to_the_end()) << fleet.conductor_output();
  EXPECT_THAT(visitor.output(), HasSubstr("packet 0 accepted"));
  EXPECT_THAT(neighbour.output(), HasSubstr(": from vehicle 77, "));
  auto events = fleet.events_by_channel();
  EXPECT_GT(events["STATE.visitor"], 200) << "ten a second for thirty seconds, at best";
  EXPECT_GT(events["LINKS.visitor"], 20);
  EXPECT_GE(events["SEND.visitor"], 8);
  EXPECT_EQ(events["RECEIPT.visitor"], events["SEND.visitor"]);
  EXPECT_GT(events["RECEIVE.neighbour"], 5);
  EXPECT_EQ(events["CLOCK"], 301) << "the run's own messages are not bridged back";
}

TEST(LockstepProcesses, AWarningNamesTheParticipantsWaitedFor) {
  LockstepFleet fleet = fleet_of("5");
  fleet.start_conductor();
  for (const std::string& name : fleet.participants()) {
    if (name != "traffic") fleet.start(name);
  }
  EXPECT_TRUE(fleet.wait_for_output("waiting for=traffic")) << fleet.conductor_output();
}

}  // namespace
}  // namespace halocline
