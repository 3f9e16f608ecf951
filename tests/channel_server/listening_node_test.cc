// SPDX-License-Identifier: BSD-3-Clause
// How modems listen and what they report, on the bus.
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bus/transport/event_log.h"
#include "tests/channel_server/node_bench.h"

namespace halocline::channel_server {
namespace {

using ::testing::ElementsAre;
using testing::NodeBench;

class ListeningNodeTest : public ::testing::Test {
 protected:
  void SetUp() override { bus::set_log_level(bus::LogLevel::kSilent); }
  // Two vehicles at rest, 2 s of sound apart.
  static void two_at_rest(NodeBench& bench) {
    for (double t = 0; t <= 10; t += 0.5) {
      bench.state(1, t, {0, 0, 50});
      bench.state(2, t, {3000, 0, 50});
    }
  }
};

TEST_F(ListeningNodeTest, AModemThatIsToldToReportsEventsAndReceivesForOthers) {
  NodeBench bench;
  two_at_rest(bench);
  for (double t = 0; t <= 10; t += 0.5) bench.state(3, t, {0, 3000, 50});
  modem_listen_t listen{};
  listen.events = listen.promiscuous = 1;
  bench.listen(2, 0, listen);
  bench.send(1, 1, 0, 20, 3);  // 0.2 s; 2 s away from both
  bench.run_to(10);
  std::vector<int> kinds;
  for (const auto& event : bench.events) {
    EXPECT_EQ(event.channel, "MODEM_EVENT.v2");
    kinds.push_back(event.message.modem_event);
  }
  EXPECT_THAT(kinds, ElementsAre(modem_event_t::PACKET_DETECTED, modem_event_t::CARRIER_BEGAN,
                                 modem_event_t::PACKET_ENDED, modem_event_t::CARRIER_ENDED));
  EXPECT_EQ(bench.events.at(0).message.utime, 3'000'000);
  EXPECT_EQ(bench.events.at(3).message.utime, 3'200'000);
  ASSERT_EQ(bench.receives.size(), 2u);
  EXPECT_EQ(bench.receives[0].message.destination_id, 3);
}

// A LISTEN wakes the server: the sound that is there is noticed at once.
TEST_F(ListeningNodeTest, CarrierThatIsThereIsReportedFromTheInstantOfTheCommandOn) {
  NodeBench bench;
  two_at_rest(bench);
  bench.send(1, 1, 0, 60);  // there from 3 to 3.6 s
  bench.run_to(3.3);
  modem_listen_t listen{};
  listen.events = 1;
  bench.listen(2, 3.4, listen);
  bench.run_to(3.5);
  ASSERT_EQ(bench.events.size(), 1u);
  EXPECT_EQ(bench.events[0].message.modem_event, modem_event_t::CARRIER_BEGAN);
  EXPECT_EQ(bench.events[0].message.utime, 3'400'000);
}

}  // namespace
}  // namespace halocline::channel_server
