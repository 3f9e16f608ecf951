// SPDX-License-Identifier: BSD-3-Clause
// Old messages sent again, by themselves and as whole logs, and a server that was stopped
// (docs/reliability.md).
#include <algorithm>
#include <csignal>
#include <cstdint>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "bus/bus.h"
#include "bus/messages/message_codec.h"
#include "tests/integration/attacked/attacked_processes.h"

namespace halocline {
namespace {

using testing::AttackedProcesses;
using ::testing::HasSubstr;
using ::testing::Not;

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
  const auto refused = [&] { return monitor_.last_status["channel-server"].duplicate_publishers; };
  const std::int64_t refused_before = refused();
  for (int i = 0; i < 5; ++i) {
    for (const auto& [channel, datagram] : old) publish(datagram);
    ASSERT_TRUE(time_passes(2));
    EXPECT_TRUE(vehicles_keep_time()) << last_state_.utime << ' ' << latest_clock_utime_;
  }
  EXPECT_GE(expect_outcomes_whole(), before + 16);
  EXPECT_EQ(refused(), refused_before);
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
  EXPECT_TRUE(monitor_.wait_until([&] {
    publish(old);
    publish(status);
    return monitor_.received("RECEIVE.alpha") > 0;
  }));
  const auto refused = [&] { return monitor_.last_status["traffic"].duplicate_publishers; };
  EXPECT_TRUE(monitor_.wait_until([&] {
    publish(old);
    publish(status);
    const std::int64_t before = refused();
    monitor_.dispatch_for(2);
    return refused() == before;  // traffic accepts the new one
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
  ASSERT_TRUE(monitor_.wait_until([&] {
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
  ASSERT_TRUE(monitor_.wait_until([&] { return !player->running(); }));
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
  ASSERT_TRUE(monitor_.wait_until([&] { return std::ranges::any_of(recorded_, is_send); }));
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
  ASSERT_TRUE(monitor_.wait_until([&] { return !receipts_of_it().empty(); }));
  ASSERT_TRUE(time_passes(12));
  const std::size_t before = receipts_of_it().size();
  publish(send);
  ASSERT_TRUE(monitor_.wait_until([&] { return receipts_of_it().size() > before; }));
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
  EXPECT_THAT(output, HasSubstr("real-time-not-kept"));
  EXPECT_EQ(output.find("real-time-not-kept"), output.rfind("real-time-not-kept"));  // once a minute
  expect_all_running();
}

}  // namespace
}  // namespace halocline
