// SPDX-License-Identifier: BSD-3-Clause
// Programs as separate processes on a bus that somebody attacks: each attack is a datagram, a count and a time, as docs/reliability.md lists
// them. Runs inside a network namespace of its own (scripts/isolated).
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "bus/message_codec.h"
#include "bus/runtime/node_process.h"
#include "tests/integration/bus_monitor.h"
#include "tests/support/process.h"

namespace halocline {
namespace {

using namespace std::chrono_literals;
using testing::BusMonitor;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::Process;

const char* const kScenario = HALOCLINE_TEST_DATA "/scenarios/two_vehicles.toml";
constexpr double kLongest_s = 60;
constexpr std::int64_t kTenYears_us = 315'576'000'000'000;

class AttackedProcesses : public ::testing::Test {
 protected:
  AttackedProcesses() {
    monitor_.lcm().subscribe(".*", &AttackedProcesses::on_any, this);
    for (const char* program : {"halocline-conductor", "halocline-bathymetry", "halocline-vehicle-sim",
                                "halocline-channel-server", "halocline-traffic"})
      processes_[program] = run(program);
  }
  static std::unique_ptr<Process> run(const std::string& program) {
    return std::make_unique<Process>(std::vector<std::string>{HALOCLINE_BIN_DIR "/" + program, kScenario});
  }
  Process& at(const std::string& program) { return *processes_.at(program); }

  bool outcomes_come(std::size_t count) {
    const std::size_t before = monitor_.outcomes.size();
    return monitor_.wait_until(kLongest_s, [&] { return monitor_.outcomes.size() >= before + count; });
  }
  bool status_shows(const std::string& node, const std::function<bool(const node_status_t&)>& what) {
    return monitor_.wait_until(kLongest_s, [&] {
      const auto status = monitor_.last_status.find(node);
      return status != monitor_.last_status.end() && what(status->second);
    });
  }
  void expect_all_running() {
    for (const auto& [program, process] : processes_)
      EXPECT_TRUE(process->running()) << program << process->output();
  }
  // Within a second; a busy machine may add to that.
  void expect_all_obey_sigterm() {
    const auto begin = std::chrono::steady_clock::now();
    for (const auto& [program, process] : processes_) process->signal(SIGTERM);
    for (const auto& [program, process] : processes_)
      EXPECT_EQ(process->wait(), 0) << program << process->output();
    EXPECT_LT(std::chrono::steady_clock::now() - begin, 10s);
  }
  template <class Message>
  void publish(const std::string& channel, const Message& message) {
    const bus::Bytes bytes = bus::encoded(message);
    monitor_.lcm().publish(channel, bytes.data(), static_cast<unsigned>(bytes.size()));
  }
  static sim_clock_t clock_at(std::int64_t utime, std::int64_t session) {
    sim_clock_t clock{};
    clock.utime = utime;
    clock.session = session;
    clock.clock_rate = 1;
    clock.clock_step_us = 100'000;
    return clock;
  }

  // A datagram of the bus, as lcm-logger has it.
  struct Datagram {
    std::int64_t stamp_us = 0;
    std::string channel;
    bus::Bytes bytes;
  };
  void publish(const Datagram& datagram) {
    monitor_.lcm().publish(datagram.channel, datagram.bytes.data(),
                           static_cast<unsigned>(datagram.bytes.size()));
  }
  void write_log(const std::string& path) const {
    lcm::LogFile log(path, "w");
    for (const Datagram& datagram : recorded_) {
      lcm::LogEvent event{};
      event.timestamp = datagram.stamp_us;
      event.channel = datagram.channel;
      event.datalen = static_cast<std::int32_t>(datagram.bytes.size());
      bus::Bytes bytes = datagram.bytes;
      event.data = bytes.data();
      log.writeEvent(&event);
    }
  }
  static std::unique_ptr<Process> play(const std::string& log) {
    return std::make_unique<Process>(
        std::vector<std::string>{"/usr/bin/lcm-logplayer", "--lcm-url=" + bus::effective_url(""), log});
  }
  bool time_passes(double seconds) {
    const std::int64_t end = latest_clock_utime_ + static_cast<std::int64_t>(seconds * 1e6);
    return monitor_.wait_until(kLongest_s + seconds, [&] { return latest_clock_utime_ >= end; });
  }
  // Every packet of the two senders from its first accepted one has one outcome, none is left out; copies of a
  // message count once. Returns how many there are.
  std::size_t expect_outcomes_whole(const std::set<std::int64_t>& foreign_sessions = {}) {
    std::map<std::pair<std::int64_t, std::int64_t>, packet_outcome_t> by_number;
    for (const packet_outcome_t& outcome : monitor_.outcomes) {
      if (!foreign_sessions.contains(outcome.session))
        by_number.emplace(std::pair(outcome.session, outcome.sequence), outcome);
    }
    std::map<std::int64_t, std::vector<std::int64_t>> packets;  // by the sender's session
    for (const auto& [number, outcome] : by_number) {
      packets[outcome.send_session].push_back(outcome.packet_sequence);
      EXPECT_NE(outcome.outcome, packet_outcome_t::RECEIVER_GONE) << outcome.utime;
    }
    EXPECT_EQ(packets.size(), 2u);
    for (auto& [session, sequences] : packets) {
      EXPECT_FALSE(foreign_sessions.contains(session));
      std::ranges::sort(sequences);
      for (std::size_t i = 0; i < sequences.size(); ++i)
        EXPECT_EQ(sequences[i], sequences.front() + static_cast<std::int64_t>(i)) << session;
    }
    return by_number.size();
  }
  // The vehicles' time is that of CLOCK, to some seconds: a busy machine may take them.
  bool vehicles_keep_time() const { return latest_clock_utime_ - last_state_.utime < 5'000'000; }

