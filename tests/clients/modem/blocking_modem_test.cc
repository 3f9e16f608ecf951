// SPDX-License-Identifier: BSD-3-Clause
#include "clients/modem/blocking_modem.h"

#include <vector>

#include <gtest/gtest.h>

#include "core/names.h"
#include "tests/clients/modem/fake_server.h"

namespace halocline::clients {
namespace {

constexpr SimDuration kPlenty = SimDuration::from_milliseconds(5000);
constexpr SimDuration kShort = SimDuration::from_milliseconds(20);

class BlockingModemTest : public ::testing::Test {
 protected:
  // Twice: a conductor is accepted once two of its CLOCKs agree.
  void publish_clock(std::int64_t utime) {
    sim_clock_t clock{};
    clock.utime = utime;
    clock.session = 7;
    clock.clock_rate = 1;
    clock.clock_step_us = 100'000;
    peer_.publish(bus::channels::kClock, clock);
    ++clock.utime;
    peer_.publish(bus::channels::kClock, clock);
  }

  lcm::LCM lcm_{"memq://"};
  bus::Bus peer_{lcm_, {"peer", 1}};
  testing::FakeServer server_{lcm_, "auv-1"};
  BlockingModem modem_{lcm_,
                       {.vehicle = "auv-1", .vehicle_id = 1, .session = 42},
                       {.interval = SimDuration::from_milliseconds(10), .expire_after = kPlenty}};
  const std::vector<std::uint8_t> payload_{1, 2, 3};
};

TEST_F(BlockingModemTest, WaitReceiptReturnsTheAnswer) {
  server_.answers = true;
  const auto packet = modem_.send_at(SimTime::from_seconds(3), kBroadcastId, payload_);
  const auto receipt = modem_.wait_receipt(packet, kPlenty);
  ASSERT_TRUE(receipt);
  EXPECT_EQ(receipt->start_utime, 3'000'000);
}

TEST_F(BlockingModemTest, WaitReceiptRepeatsTheSendMeanwhile) {
  const auto packet = modem_.send_at(SimTime(), kBroadcastId, payload_);
  EXPECT_FALSE(modem_.wait_receipt(packet, SimDuration::from_milliseconds(200)));
  EXPECT_GT(server_.sends.size(), 1u);
  server_.answers = true;
  EXPECT_TRUE(modem_.wait_receipt(packet, kPlenty));
}

TEST_F(BlockingModemTest, WaitReceiveReturnsWhatArrivesAndNothingOtherwise) {
  EXPECT_FALSE(modem_.wait_receive(kShort));
  server_.deliver(8, 2, 5);
  const auto packet = modem_.wait_receive(kPlenty);
  ASSERT_TRUE(packet);
  EXPECT_EQ(packet->packet_sequence, 5);
}

TEST_F(BlockingModemTest, ListenTellsTheModemToReportFromNowOn) {
  std::vector<modem_listen_t> told;
  peer_.subscribe<modem_listen_t>(bus::channels::kListen.of("auv-1"),
                                  [&](const modem_listen_t& listen) { told.push_back(listen); });
  EXPECT_FALSE(modem_.listen({.events = true})) << "without a CLOCK";
  publish_clock(60'000'000);
  ASSERT_TRUE(modem_.listen({.events = true, .carrier_threshold_db = 10}));
  EXPECT_FALSE(modem_.wait_event(kShort));
  ASSERT_EQ(told.size(), 1u);
  EXPECT_GE(told[0].utime, 60'000'000);
  EXPECT_TRUE(told[0].events);
  EXPECT_EQ(told[0].carrier_threshold_db, 10);
}

TEST_F(BlockingModemTest, WaitEventReturnsEventsInTheirOrder) {
  modem_event_t event{};
  for (const auto kind : {modem_event_t::PACKET_DETECTED, modem_event_t::PACKET_ENDED}) {
    event.modem_event = kind;
    ++event.utime;
    server_.bus().publish(bus::channels::kModemEvent.of("auv-1"), event);
  }
  for (const auto kind : {modem_event_t::PACKET_DETECTED, modem_event_t::PACKET_ENDED}) {
    const auto found = modem_.wait_event(kPlenty);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->modem_event, kind);
  }
  EXPECT_FALSE(modem_.wait_event(kShort));
}

TEST_F(BlockingModemTest, SendWithoutATimeStartsAtTheConductorsTime) {
  publish_clock(60'000'000);
  ASSERT_TRUE(modem_.send(kBroadcastId, payload_));
  EXPECT_FALSE(modem_.wait_receive(kShort));
  ASSERT_FALSE(server_.sends.empty());
  // The clock runs at rate 1 from the CLOCK on; ten seconds are far more than the test takes.
  EXPECT_GE(server_.sends[0].utime, 60'000'000);
  EXPECT_LT(server_.sends[0].utime, 70'000'000);
}

TEST_F(BlockingModemTest, SendWithoutAConductorSendsNothing) {
  EXPECT_FALSE(modem_.send(kBroadcastId, payload_));
  EXPECT_EQ(modem_.client().counters().sent, 0);
}

}  // namespace
}  // namespace halocline::clients
