// SPDX-License-Identifier: BSD-3-Clause
// Programs as separate processes on a bus that somebody attacks: each attack is a datagram, a count and a
// time, as docs/reliability.md lists them. Runs inside a network namespace of its own (scripts/isolated).
#include "tests/integration/attacked/attacked_processes.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bus/runtime/node_process.h"

namespace halocline {
namespace {

using namespace std::chrono_literals;
using testing::AttackedProcesses;
using ::testing::HasSubstr;
using testing::Process;

constexpr std::int64_t kTenYears_us = 315'576'000'000'000;

// One datagram each: the time as expected, at another rate.
TEST_F(AttackedProcesses, AClockOfTheRightSessionWithAnotherRateChangesNothing) {
  ASSERT_TRUE(outcomes_come(4));
  for (const double rate : {1e4, 1e6, 0.0}) {
    sim_clock_t clock = clock_at(monitor_.last_clock_utime + 50'000, clock_session_);
    clock.clock_rate = rate;
    publish("CLOCK", clock);
    ASSERT_TRUE(outcomes_come(4)) << rate;
  }
  for (const char* node : {"vehicle-sim", "channel-server"})
    EXPECT_LT(monitor_.last_status[node].utime, 600'000'000);
  expect_all_running();
}

// One copy of the last STATE of a vehicle with the number 2^62; then heartbeats of a stranger, of its own
// name and session, that list the flow of another far ahead.
TEST_F(AttackedProcesses, NumbersFarAheadSilenceNobody) {
  ASSERT_TRUE(outcomes_come(4));
  vehicle_state_t state = last_state_;
  state.sequence = std::int64_t{1} << 62;
  publish("STATE.alpha", state);
  ASSERT_TRUE(outcomes_come(6));
  for (const std::int64_t ahead : {std::int64_t{1500}, std::int64_t{100'000}, std::int64_t{1} << 61}) {
    for (int i = 0; i < 3; ++i) {
      flow_heartbeat_t heartbeat{};
      heartbeat.utime = monitor_.last_clock_utime;
      heartbeat.session = 987'654'321;
      heartbeat.sequence = i;
      heartbeat.num_flows = heartbeat.num_flows_kept = 1;
      heartbeat.flow_channel = {"STATE.alpha"};
      heartbeat.flow_session = {last_state_.session};
      heartbeat.flow_last_sequence = {last_state_.sequence + ahead};
      publish("HEARTBEAT.stranger", heartbeat);
      std::this_thread::sleep_for(300ms);
    }
    ASSERT_TRUE(outcomes_come(6)) << ahead;
  }
  expect_all_running();
}

TEST_F(AttackedProcesses, AStrayClockChangesNothing) {
  ASSERT_TRUE(outcomes_come(4));
  for (const std::int64_t ahead_us : {kTenYears_us, std::int64_t{3'600'000'000}}) {
    publish("CLOCK", clock_at(monitor_.last_clock_utime + ahead_us, 666));
    for (int i = 0; i < 3; ++i)
      publish("CLOCK", clock_at(monitor_.last_clock_utime + ahead_us + 1000 * i, clock_session_));
    ASSERT_TRUE(outcomes_come(4));
  }
  for (const char* node : {"vehicle-sim", "channel-server"}) {
    EXPECT_TRUE(
        status_shows(node, [](const node_status_t& status) { return status.duplicate_publishers >= 8; }));
    EXPECT_LT(monitor_.last_status[node].utime, 600'000'000);
  }
  EXPECT_THAT(at("halocline-channel-server").output(), HasSubstr("session is of a second conductor"));
  expect_all_running();
  expect_all_obey_sigterm();
}

// Two that agree are accepted once the conductor is silent; what follows is long, and still SIGTERM is
// obeyed.
TEST_F(AttackedProcesses, SigtermIsObeyedTenYearsAhead) {
  ASSERT_TRUE(outcomes_come(1));
  at("halocline-conductor").signal(SIGKILL);
  std::int64_t forged = 0;
  EXPECT_TRUE(status_shows("channel-server", [&](const node_status_t& status) {
    publish("CLOCK", clock_at(kTenYears_us + 1000 * ++forged, clock_session_));
    return status.utime > 3'600'000'000;
  }));
  processes_.erase("halocline-conductor");
  expect_all_obey_sigterm();
}

TEST_F(AttackedProcesses, ASecondConductorEndsAndTheFirstStays) {
  ASSERT_TRUE(outcomes_come(1));
  const auto second = run("halocline-conductor");
  EXPECT_EQ(second->wait(), bus::kExitNetwork);
  EXPECT_THAT(second->output(), HasSubstr("another conductor"));
  EXPECT_TRUE(outcomes_come(2));
  expect_all_running();
}

TEST_F(AttackedProcesses, OfTwoVehicleSimulatorsAndTwoChannelServersTheFirstAreAccepted) {
  ASSERT_TRUE(outcomes_come(1));
  for (const char* program : {"halocline-vehicle-sim", "halocline-channel-server"}) {
    const auto refused = [](const node_status_t& status) { return status.duplicate_publishers; };
    const std::int64_t before = refused(monitor_.last_status["traffic"]);
    const auto second = run(program);
    EXPECT_TRUE(status_shows("traffic", [&](const node_status_t& status) {
      return refused(status) > before;
    })) << program;
    EXPECT_TRUE(outcomes_come(2));
    EXPECT_TRUE(monitor_.wait_until(
        [&] { return second->output().find("a duplicate publisher") != std::string::npos; }));
    EXPECT_THAT(at(program).output(), HasSubstr("a duplicate publisher"));
  }
  expect_all_running();
}

// Without a journal its session is another.
TEST_F(AttackedProcesses, ARestartedServerIsAcceptedOnceTheKilledOneIsSilent) {
  ASSERT_TRUE(outcomes_come(1));
  at("halocline-channel-server").signal(SIGKILL);
  processes_["halocline-channel-server"] = run("halocline-channel-server");
  EXPECT_TRUE(outcomes_come(2));
  monitor_.clear();
  EXPECT_TRUE(monitor_.wait_until([&] { return monitor_.received("RECEIVE.alpha") > 0; }));
}

TEST_F(AttackedProcesses, ABusThatIsAwayFor343MillisecondsEndsNothing) {
  ASSERT_TRUE(outcomes_come(2));
  ASSERT_EQ(
      std::system("PATH=$PATH:/sbin:/usr/sbin; ip link set lo down && sleep 0.343 && ip link set lo up && "
                  "ip route add 224.0.0.0/4 dev lo"),
      0);
  EXPECT_TRUE(outcomes_come(4));
  EXPECT_TRUE(
      status_shows("vehicle-sim", [](const node_status_t& status) { return status.messages_unsent > 0; }));
  EXPECT_THAT(at("halocline-vehicle-sim").output(), HasSubstr("network-is-back"));
  expect_all_running();
  EXPECT_EQ(monitor_.last_status["channel-server"].lost, 0);
}

// 50 requests a second for 200 messages each, for 5 s.
TEST_F(AttackedProcesses, RepairRequestsAreNotTurnedAgainstTheBus) {
  ASSERT_TRUE(outcomes_come(1));
  ASSERT_TRUE(monitor_.wait_until([&] { return last_state_.sequence >= 100; }));
  repair_request_t request{};
  request.client_name = "evil";
  request.missing_channel = "STATE.alpha";
  request.publisher_session = last_state_.session;
  for (std::int64_t i = 0; i < 200; ++i) request.missing_sequence.push_back(i % (last_state_.sequence + 1));
  request.num_missing = 200;
  monitor_.clear();
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < 250; ++i) {
    publish("REPAIR_REQUEST", request);
    monitor_.dispatch_for(0.02);
  }
  const double passed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const std::int64_t published = monitor_.last_status["vehicle-sim"].messages_sent;
  EXPECT_GT(monitor_.received("REPAIR.STATE.alpha"), 0);
  EXPECT_LT(static_cast<double>(monitor_.received("REPAIR.STATE.alpha")),
            std::min(256 + 3 * static_cast<double>(published), 8192.0) + (200 + 3 * 300) * passed_s);
  EXPECT_TRUE(outcomes_come(1));
  expect_all_running();
}

double resident_mb(const Process& process) {
  std::ifstream status("/proc/" + std::to_string(process.pid()) + "/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmRSS:")) return std::stod(line.substr(6)) / 1000;
  }
  return 0;
}

// Legal datagrams of 17 kB, each with 500 flows that nobody has heard of and 2^62 messages in each.
TEST_F(AttackedProcesses, HeartbeatsCostNoMemory) {
  ASSERT_TRUE(outcomes_come(2));
  const double before_mb = resident_mb(at("halocline-channel-server"));
  ASSERT_GT(before_mb, 1);
  for (int datagram = 0; datagram < 11; ++datagram) {
    flow_heartbeat_t heartbeat{};
    heartbeat.session = 1000 + datagram % 2;
    heartbeat.sequence = datagram;
    for (int i = 0; i < 500; ++i) {
      heartbeat.flow_channel.push_back("STATE.x" + std::to_string(500 * datagram + i));
      heartbeat.flow_session.push_back(heartbeat.session);
      heartbeat.flow_last_sequence.push_back(std::int64_t{1} << 62);
    }
    heartbeat.num_flows = heartbeat.num_flows_kept = 500;
    publish("HEARTBEAT.evil" + std::to_string(datagram % 2), heartbeat);
    monitor_.dispatch_for(0.1);
  }
  EXPECT_TRUE(outcomes_come(2));
  EXPECT_LT(resident_mb(at("halocline-channel-server")), before_mb + 10);
  EXPECT_TRUE(
      status_shows("channel-server", [](const node_status_t& s) { return s.gaps >= 0 && s.lost >= 0; }));
}

// One STATE for each of 5000 names, in 1.5 s, all in one place.
TEST_F(AttackedProcesses, AFloodOfNamesCostsNeitherTimeNorMemory) {
  ASSERT_TRUE(outcomes_come(2));
  const double before_mb = resident_mb(at("halocline-channel-server"));
  vehicle_state_t forged = last_state_;
  forged.session = 5;
  forged.sequence = 0;
  for (int i = 0; i < 5000; ++i) {
    forged.utime = monitor_.last_clock_utime;
    forged.vehicle_id = 1000 + i;
    publish("STATE.w" + std::to_string(i), forged);
    if (i % 50 == 0) monitor_.dispatch_for(0.005);
  }
  const std::int64_t flooded_at = monitor_.last_clock_utime;
  const auto is_of_scenario = [&](const packet_outcome_t& outcome) {
    return outcome.source_id <= 2 && outcome.receiver_id <= 2 && outcome.utime > flooded_at;
  };
  double most_mb = 0;
  EXPECT_TRUE(monitor_.wait_until([&] {
    most_mb = std::max(most_mb, resident_mb(at("halocline-channel-server")));
    return std::ranges::count_if(monitor_.outcomes, is_of_scenario) >= 16;
  }));
  EXPECT_LT(monitor_.last_clock_utime, flooded_at + 20'000'000);  // the 16 are of 8 s
  EXPECT_LT(most_mb, before_mb + 50);
  EXPECT_TRUE(
      status_shows("channel-server", [](const node_status_t& s) { return s.messages_refused > 4000; }));
  expect_all_running();
  expect_all_obey_sigterm();
}

}  // namespace
}  // namespace halocline
