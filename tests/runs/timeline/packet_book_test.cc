// SPDX-License-Identifier: BSD-3-Clause
#include "runs/timeline/packet_book.h"

#include <gtest/gtest.h>

#include "tests/runs/timeline/timeline_fixtures.h"

namespace halocline::clients {
namespace {

using testing::kSecond;
using testing::outcome;
using testing::receipt;
using testing::send;

TEST(PacketBook, ASendItsReceiptAndItsOutcomesAreOnePacket) {
  PacketBook book;
  book.add(send(1, 0, 10 * kSecond), 1);
  book.add(receipt(0, 12 * kSecond, modem_receipt_t::QUEUED), 1);
  EXPECT_TRUE(book.add(outcome(1, 3, 0, 12 * kSecond)));
  EXPECT_TRUE(book.add(outcome(1, 2, 0, 12 * kSecond)));
  ASSERT_EQ(book.all().size(), 1u);
  const PacketRecord& packet = book.all()[0];
  EXPECT_EQ(packet.sent, SimTime::from_seconds(10));
  EXPECT_EQ(packet.departure, SimTime::from_seconds(12));
  EXPECT_EQ(packet.receipt, modem_receipt_t::QUEUED);
  EXPECT_EQ(packet.payload_bytes, 3);
  EXPECT_EQ(packet.duration_s, 2);
  ASSERT_EQ(packet.outcomes.size(), 2u);
  EXPECT_EQ(packet.outcomes[0].receiver_id, 2);
  EXPECT_EQ(packet.end(), SimTime::from_seconds(15));
}

TEST(PacketBook, ItsPartsComeInAnyOrder) {
  PacketBook book;
  book.add(outcome(1, 2, 0, 12 * kSecond));
  book.add(receipt(0, 12 * kSecond), 1);
  book.add(send(1, 0, 12 * kSecond), 1);
  ASSERT_EQ(book.all().size(), 1u);
  EXPECT_TRUE(book.all()[0].sent && book.all()[0].receipt && book.all()[0].departure);
}

TEST(PacketBook, ARepetitionChangesNothing) {
  PacketBook book;
  for (int turn = 0; turn < 2; ++turn) {
    book.add(send(1, 0, 10 * kSecond), 1);
    book.add(receipt(0, 10 * kSecond), 1);
    EXPECT_EQ(book.add(outcome(1, 2, 0, 10 * kSecond)), turn == 0);
  }
  EXPECT_EQ(book.all().size(), 1u);
  EXPECT_EQ(book.outcome_count(), 1u);
  EXPECT_EQ(book.revision(), 3u);
}

TEST(PacketBook, ReceiversOutOfReachAreACountOfTheirPacket) {
  PacketBook book;
  packet_outcome_t others = outcome(1, 0, 0, 12 * kSecond, packet_outcome_t::OUT_OF_REACH);
  others.num_receivers = 97;
  EXPECT_TRUE(book.add(others));
  EXPECT_TRUE(book.add(outcome(1, 2, 0, 12 * kSecond)));
  EXPECT_FALSE(book.add(others));
  ASSERT_EQ(book.all().size(), 1u);
  EXPECT_EQ(book.all()[0].out_of_reach, 97);
  ASSERT_EQ(book.all()[0].outcomes.size(), 1u);
  EXPECT_EQ(book.all()[0].outcomes[0].receiver_id, 2);
}

TEST(PacketBook, ANameThatIsUsedAgainIsAnotherPacket) {
  PacketBook book;
  for (const std::int64_t second : {10, 90}) {
    book.add(send(1, 0, second * kSecond), 1);
    book.add(receipt(0, second * kSecond), 1);
  }
  book.add(outcome(1, 2, 0, 10 * kSecond));
  book.add(outcome(1, 2, 0, 90 * kSecond));
  ASSERT_EQ(book.all().size(), 2u);
  EXPECT_EQ(book.all()[0].outcomes.size(), 1u);
  EXPECT_EQ(book.all()[1].outcomes.size(), 1u);
}

TEST(PacketBook, TheAnswerToAPingIsAPacketOfItsOwn) {
  PacketBook book;
  modem_send_t ping = send(1, 4, 10 * kSecond, 2);
  ping.packet_kind = modem_send_t::PING;
  book.add(ping, 1);
  book.add(receipt(4, 10 * kSecond), 1);
  packet_outcome_t there = outcome(1, 2, 4, 10 * kSecond), back = outcome(2, 1, 4, 13 * kSecond);
  there.packet_kind = modem_receive_t::PING;
  there.destination_id = 2;
  back.packet_kind = modem_receive_t::PING_REPLY;
  book.add(there);
  book.add(back);
  ASSERT_EQ(book.all().size(), 2u);
  EXPECT_EQ(book.all()[0].outcomes.size(), 1u);
  EXPECT_EQ(book.all()[1].name.source_id, 2);
  EXPECT_FALSE(book.all()[1].sent);
}

TEST(PacketBook, AMiniPacketItsReceiptAndItsAcknowledgementAreTwoPackets) {
  PacketBook book;
  modem_send_t mini = send(1, 4, 10 * kSecond, 2);
  mini.packet_kind = modem_send_t::MINI_PACKET;
  book.add(mini, 1);
  book.add(receipt(4, 10 * kSecond), 1);
  packet_outcome_t back = outcome(2, 1, 4, 13 * kSecond);
  back.packet_kind = modem_receive_t::ACK;
  book.add(back);
  ASSERT_EQ(book.all().size(), 2u);
  EXPECT_EQ(book.all()[0].receipt, modem_receipt_t::ACCEPTED);
  EXPECT_EQ(book.all()[1].name.kind, modem_receive_t::ACK);
}

TEST(PacketBook, ARefusedPacketDepartsNever) {
  PacketBook book;
  book.add(send(1, 0, 10 * kSecond), 1);
  book.add(receipt(0, 10 * kSecond, modem_receipt_t::REFUSED_BUSY), 1);
  ASSERT_EQ(book.all().size(), 1u);
  EXPECT_TRUE(book.all()[0].is_refused());
  EXPECT_FALSE(book.all()[0].departure);
  EXPECT_EQ(book.all()[0].at(), SimTime::from_seconds(10));
}

TEST(PacketBook, AStretchOfTimeHoldsWhatIsOnItsWay) {
  PacketBook book;
  for (std::int64_t i = 0; i < 10; ++i) book.add(outcome(1, 2, i, i * 10 * kSecond));
  const auto found = book.between(SimTime::from_seconds(22.5), SimTime::from_seconds(40));
  ASSERT_EQ(found.size(), 3u);  // the third still arrives
  EXPECT_EQ(found[0]->name.sequence, 2);
  EXPECT_EQ(found[2]->name.sequence, 4);
}

TEST(PacketBook, DroppingKeepsTheNumbersOfWhatIsLeft) {
  PacketBook book;
  for (std::int64_t i = 0; i < 10; ++i) book.add(outcome(1, 2, i, i * 10 * kSecond));
  book.drop_before(SimTime::from_seconds(45));
  EXPECT_EQ(book.all().size(), 5u);
  EXPECT_EQ(book.find(4), nullptr);
  EXPECT_EQ(book.find(5)->name.sequence, 5);
  book.keep_outcomes(2);
  EXPECT_EQ(book.outcome_count(), 2u);
  EXPECT_EQ(book.find(9)->name.sequence, 9);
  EXPECT_FALSE(book.add(outcome(1, 2, 9, 90 * kSecond)));
}

}  // namespace
}  // namespace halocline::clients
