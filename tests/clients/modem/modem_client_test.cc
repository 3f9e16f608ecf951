// SPDX-License-Identifier: BSD-3-Clause
#include "clients/modem/modem_client.h"

#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/check.h"
#include "core/names.h"
#include "tests/clients/modem/fake_server.h"
#include "tests/support/archived_changes.h"
#include "tests/support/at_ms.h"

namespace halocline::clients {
namespace {

using halocline::testing::at_ms;
using ::testing::ElementsAre;

class ModemClientTest : public ::testing::Test {
 protected:
  void drain() {
    while (lcm_.handleTimeout(0) > 0) {
    }
    bus_.rethrow_if_failed();
  }
  std::int64_t send(std::int64_t ms, std::vector<std::uint8_t> payload = {1, 2, 3}) {
    return modem_.send(at_ms(ms), at_ms(ms), 7, payload);
  }
  void step(std::int64_t ms) {
    modem_.resend(at_ms(ms));
    drain();
  }

  lcm::LCM lcm_{"memq://"};
  testing::FakeServer server_{lcm_, "auv-1"};
  bus::Bus bus_{lcm_, {"node", 5}};
  ModemClient modem_{bus_,
                     {.vehicle = "auv-1", .vehicle_id = 3, .session = 42},
                     {.interval = SimDuration::from_milliseconds(200),
                      .expire_after = SimDuration::from_milliseconds(1000)}};
};

TEST_F(ModemClientTest, SendCarriesTheRequestedFields) {
  modem_.send(at_ms(1000), at_ms(2500), 7, std::vector<std::uint8_t>{9, 8});
  drain();
  ASSERT_EQ(server_.sends.size(), 1u);
  const modem_send_t& received = server_.sends[0];
  EXPECT_EQ(received.utime, 2'500'000);
  EXPECT_EQ(received.session, 42);
  EXPECT_EQ(received.packet_sequence, 0);
  EXPECT_EQ(received.source_id, 3);
  EXPECT_EQ(received.destination_id, 7);
  EXPECT_THAT(received.payload, ElementsAre(9, 8));
}

TEST_F(ModemClientTest, ListenCarriesWhatIsAskedForAndCountsOn) {
  std::vector<modem_listen_t> received;
  server_.bus().subscribe<modem_listen_t>(bus::channels::kListen.of("auv-1"),
                                          [&](const modem_listen_t& m) { received.push_back(m); });
  modem_.listen(at_ms(1000), {.promiscuous = true, .events = true, .carrier_threshold_db = 9});
  modem_.listen(at_ms(2000), {.asleep = true, .wakes = at_ms(5000)});
  drain();
  ASSERT_EQ(received.size(), 2u);
  EXPECT_EQ(received[0].utime, 1'000'000);
  EXPECT_EQ(received[0].session, 42);
  EXPECT_EQ(received[0].wake_utime, 0);
  EXPECT_TRUE(received[0].promiscuous && received[0].events && !received[0].asleep);
  EXPECT_EQ(received[0].carrier_threshold_db, 9);
  EXPECT_EQ(received[1].sequence, 1);
  EXPECT_TRUE(received[1].asleep && !received[1].events);
  EXPECT_EQ(received[1].wake_utime, 5'000'000);
  EXPECT_THROW(modem_.listen(at_ms(0), {.carrier_threshold_db = 101}), InvalidArgument);
}

TEST_F(ModemClientTest, EventsOfTheOwnModemAreHandedOn) {
  std::vector<std::int8_t> kinds;
  modem_.on_event([&](const modem_event_t& event) { kinds.push_back(event.modem_event); });
  modem_event_t event{};
  event.session = 99;
  event.modem_event = modem_event_t::CARRIER_BEGAN;
  server_.bus().publish(bus::channels::kModemEvent.of("auv-2"), event);
  event.modem_event = modem_event_t::PACKET_DETECTED;
  server_.bus().publish(bus::channels::kModemEvent.of("auv-1"), event);
  drain();
  EXPECT_THAT(kinds, ElementsAre(modem_event_t::PACKET_DETECTED));
}

TEST_F(ModemClientTest, APacketCarriesItsDepartureUnlessDisabled) {
  send(0);
  modem_.send(at_ms(0), at_ms(0), 7, {}, {.stamped = false});
  drain();
  EXPECT_EQ(server_.sends.at(0).stamped, 1);
  EXPECT_EQ(server_.sends.at(0).packet_kind, modem_send_t::DATA);
  EXPECT_EQ(server_.sends.at(1).stamped, 0);
}

TEST_F(ModemClientTest, APingReplyHoldsTheTwoWayTravelTime) {
  const std::int64_t ping = modem_.ping(at_ms(0), at_ms(0), 7);
  drain();
  EXPECT_EQ(server_.sends.at(0).packet_kind, modem_send_t::PING);
  EXPECT_FALSE(modem_.take_ping_reply(ping));
  server_.deliver(1, 9, 0);
  server_.reply_to_ping(server_.sends.at(0), 7, 1.5);
  drain();
  EXPECT_FALSE(modem_.take_ping_reply(ping + 1));
  EXPECT_EQ(modem_.take_ping_reply(ping), 1.5);
  EXPECT_FALSE(modem_.take_ping_reply(ping));
  EXPECT_TRUE(modem_.take_received());  // the other packet still waits
}

TEST_F(ModemClientTest, OptionsAreTheFieldsOfTheSend) {
  modem_.send(at_ms(0), at_ms(0), 7, std::vector<std::uint8_t>{1, 2, 3},
              {.wants_ack = true, .rate_number = 5, .source_level_db = 170.0, .frame_bytes = {1, 2}});
  modem_.send(at_ms(0), at_ms(0), 7, {}, {.kind = modem_send_t::MINI_PACKET, .header_number = 9});
  drain();
  const modem_send_t& with = server_.sends.at(0);
  EXPECT_EQ(with.wants_ack, 1);
  EXPECT_EQ(with.sets_rate, 1);
  EXPECT_EQ(with.rate_number, 5);
  EXPECT_EQ(with.sets_source_level, 1);
  EXPECT_EQ(with.source_level_db, 170);
  EXPECT_THAT(with.frame_bytes, ElementsAre(1, 2));
  const modem_send_t& without = server_.sends.at(1);
  EXPECT_EQ(without.packet_kind, modem_send_t::MINI_PACKET);
  EXPECT_EQ(without.wants_ack, 0);
  EXPECT_EQ(without.sets_rate, 0);
  EXPECT_EQ(without.sets_source_level, 0);
  EXPECT_EQ(without.num_frames, 0);
  EXPECT_THAT((std::vector{with.header_number, without.header_number}), ElementsAre(0, 9));
}

TEST_F(ModemClientTest, OptionsThatContradictEachOtherAreRefusedAndUseNoNumber) {
  const std::vector<std::uint8_t> payload{1, 2, 3};
  const auto send_with = [&](std::int32_t to, SendOptions options) {
    return modem_.send(at_ms(0), at_ms(0), to, payload, std::move(options));
  };
  EXPECT_THROW(send_with(kBroadcastId, {.wants_ack = true}), InvalidArgument);
  EXPECT_THROW(send_with(7, {.kind = modem_send_t::ACK}), InvalidArgument);
  EXPECT_THROW(send_with(7, {.rate_number = 256}), InvalidArgument);
  EXPECT_THROW(send_with(7, {.source_level_db = 300.0}), InvalidArgument);
  EXPECT_THROW(send_with(7, {.frame_bytes = {1, 1}}), InvalidArgument);
  EXPECT_EQ(send_with(7, {}), 0);
}

TEST_F(ModemClientTest, AnAcknowledgementSaysWhichFramesWereRight) {
  const std::int64_t packet =
      modem_.send(at_ms(0), at_ms(0), 7, std::vector<std::uint8_t>{1, 2, 3}, {.wants_ack = true});
  drain();
  EXPECT_FALSE(modem_.take_ack(packet));
  modem_receive_t ack{};
  ack.send_session = 42;
  ack.packet_sequence = packet;
  ack.source_id = 7;
  ack.destination_id = ack.receiver_id = 3;
  ack.packet_kind = modem_receive_t::ACK;
  ack.payload_size = 2;
  ack.payload = {0b101, 1};
  bus_.publish(bus::channels::kReceive.of("auv-1"), ack);
  drain();
  EXPECT_EQ(modem_.counters().acknowledged, 1);
  EXPECT_FALSE(modem_.take_ack(packet + 1));
  EXPECT_EQ(modem_.take_ack(packet), 0b1'0000'0101u);
  EXPECT_FALSE(modem_.take_ack(packet));
}

TEST(ModemPacket, IsWholeWhenEveryFrameWasRight) {
  modem_receive_t packet{};
  packet.num_frames = 3;
  packet.frames_good = 0b101;
  EXPECT_FALSE(is_whole(packet));
  packet.frames_good = 0b111;
  EXPECT_TRUE(is_whole(packet));
}

TEST_F(ModemClientTest, AQueuedPacketIsAccepted) {
  send(0);
  drain();
  server_.answer(server_.sends.at(0), modem_receipt_t::QUEUED);
  drain();
  EXPECT_EQ(modem_.counters().accepted, 1);
  EXPECT_EQ(modem_.counters().refused, 0);
}

TEST_F(ModemClientTest, PacketsAreNumberedInTurn) {
  EXPECT_EQ(send(0), 0);
  EXPECT_EQ(send(0), 1);
  EXPECT_EQ(send(0), 2);
}

TEST_F(ModemClientTest, EmptyPayloadIsAPacket) {
  send(0, {});
  drain();
  ASSERT_EQ(server_.sends.size(), 1u);
  EXPECT_EQ(server_.sends[0].payload_size, 0);
}

TEST_F(ModemClientTest, SendIsRepeatedUnchangedUntilItsReceiptComes) {
  send(0);
  drain();
  step(199);
  EXPECT_EQ(server_.sends.size(), 1u);
  step(200);
  step(400);
  ASSERT_EQ(server_.sends.size(), 3u);
  EXPECT_EQ(server_.sends[2].utime, server_.sends[0].utime);
  EXPECT_EQ(server_.sends[2].packet_sequence, server_.sends[0].packet_sequence);
  server_.accept(server_.sends[0]);
  drain();
  step(600);
  EXPECT_EQ(server_.sends.size(), 3u);
  EXPECT_EQ(modem_.counters().resent, 2);
}

TEST_F(ModemClientTest, NextResendIsWhenTheOldestIsDue) {
  EXPECT_EQ(modem_.next_resend(), SimTime::never());
  send(50);
  send(100);
  EXPECT_EQ(modem_.next_resend(), at_ms(250));
}

TEST_F(ModemClientTest, UnansweredPacketExpires) {
  const auto packet = send(0);
  step(999);
  EXPECT_TRUE(modem_.is_pending(packet));
  step(1000);
  EXPECT_FALSE(modem_.is_pending(packet));
  EXPECT_FALSE(modem_.receipt_of(packet));
  EXPECT_EQ(modem_.counters().unanswered, 1);
  EXPECT_EQ(modem_.next_resend(), SimTime::never());
}

TEST_F(ModemClientTest, HandlerIsCalledOnceForDuplicateReceipts) {
  int receipts = 0;
  modem_.on_receipt([&](const modem_receipt_t&) { ++receipts; });
  const auto packet = send(0);
  drain();
  server_.accept(server_.sends[0]);
  server_.accept(server_.sends[0]);
  drain();
  EXPECT_EQ(receipts, 1);
  ASSERT_TRUE(modem_.receipt_of(packet));
  EXPECT_EQ(modem_.receipt_of(packet)->receipt_result, modem_receipt_t::ACCEPTED);
  EXPECT_EQ(modem_.counters().accepted, 1);
}

TEST_F(ModemClientTest, RefusalIsAReceiptToo) {
  const auto packet = send(0);
  drain();
  server_.answer(server_.sends[0], modem_receipt_t::REFUSED_BUSY);
  drain();
  ASSERT_TRUE(modem_.receipt_of(packet));
  EXPECT_EQ(modem_.receipt_of(packet)->receipt_result, modem_receipt_t::REFUSED_BUSY);
  EXPECT_EQ(modem_.counters().refused, 1);
}

TEST_F(ModemClientTest, ReceiptOfAnotherSessionIsIgnored) {
  const auto packet = send(0);
  drain();
  modem_send_t recorded = server_.sends[0];
  recorded.session = 41;
  server_.accept(recorded);
  drain();
  EXPECT_TRUE(modem_.is_pending(packet));
}

TEST_F(ModemClientTest, ReceivedPacketsComeOutInOrder) {
  server_.deliver(8, 2, 0);
  server_.deliver(8, 2, 1);
  drain();
  EXPECT_EQ(modem_.take_received()->packet_sequence, 0);
  EXPECT_EQ(modem_.take_received()->packet_sequence, 1);
  EXPECT_FALSE(modem_.take_received());
}

TEST_F(ModemClientTest, DuplicateOfAPacketIsDropped) {
  server_.deliver(8, 2, 0);
  server_.deliver(8, 2, 0);
  drain();
  EXPECT_TRUE(modem_.take_received());
  EXPECT_FALSE(modem_.take_received());
  EXPECT_EQ(modem_.counters().duplicates, 1);
}

TEST_F(ModemClientTest, SameNumberFromAnotherSenderOrSessionIsAnotherPacket) {
  server_.deliver(8, 2, 0);
  server_.deliver(8, 3, 0);
  server_.deliver(9, 2, 0);
  drain();
  EXPECT_EQ(modem_.counters().received, 3);
}

TEST_F(ModemClientTest, ReceiveHandlerTakesPacketsInsteadOfTheQueue) {
  std::vector<std::int64_t> received;
  modem_.on_receive([&](const modem_receive_t& packet) { received.push_back(packet.packet_sequence); });
  server_.deliver(8, 2, 4);
  drain();
  EXPECT_THAT(received, ElementsAre(4));
  EXPECT_FALSE(modem_.take_received());
}

TEST_F(ModemClientTest, MemoryStaysBoundedWhenNoPacketsAreTaken) {
  const auto count = static_cast<std::int64_t>(ModemClient::kMaxWaiting) + 5;
  for (std::int64_t i = 0; i < count; ++i) {
    server_.deliver(8, 2, i);
    drain();
  }
  EXPECT_EQ(modem_.counters().discarded, 5);
  EXPECT_EQ(modem_.take_received()->packet_sequence, 5);
}

TEST_F(ModemClientTest, ImpossibleArgumentsAreRefused) {
  EXPECT_THROW(modem_.send(at_ms(0), at_ms(0), -1, {}), InvalidArgument);
  EXPECT_THROW(send(0, std::vector<std::uint8_t>(32769)), InvalidArgument);
  EXPECT_THROW(ModemClient(bus_, {.vehicle = "AUV 1", .vehicle_id = 1, .session = 1}), InvalidArgument);
  EXPECT_THROW(ModemClient(bus_, {.vehicle = "auv-1", .vehicle_id = 0, .session = 1}), InvalidArgument);
}

TEST_F(ModemClientTest, CountsWhatChangesItsArchive) {
  halocline::testing::ArchivedChanges changes(modem_);
  const auto after = [&](const auto& act) {
    act();
    drain();
    return changes.are_counted();
  };
  EXPECT_TRUE(after([&] { send(0); }));
  EXPECT_TRUE(after([&] { step(300); }));
  EXPECT_TRUE(after([&] { server_.accept(server_.sends[0]); }));
  EXPECT_TRUE(after([&] { send(400); }));
  EXPECT_TRUE(after([&] { step(2000); }));  // expired
  for (int i = 0; i < 2; ++i) EXPECT_TRUE(after([&] { server_.deliver(9, 5, 0); }));
  EXPECT_TRUE(after([&] { modem_.take_received(); }));
  const std::int64_t ping = modem_.ping(at_ms(3000), at_ms(3000), 7);
  drain();
  EXPECT_TRUE(changes.are_counted());
  EXPECT_TRUE(after([&] { server_.reply_to_ping(server_.sends.back(), 7, 1.5); }));
  EXPECT_TRUE(after([&] { EXPECT_TRUE(modem_.take_ping_reply(ping)); }));
  const auto before = modem_.changes();
  modem_.take_received();
  step(3001);
  EXPECT_EQ(modem_.changes(), before);
}

}  // namespace
}  // namespace halocline::clients