  BusMonitor monitor_;
  std::vector<Datagram> recorded_;
  bool records_ = false;
  std::int64_t latest_clock_utime_ = 0;
  std::map<std::string, Datagram> first_of_;  // by channel
  std::set<std::int64_t> sessions_;           // those of all OUTCOMEs and SENDs so far
  std::map<std::string, std::unique_ptr<Process>> processes_;
  std::int64_t clock_session_ = 0;  // of the last CLOCK
  vehicle_state_t last_state_{};    // STATE.alpha

 private:
  void on_any(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
    const std::span bytes(static_cast<const std::uint8_t*>(buffer->data), buffer->data_size);
    const Datagram datagram{buffer->recv_utime, channel, {bytes.begin(), bytes.end()}};
    first_of_.emplace(channel, datagram);
    if (records_) recorded_.push_back(datagram);
    modem_send_t send;
    packet_outcome_t outcome;
    if (bus::decode(bytes, send).empty()) sessions_.insert(send.session);
    if (bus::decode(bytes, outcome).empty()) sessions_.insert(outcome.session);
    if (channel == "CLOCK") {
      sim_clock_t clock;
      if (bus::decode(bytes, clock).empty()) clock_session_ = clock.session;
      if (clock.utime < latest_clock_utime_ + 60'000'000)  // not made up
        latest_clock_utime_ = std::max(latest_clock_utime_, clock.utime);
    } else if (channel == "STATE.alpha") {
      vehicle_state_t state;
      if (bus::decode(bytes, state).empty() && state.utime >= last_state_.utime) last_state_ = state;
    }
  }
};

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

// One copy of the last STATE of a vehicle with the number 2^62; then heartbeats of a stranger, of its own name and session, that list the flow of
// another far ahead.
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

// One genuine CLOCK, 9 s old and older, every 2 s.
TEST_F(AttackedProcesses, AnOldClockSentAgainChangesNothing) {
  ASSERT_TRUE(outcomes_come(4));
  const Datagram old = first_of_.at("CLOCK");
  ASSERT_TRUE(time_passes(9));
  const std::size_t before = expect_outcomes_whole();
  for (int i = 0; i < 8; ++i) {
    publish(old);
    ASSERT_TRUE(time_passes(2));
    EXPECT_TRUE(vehicles_keep_time()) << last_state_.utime << ' ' << latest_clock_utime_;
  }
  EXPECT_GE(expect_outcomes_whole(), before + 28);  // two a second, and some are under way
  EXPECT_THAT(at("halocline-channel-server").output(), Not(HasSubstr("message-refused channel=CLOCK")));
  expect_all_running();
}

// The first message of each channel, and a vehicle's own beside them, every 2 s: STATE, SENSORS, LINKS,
// HEARTBEAT, STATUS, SCENARIO, ...
TEST_F(AttackedProcesses, OldMessagesOfEveryChannelSentAgainChangeNothing) {
  ASSERT_TRUE(outcomes_come(6));
  const std::map<std::string, Datagram> old = first_of_;
  ASSERT_GE(old.size(), 20u);
  ASSERT_TRUE(time_passes(9));
  const std::size_t before = expect_outcomes_whole();
  const auto rivals = [&] { return monitor_.last_status["channel-server"].rivals; };
  const std::int64_t rivals_before = rivals();
  for (int i = 0; i < 5; ++i) {
    for (const auto& [channel, datagram] : old) publish(datagram);
    ASSERT_TRUE(time_passes(2));
    EXPECT_TRUE(vehicles_keep_time()) << last_state_.utime << ' ' << latest_clock_utime_;
  }
  EXPECT_GE(expect_outcomes_whole(), before + 16);
  EXPECT_EQ(rivals(), rivals_before);
  expect_all_running();
}

// Heartbeats of a killed server, again and again, do not keep its name from the one that takes its place.
TEST_F(AttackedProcesses, OldHeartbeatsOfAKilledServerDoNotKeepItsName) {
  ASSERT_TRUE(outcomes_come(2));
  const Datagram old = first_of_.at("HEARTBEAT.channel-server"),
                 status = first_of_.at("STATUS.channel-server");
  at("halocline-channel-server").signal(SIGKILL);
  processes_["halocline-channel-server"] = run("halocline-channel-server");
  monitor_.clear();
  EXPECT_TRUE(monitor_.wait_until(kLongest_s, [&] {
    publish(old);
    publish(status);
    return monitor_.received("RECEIVE.alpha") > 0;
  }));
  const auto rivals = [&] { return monitor_.last_status["traffic"].rivals; };
  EXPECT_TRUE(monitor_.wait_until(kLongest_s, [&] {
    publish(old);
    publish(status);
    const std::int64_t before = rivals();
    monitor_.dispatch_for(2);
    return rivals() == before;  // traffic believes the new one
  }));
}

TEST_F(AttackedProcesses, TheWholeBusOfTheRunReplayedOntoItChangesNothing) {
  ASSERT_TRUE(outcomes_come(4));
  records_ = true;
  ASSERT_TRUE(time_passes(9));
  records_ = false;
  const std::string log = ::testing::TempDir() + "own-" + std::to_string(getpid()) + ".lcm";
  write_log(log);
  const std::size_t before = expect_outcomes_whole();
  const auto player = play(log);
  ASSERT_TRUE(monitor_.wait_until(kLongest_s, [&] {
    EXPECT_TRUE(vehicles_keep_time()) << last_state_.utime << ' ' << latest_clock_utime_;
    return !player->running() || HasFailure();
  }));
  EXPECT_EQ(player->wait(), 0) << player->output();
  EXPECT_GE(expect_outcomes_whole(), before + 14);
  expect_all_running();
}

// The same programs with other sessions, at times that the run has not left behind for long: their SENDs
// would be transmitted.
TEST_F(AttackedProcesses, TheBusOfAnEarlierRunReplayedOntoThisOneChangesNothing) {
  records_ = true;
  ASSERT_TRUE(outcomes_come(8));
  records_ = false;
  const std::string log = ::testing::TempDir() + "earlier-" + std::to_string(getpid()) + ".lcm";
  write_log(log);
  for (const auto& [program, process] : processes_) process->signal(SIGKILL);
  monitor_.dispatch_for(0.5);
  const std::set<std::int64_t> earlier = sessions_;
  monitor_.outcomes.clear();
  latest_clock_utime_ = last_state_.utime = 0;
  for (auto& [program, process] : processes_) process = run(program);
  ASSERT_TRUE(outcomes_come(1));
  const auto player = play(log);
  ASSERT_TRUE(monitor_.wait_until(kLongest_s, [&] { return !player->running(); }));
  EXPECT_EQ(player->wait(), 0) << player->output();
  ASSERT_TRUE(outcomes_come(4));
  expect_outcomes_whole(earlier);
  expect_all_running();
}

TEST_F(AttackedProcesses, ASendRepeatedAfterTwelveSecondsHasTheSameReceipt) {
  std::vector<modem_receipt_t> receipts;
  bus::Bus listener(monitor_.lcm(), {"listener", 0});
  listener.subscribe<modem_receipt_t>("RECEIPT.alpha",
                                      [&](const modem_receipt_t& receipt) { receipts.push_back(receipt); });
  ASSERT_TRUE(outcomes_come(4));
  records_ = true;
  const auto is_send = [](const Datagram& datagram) { return datagram.channel == "SEND.alpha"; };
  ASSERT_TRUE(monitor_.wait_until(kLongest_s, [&] { return std::ranges::any_of(recorded_, is_send); }));
  const Datagram send = *std::ranges::find_if(recorded_, is_send);
  modem_send_t request;
  ASSERT_EQ(bus::decode(send.bytes, request), "");
  const auto receipts_of_it = [&] {
    std::vector<modem_receipt_t> of_it;
    std::ranges::copy_if(receipts, std::back_inserter(of_it), [&](const modem_receipt_t& receipt) {
      return receipt.send_session == request.session && receipt.packet_sequence == request.packet_sequence;
    });
    return of_it;
  };
  ASSERT_TRUE(monitor_.wait_until(kLongest_s, [&] { return !receipts_of_it().empty(); }));
  ASSERT_TRUE(time_passes(12));
  const std::size_t before = receipts_of_it().size();
  publish(send);
  ASSERT_TRUE(monitor_.wait_until(kLongest_s, [&] { return receipts_of_it().size() > before; }));
  EXPECT_EQ(receipts_of_it().back().receipt_result, receipts_of_it().front().receipt_result);
  EXPECT_EQ(receipts_of_it().back().start_utime, receipts_of_it().front().start_utime);
  EXPECT_EQ(receipts_of_it().front().receipt_result, modem_receipt_t::ACCEPTED);
}

// Longer than a state may lie ahead of a server's time, and than its socket holds on a busier bus.
TEST_F(AttackedProcesses, AServerThatWasStoppedSaysSoAndDecidesAsIfItHadNotBeen) {
  ASSERT_TRUE(outcomes_come(2));
  at("halocline-channel-server").signal(SIGSTOP);
  ASSERT_TRUE(time_passes(40));
  at("halocline-channel-server").signal(SIGCONT);
  ASSERT_TRUE(outcomes_come(90));  // two a second
  expect_outcomes_whole();
  EXPECT_TRUE(status_shows("channel-server", [](const node_status_t& status) {
    return status.late >= 60 && status.lateness_max_s >= 30 && status.lateness_limit_s == 0.05 &&
           status.lateness_p99_s <= status.lateness_max_s && status.lateness_p50_s <= status.lateness_p99_s;
  }));
  const std::string output = at("halocline-channel-server").output();
  EXPECT_THAT(output, HasSubstr("real-time-not-held"));
  EXPECT_EQ(output.find("real-time-not-held"), output.rfind("real-time-not-held"));  // once a minute
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
    EXPECT_TRUE(status_shows(node, [](const node_status_t& status) { return status.rivals >= 8; }));
    EXPECT_LT(monitor_.last_status[node].utime, 600'000'000);
  }
  EXPECT_THAT(at("halocline-channel-server").output(), HasSubstr("session is of a second conductor"));
  expect_all_running();
  expect_all_obey_sigterm();
}

// Two that agree are believed once the conductor is silent; what follows is long, and still SIGTERM is obeyed.
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

TEST_F(AttackedProcesses, OfTwoVehicleSimulatorsAndTwoChannelServersTheFirstAreBelieved) {
  ASSERT_TRUE(outcomes_come(1));
  for (const char* program : {"halocline-vehicle-sim", "halocline-channel-server"}) {
    const auto rivals = [](const node_status_t& status) { return status.rivals; };
    const std::int64_t before = rivals(monitor_.last_status["traffic"]);
    const auto second = run(program);
    EXPECT_TRUE(status_shows("traffic", [&](const node_status_t& status) { return rivals(status) > before; }))
        << program;
    EXPECT_TRUE(outcomes_come(2));
    EXPECT_TRUE(monitor_.wait_until(kLongest_s,
                                    [&] { return second->output().find("a rival's") != std::string::npos; }));
    EXPECT_THAT(at(program).output(), HasSubstr("a rival's"));
  }
  expect_all_running();
}

// Without a journal its session is another.
TEST_F(AttackedProcesses, ARestartedServerIsBelievedOnceTheKilledOneIsSilent) {
  ASSERT_TRUE(outcomes_come(1));
  at("halocline-channel-server").signal(SIGKILL);
  processes_["halocline-channel-server"] = run("halocline-channel-server");
  EXPECT_TRUE(outcomes_come(2));
  monitor_.clear();
  EXPECT_TRUE(monitor_.wait_until(kLongest_s, [&] { return monitor_.received("RECEIVE.alpha") > 0; }));
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
  ASSERT_TRUE(monitor_.wait_until(kLongest_s, [&] { return last_state_.sequence >= 100; }));
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
  EXPECT_TRUE(monitor_.wait_until(kLongest_s, [&] {
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
