// SPDX-License-Identifier: BSD-3-Clause
// The lines of the Nanomodem's protocol, one by one, in both directions.
#include <string>

#include <gtest/gtest.h>

#include "core/names.h"
#include "tests/clients/modem_gateway/fake_port.h"

namespace halocline::modem_gateway {
namespace {

using testing::kHardBytes;
using testing::ProtocolBench;
using namespace std::string_literals;

TEST(Nm3, AnswersItsStatusWithAddressAndSupply) {
  ProtocolBench bench("nm3");
  EXPECT_EQ(bench.ask("$?"), "#A001V52429\r\n");  // 12 V of 15 V in 65536 steps
}

TEST(Nm3, TakesAnotherAddressWhichHoldsForAllModemInterfaces) {
  ProtocolBench bench("nm3");
  EXPECT_EQ(bench.ask("$A007"), "#A007\r\n");
  EXPECT_EQ(bench.ask("$?"), "#A007V52429\r\n");
  EXPECT_EQ(bench.addresses.vehicle_of(7), ProtocolBench::kVehicle);
}

TEST(Nm3, PingsAndReportsTheOneWayTimeInUnitsOf31Microseconds) {
  ProtocolBench bench("nm3");
  EXPECT_EQ(bench.ask("$P008"), "$P008\r\n");
  ASSERT_EQ(bench.port.sent.size(), 1u);
  EXPECT_EQ(bench.port.sent[0].destination, 8);
  EXPECT_EQ(bench.port.sent[0].options.kind, modem_send_t::PING);
  // 0.5 s one way / 31.25 us = 16000.
  EXPECT_EQ(bench.receive(bench.answer_from(8, modem_receive_t::PING_REPLY, 1.0)), "#R008T16000\r\n");
  EXPECT_EQ(bench.wait(10), "");
}

TEST(Nm3, ReportsATimeOutAfterFourSeconds) {
  ProtocolBench bench("nm3");
  bench.ask("$P008");
  EXPECT_EQ(bench.wait(3.99), "");
  EXPECT_EQ(bench.wait(0.02), "#TO\r\n");
  EXPECT_EQ(bench.ask("$P009"), "$P009\r\n");  // and is ready again
}

TEST(Nm3, RefusesASecondPingWhileOneWaits) {
  ProtocolBench bench("nm3");
  bench.ask("$P008");
  EXPECT_EQ(bench.ask("$P009"), "E\r\n");
  EXPECT_EQ(bench.port.sent.size(), 1u);
}

TEST(Nm3, BroadcastsAnyBytes) {
  ProtocolBench bench("nm3");
  EXPECT_EQ(bench.ask("$B06"s + std::string(kHardBytes)), "$B06\r\n");
  ASSERT_EQ(bench.port.sent.size(), 1u);
  EXPECT_EQ(bench.port.sent[0].destination, kBroadcastId);
  EXPECT_EQ(bench.port.sent[0].payload, kHardBytes);
}

TEST(Nm3, SendsToOne) {
  ProtocolBench bench("nm3");
  EXPECT_EQ(bench.ask("$U00805hello"), "$U00805\r\n");
  EXPECT_EQ(bench.port.sent.at(0).destination, 8);
  EXPECT_EQ(bench.port.sent.at(0).payload, "hello");
  EXPECT_FALSE(bench.port.sent.at(0).options.wants_ack);
}

TEST(Nm3, SendsWithAcknowledgementAndReportsItsTime) {
  ProtocolBench bench("nm3");
  EXPECT_EQ(bench.ask("$M00805hello"), "$M00805\r\n");
  EXPECT_TRUE(bench.port.sent.at(0).options.wants_ack);
  EXPECT_EQ(bench.receive(bench.answer_from(8, modem_receive_t::ACK, 0.25, "\x01")), "#R008T04000\r\n");
  bench.ask("$M00805hello");
  EXPECT_EQ(bench.wait(4.1), "#TO\r\n");
}

TEST(Nm3, StartsATimedSendingAtTheCounter) {
  ProtocolBench bench("nm3");
  EXPECT_EQ(bench.ask("$B02abT00002568000000\r\n"), "$B02\r\n");  // 107 s at 24 MHz
  EXPECT_EQ(bench.port.sent.at(0).start, SimTime::from_seconds(107));
  EXPECT_EQ(bench.ask("$B02abT00009999999999\r\n"), "E\r\n");  // too far ahead
}

TEST(Nm3, ReportsBroadcastsWithTheirSourceAndOthersWithout) {
  ProtocolBench bench("nm3");
  EXPECT_EQ(bench.receive(bench.packet_from(7, kBroadcastId, kHardBytes)),
            "#B00706"s + std::string(kHardBytes) + "\r\n");
  EXPECT_EQ(bench.receive(bench.packet_from(7, 1, "hello")), "#U05hello\r\n");
  EXPECT_EQ(bench.receive(bench.packet_from(7, 9, "hello")), "");  // for another
}

TEST(Nm3, StampsWhatItReceivesWhereTold) {
  ProtocolBench bench("nm3", "timestamps=yes");
  // Arrived at 99.75 s: 24 MHz * 99.75 s.
  EXPECT_EQ(bench.receive(bench.packet_from(7, 1, "hello")), "#U05helloT2394000000\r\n");
}

TEST(Nm3, TakesBytesInAnyPieces) {
  ProtocolBench bench("nm3");
  EXPECT_EQ(bench.ask_in_pieces("$U00806"s + std::string(kHardBytes) + "$P008\r\n$?"),
            "$U00806\r\n$P008\r\n#A001V52429\r\n");
  EXPECT_EQ(bench.port.sent.at(0).payload, kHardBytes);
}

TEST(Nm3, AnswersEToWhatIsWrong) {
  for (const std::string_view wrong : {"$X", "hello\n", "$P2x6\n", "$P256\n", "$B01a", "$B65"}) {
    ProtocolBench bench("nm3");
    EXPECT_EQ(bench.ask(wrong), "E\r\n") << wrong;
    EXPECT_EQ(bench.ask("\n$P008"), "$P008\r\n") << wrong;
  }
}

TEST(Nm3, KeepsTheBytesOfHostsApart) {
  ProtocolBench bench("nm3");
  bench.protocol->on_bytes(1, "$U008");
  bench.protocol->on_bytes(2, "$P008");
  bench.protocol->on_bytes(1, "02ab");
  EXPECT_EQ(bench.port.written_to, (std::vector<ClientId>{2, 1}));
  EXPECT_EQ(bench.port.take(), "$P008\r\nE\r\n");  // while it awaits the answer
  bench.protocol->on_bytes(3, "$B64half");
  bench.protocol->on_closed(3);
  EXPECT_EQ(bench.port.sent.size(), 1u);
}

TEST(Nm3, RefusesToSendWhileItSendsOrAwaitsAnAnswer) {
  ProtocolBench bench("nm3");
  bench.port.unsent_packets = 1;
  for (const auto* command : {"$P008", "$B02ab", "$U00802ab", "$M00802ab"})
    EXPECT_EQ(bench.ask(command), "E\r\n") << command;
  EXPECT_EQ(bench.ask("$?"), "#A001V52429\r\n");
  bench.port.unsent_packets = 0;
  bench.ask("$M00802ab");
  bench.accept();
  EXPECT_EQ(bench.ask("$B02ab"), "E\r\n");
  bench.wait(4.1);
  EXPECT_EQ(bench.ask("$B02ab"), "$B02\r\n");
  EXPECT_EQ(bench.port.sent.size(), 2u);
}

TEST(Nm3, TellsWhatWasConfirmedAndCouldNotBeSent) {
  ProtocolBench bench("nm3");
  bench.ask("$B02ab");
  EXPECT_EQ(bench.refuse(modem_receipt_t::REFUSED_NO_MODEM), "E\r\n");
  bench.ask("$P008");
  EXPECT_EQ(bench.refuse(modem_receipt_t::REFUSED_NO_MODEM), "#TO\r\n");
}

}  // namespace
}  // namespace halocline::modem_gateway
