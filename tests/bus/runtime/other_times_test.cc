// SPDX-License-Identifier: BSD-3-Clause
// Times that are not a conductor's.
#include <gtest/gtest.h>
#include <lcm/lcm-cpp.hpp>

#include "bus/runtime/time_source.h"
#include "core/check.h"
#include "core/sim_time.h"

namespace halocline::bus {
namespace {

SimTime at(double seconds) { return SimTime::from_seconds(seconds); }

TEST(MessageTime, IsTheGreatestUtimeReceived) {
  lcm::LCM lcm("memq://");
  MessageTime time(lcm, "node");
  EXPECT_FALSE(time.now(at(1)).has_value());
  time.on_utime(5'000'000);
  time.on_utime(4'900'000);
  EXPECT_EQ(time.now(at(100)), at(5));
  EXPECT_FALSE(time.restarted());
  EXPECT_EQ(time.steady_at(at(5)), SimTime::at_once());
  EXPECT_EQ(time.steady_at(at(5.1)), SimTime::never());
}

TEST(MessageTime, ReceivesStatesAndSends) {
  lcm::LCM lcm("memq://");
  MessageTime time(lcm, "node");
  modem_send_t send{};
  send.utime = 3'000'000;
  send.session = send.packet_sequence = 1;
  send.source_id = 1;
  send.destination_id = 0;
  send.payload_size = 0;
  lcm.publish("SEND.a", &send);
  while (lcm.handleTimeout(0) > 0) {
  }
  EXPECT_EQ(time.now(at(0)), at(3));
}

TEST(MessageTime, ALogStartedAnewIsANewRun) {
  lcm::LCM lcm("memq://");
  MessageTime time(lcm, "node");
  time.on_utime(600'000'000);
  time.on_utime(0);
  EXPECT_TRUE(time.restarted());
  EXPECT_FALSE(time.restarted());
  EXPECT_EQ(time.now(at(0)), at(0));
}

TEST(WallTime, IsUnixTimeAtTheStartPlusWhatHasPassed) {
  WallTime time(1'700'000'000'000'000);
  EXPECT_EQ(time.now(at(2))->to_utime(), 1'700'000'002'000'000);
  EXPECT_EQ(time.steady_at(SimTime::from_utime(1'700'000'003'000'000)), at(3));
  EXPECT_EQ(time.steady_at(SimTime::never()), SimTime::never());
  EXPECT_EQ(time.steady_at(SimTime::at_once()), SimTime::at_once());
}

TEST(TimeSourceKind, IsNamed) {
  EXPECT_EQ(time_source_from_name("messages"), TimeSourceKind::kMessages);
  EXPECT_THROW(time_source_from_name("sundial"), InvalidArgument);
}

}  // namespace
}  // namespace halocline::bus
