// Separate processes in lockstep over udpm write the log of one process, byte for byte, whatever befalls them.
// Runs inside a network namespace of its own (scripts/isolated).
#include <chrono>
#include <csignal>
#include <random>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/integration/lockstep_fleet.h"

namespace halocline {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using testing::LockstepFleet;
using ::testing::Not;
using testing::Process;
using testing::Weather;

constexpr std::chrono::seconds kLimit{120};

void pause(std::chrono::milliseconds duration) { std::this_thread::sleep_for(duration); }

LockstepFleet fleet_of(const std::string& duration_s, Weather weather = {}) {
  return LockstepFleet("two_vehicles", {"scenario.duration_s=" + duration_s}, weather);
}

void expect_the_log_of_one_process(LockstepFleet& fleet) {
  const std::string one = fleet.log_of_one_process();
  EXPECT_GT(one.size(), 50'000u);
  EXPECT_TRUE(fleet.log_bytes() == one) << fleet.conductor_output();
}

TEST(LockstepProcesses, WriteTheLogOfOneProcess) {
  LockstepFleet fleet = fleet_of("12");
  fleet.start_all();
  ASSERT_TRUE(fleet.run_to_the_end(kLimit)) << fleet.conductor_output();
  expect_the_log_of_one_process(fleet);
  for (const std::string& name : fleet.participants()) EXPECT_EQ(fleet.at(name).wait(5s), 0) << name;
}

TEST(LockstepProcesses, WriteItOneByOneAsWell) {
  LockstepFleet fleet = fleet_of("6");
  fleet.start_all({"--no-lookahead"});
  ASSERT_TRUE(fleet.run_to_the_end(kLimit)) << fleet.conductor_output();
  expect_the_log_of_one_process(fleet);
}

TEST(LockstepProcesses, WriteItWithTwoThreadsAsWell) {
  LockstepFleet fleet("two_vehicles", {"scenario.duration_s=6", "channel_server.threads=2"});
  fleet.start_all();
  ASSERT_TRUE(fleet.run_to_the_end(kLimit)) << fleet.conductor_output();
  EXPECT_TRUE(fleet.log_bytes() == fleet.log_of_one_process({"channel_server.threads=1"}));
}

class SplitOverShards : public ::testing::TestWithParam<std::tuple<int, Weather>> {};

TEST_P(SplitOverShards, WriteTheOutputOfOneServerAndTheLogOfOneProcess) {
  const auto& [shards, weather] = GetParam();
  LockstepFleet fleet("ten_vehicles", {"scenario.duration_s=15"}, weather, shards);
  fleet.start_all();
  ASSERT_TRUE(fleet.run_to_the_end(kLimit)) << fleet.conductor_output();
  const std::string one = fleet.output_of_one_process();
  EXPECT_GT(one.size(), 200'000u);
  EXPECT_TRUE(fleet.output_bytes() == one) << fleet.conductor_output();
  EXPECT_TRUE(fleet.log_bytes() ==
              fleet.log_of_one_process({"channel_server.shards=" + std::to_string(shards)}));
}

std::string name_of_split(const ::testing::TestParamInfo<std::tuple<int, Weather>>& info) {
  const auto& [shards, weather] = info.param;
  return std::to_string(shards) + "Shards" + (weather.loss > 0 ? "5PercentLost" : "");
}

INSTANTIATE_TEST_SUITE_P(LockstepProcesses, SplitOverShards,
                         ::testing::Combine(::testing::Values(2, 3),
                                            ::testing::Values(Weather{}, Weather{0.05, 0.05, 0.05})),
                         name_of_split);

TEST(LockstepProcesses, AShardMayDieAndReturn) {
  LockstepFleet fleet("ten_vehicles", {"scenario.duration_s=120"}, {}, 2);
  fleet.start_all();
  for (const char* shard : {"channel-server-0", "channel-server-1", "channel-server-0"}) {
    pause(400ms);
    fleet.kill_and_restart(shard);
  }
  ASSERT_TRUE(fleet.run_to_the_end(kLimit)) << fleet.conductor_output();
  EXPECT_THAT(fleet.conductor_output(), HasSubstr("returned participant=channel-server-"));
  EXPECT_TRUE(fleet.output_bytes() == fleet.output_of_one_process());
}

class InWeather : public ::testing::TestWithParam<Weather> {};

TEST_P(InWeather, WriteTheLogOfOneProcess) {
  LockstepFleet fleet = fleet_of("5", GetParam());
  fleet.start_all();
  ASSERT_TRUE(fleet.run_to_the_end(kLimit)) << fleet.conductor_output();
  EXPECT_THAT(fleet.conductor_output(), Not(HasSubstr("repetitions=0"))) << "the weather was no weather";
  expect_the_log_of_one_process(fleet);
}

INSTANTIATE_TEST_SUITE_P(LockstepProcesses, InWeather,
                         ::testing::Values(Weather{0.01, 0.01, 0.01}, Weather{0.05, 0.05, 0.05},
                                           Weather{0.2, 0.1, 0.2}),
                         [](const auto& parameter) {
                           return "Loss" + std::to_string(static_cast<int>(100 * parameter.param.loss)) +
                                  "Percent";
                         });

TEST(LockstepProcesses, AParticipantMayDieAndReturn) {
  LockstepFleet fleet = fleet_of("240");
  fleet.start_all();
  for (const std::string& name : fleet.participants()) {
    pause(250ms);
    fleet.kill_and_restart(name);
  }
  ASSERT_TRUE(fleet.run_to_the_end(kLimit)) << fleet.conductor_output();
  EXPECT_THAT(fleet.conductor_output(), HasSubstr("returned participant="));
  expect_the_log_of_one_process(fleet);
}

TEST(LockstepProcesses, TheConductorMayDieAndReturn) {
  LockstepFleet fleet = fleet_of("240");
  fleet.start_all();
  for (int i = 0; i < 4; ++i) {
    pause(400ms);
    fleet.kill_and_restart("conductor");
  }
  ASSERT_TRUE(fleet.run_to_the_end(kLimit)) << fleet.conductor_output();
  EXPECT_THAT(fleet.conductor_output(), HasSubstr("resumed t="));
  expect_the_log_of_one_process(fleet);
}

// HALOCLINE_CHAOS_KILLS: how often each is killed; scripts/determinism asks for 50.
TEST(LockstepProcesses, AllMayDieAtAnyInstantAndReturn) {
  const char* asked = std::getenv("HALOCLINE_CHAOS_KILLS");
  const int kills = asked == nullptr ? 3 : std::atoi(asked);
  LockstepFleet fleet = fleet_of(std::to_string(30 + 15 * kills), {0.01, 0.01, 0.01});
  std::vector<std::string> victims;
  for (int i = 0; i < kills; ++i) {
    victims.insert(victims.end(), {"conductor", "bathymetry", "vehicle-sim", "autopilot", "channel-server"});
  }
  std::mt19937 random(20261122);
  std::shuffle(victims.begin(), victims.end(), random);
  fleet.start_all();
  int before_the_end = 0;
  for (const std::string& victim : victims) {
    pause(std::chrono::milliseconds(random() % 120));
    before_the_end += fleet.at("conductor").running();
    if (fleet.at("conductor").wait(0ms) == 0) break;
    fleet.kill_and_restart(victim);
  }
  EXPECT_EQ(before_the_end, static_cast<int>(victims.size())) << "the run was too short for the chaos";
  ASSERT_TRUE(fleet.run_to_the_end(std::chrono::seconds(60 + 40 * kills))) << fleet.conductor_output();
  expect_the_log_of_one_process(fleet);
}

TEST(LockstepProcesses, OneThatIsSlowIsWaitedFor) {
  LockstepFleet fleet = fleet_of("20");
  fleet.start_all();
  pause(300ms);
  fleet.at("autopilot").signal(SIGSTOP);
  pause(1500ms);
  fleet.at("autopilot").signal(SIGCONT);
  ASSERT_TRUE(fleet.run_to_the_end(kLimit)) << fleet.conductor_output();
  expect_the_log_of_one_process(fleet);
}

TEST(LockstepProcesses, OneThatDiesIsDroppedAfterTheTimeSaidAndMayReturn) {
  LockstepFleet fleet = fleet_of("40");
  fleet.start_all({"--drop-after", "0.5", "--rate", "10"});
  pause(1000ms);
  fleet.at("localiser").signal(SIGKILL);
  fleet.at("localiser").wait();
  pause(1500ms);
  EXPECT_THAT(fleet.conductor_output(), HasSubstr("dropped participant=localiser"));
  fleet.start("localiser");
  ASSERT_TRUE(fleet.run_to_the_end(kLimit)) << fleet.conductor_output();
  EXPECT_THAT(fleet.conductor_output(), HasSubstr("returned participant=localiser"));
  EXPECT_EQ(fleet.at("localiser").wait(5s), 0);
}

TEST(LockstepProcesses, OneThatIsToldToStopSaysGoodbyeAndTheOthersGoOn) {
  LockstepFleet fleet = fleet_of("40");
  fleet.start_all({"--rate", "20"});
  pause(1200ms);
  fleet.at("traffic").signal(SIGTERM);
  EXPECT_EQ(fleet.at("traffic").wait(5s), 0);
  EXPECT_THAT(fleet.conductor_output(), HasSubstr("leaves participant=traffic"));
  EXPECT_TRUE(fleet.at("conductor").running());
  ASSERT_TRUE(fleet.run_to_the_end(kLimit)) << fleet.conductor_output();
}

TEST(LockstepProcesses, OneThatWasNotExpectedJoinsAtTheInstantSaid) {
  LockstepFleet fleet = fleet_of("40");
  fleet.start_conductor(
      {"--rate", "20", "--expect", "bathymetry,vehicle-sim,autopilot,localiser,channel-server"});
  for (const std::string& name : fleet.participants()) {
    if (name != "traffic") fleet.start(name);
  }
  pause(1200ms);
  fleet.start("traffic");
  ASSERT_TRUE(fleet.run_to_the_end(kLimit)) << fleet.conductor_output();
  const std::string output = fleet.conductor_output();
  EXPECT_THAT(output, HasSubstr("joined participant=traffic t="));
  EXPECT_EQ(output.find("joined participant=traffic t=0.000000"), std::string::npos) << output;
}

TEST(LockstepProcesses, AConductorThatIsToldToStopSaysGoodbyeToAll) {
  LockstepFleet fleet = fleet_of("600");
  fleet.start_all({"--rate", "20"});
  pause(1500ms);
  fleet.at("conductor").signal(SIGTERM);
  EXPECT_EQ(fleet.at("conductor").wait(8s), 0) << fleet.conductor_output();
  for (const std::string& name : fleet.participants()) EXPECT_EQ(fleet.at(name).wait(5s), 0) << name;
}

// Two vehicles that know LCM and the message types alone swim among the scenario's; the conductor dies once.
TEST(LockstepProcesses, VehiclesFromOutsideTakePart) {
  LockstepFleet fleet = fleet_of("30");
  fleet.start_all({"--bridge-bus", "--rate", "2"});
  Process visitor({HALOCLINE_BIN_DIR "/foreign-vehicle", "--name", "visitor", "--id", "77", "--depth", "30",
                   "--every", "1.7"});
  Process neighbour({HALOCLINE_BIN_DIR "/foreign-vehicle", "--name", "neighbour", "--id", "78", "--depth",
                     "40", "--north", "300", "--every", "0"});
  pause(6s);
  fleet.kill_and_restart("conductor");
  ASSERT_TRUE(fleet.run_to_the_end(kLimit)) << fleet.conductor_output();
  EXPECT_THAT(visitor.output(), HasSubstr("was accepted"));
  EXPECT_THAT(neighbour.output(), HasSubstr("from vehicle 77 after 0."));
  auto events = fleet.events_by_channel();
  EXPECT_GT(events["STATE.visitor"], 200) << "ten a second for thirty seconds, at best";
  EXPECT_GT(events["LINKS.visitor"], 20);
  EXPECT_GE(events["SEND.visitor"], 8);
  EXPECT_EQ(events["RECEIPT.visitor"], events["SEND.visitor"]);
  EXPECT_GT(events["RECEIVE.neighbour"], 5);
  EXPECT_EQ(events["CLOCK"], 301) << "what the run itself shows is not heard from outside";
}

TEST(LockstepProcesses, WhoIsMissingIsNamed) {
  LockstepFleet fleet = fleet_of("5");
  fleet.start_conductor();
  for (const std::string& name : fleet.participants()) {
    if (name != "traffic") fleet.start(name);
  }
  pause(6500ms);
  EXPECT_THAT(fleet.conductor_output(), HasSubstr("waiting for=traffic"));
}

}  // namespace
}  // namespace halocline
