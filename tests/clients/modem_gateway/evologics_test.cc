// SPDX-License-Identifier: BSD-3-Clause
// The lines of the EvoLogics protocol, one by one, in both directions: settings, and what is sent.
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "clients/modem_gateway/protocols/s2c/s2c_core.h"
#include "core/check.h"
#include "core/names.h"
#include "core/sim_time.h"
#include "tests/clients/modem_gateway/s2c_bench.h"

namespace halocline::modem_gateway {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::kHardBytes;
using testing::kQuality;
using ::testing::Not;
using testing::ProtocolBench;
using testing::S2cBench;
using ::testing::StartsWith;
using namespace std::string_literals;

const std::string kData(kHardBytes);

TEST(Evologics, StartsAsDuneStartsIt) {
  S2cBench bench;
  for (const auto* command :
       {"ATZ1", "ATZ3", "ATZ4", "AT@CTRL", "AT!AL7", "AT!L0", "AT!G0", "AT!RC3", "AT!RT500", "AT!RI1",
        "AT!ZI120", "AT!AM14", "AT@ZU1", "AT!RP1", "AT!C1", "AT@ZX1"})
    EXPECT_EQ(bench.say(command), "OK\r\n") << command;
  EXPECT_EQ(bench.say("AT?MODE"), "NET\r\n");
  EXPECT_EQ(bench.say("ATI0"), "1.9\r\n");
  EXPECT_EQ(bench.say("ATI1"), "phy: 03, mac: v1.2\r\n");
  EXPECT_EQ(bench.say("AT?CLOCK"), "100\r\n");
  EXPECT_EQ(bench.say("AT?AL"), "7\r\n");
  EXPECT_EQ(bench.addresses.vehicle_of(7), ProtocolBench::kVehicle);
}

TEST(Evologics, TakesCommandsInAnyPiecesAndWithAnyEnd) {
  S2cBench bench;
  EXPECT_EQ(bench.ask("AT?L\rAT?L\r\n\nAT?L\n"), "0\r\n0\r\n0\r\n");
  EXPECT_EQ(bench.ask_in_pieces("AT*SENDIM,6,2,noack," + kData + "\r\nAT?L\n"), "OK\r\n0\r\n");
  EXPECT_EQ(bench.port.sent.at(0).payload, kData);
}

TEST(Evologics, RefusesInTheModemsWords) {
  S2cBench bench;
  EXPECT_EQ(bench.say("hello"), "ERROR WRONG FORMAT\r\n");
  EXPECT_EQ(bench.say("AT!XY1"), "ERROR UNKNOWN COMMAND\r\n");
  EXPECT_EQ(bench.say("AT?XY"), "ERROR UNKNOWN COMMAND\r\n");
  EXPECT_EQ(bench.say("AT!L9"), "ERROR OUT OF RANGE\r\n");
  EXPECT_EQ(bench.say("AT!Lx"), "ERROR WRONG FORMAT\r\n");
  EXPECT_EQ(bench.say("AT!AL300"), "ERROR OUT OF RANGE\r\n");
  EXPECT_EQ(bench.say("AT*SENDIM,3,2,noack,abcd"), "ERROR WRONG FORMAT\r\n");
  EXPECT_EQ(bench.say("AT*SENDIM,3,2,maybe,abc"), "ERROR WRONG FORMAT\r\n");
  EXPECT_EQ(bench.say("AT*SENDIM"), "ERROR WRONG FORMAT\r\n");
  EXPECT_EQ(bench.say("AT*SENDIM,65,2,noack," + std::string(65, 'x')), "ERROR WRONG FORMAT\r\n");
  EXPECT_EQ(bench.say("AT*SENDIM,3,1,noack,abc"), "ERROR WRONG DESTINATION ADDRESS\r\n");  // its own
  EXPECT_EQ(bench.say("AT*SENDIM,p9,3,2,noack,abc"), "ERROR PROTOCOL ID\r\n");
  EXPECT_EQ(bench.ask(std::string(9000, 'x') + "\nAT?L\n"), "ERROR WRONG FORMAT\r\n0\r\n");
  EXPECT_TRUE(bench.port.sent.empty());
}

TEST(Evologics, AnInstantMessageWithAcknowledgementIsDelivered) {
  S2cBench bench;
  bench.say("AT@ZX1");
  EXPECT_EQ(bench.say("AT*SENDIM,6,2,ack," + kData), "OK\r\n");
  ASSERT_EQ(bench.port.sent.size(), 1u);
  EXPECT_EQ(bench.port.sent[0].payload, kData);
  EXPECT_EQ(bench.port.sent[0].options.rate_number, kS2cImRate);
  EXPECT_TRUE(bench.port.sent[0].options.wants_ack);
  EXPECT_EQ(bench.accept(0.213), "SENDSTART,2,im,213000,0\r\n");
  EXPECT_EQ(bench.say("AT*SENDIM,1,3,noack,x"), "BUSY DELIVERING MESSAGE\r\n");
  EXPECT_EQ(bench.wait(0.3), "SENDEND,2,im,100000000,213000\r\n");
  EXPECT_THAT(bench.receive(bench.answer_from(2, modem_receive_t::ACK, 1.6, "\x01")),
              HasSubstr("RECVEND,100050000,250000,-70,160\r\nRECVSRV,2,1,ack,100300000,100000000,-70,160\r\n"
                        "DELIVEREDIM,2\r\n"));
  EXPECT_EQ(bench.say("AT?T"), "800000\r\n");
  EXPECT_EQ(bench.say("AT*SENDIM,1,3,noack,x"), "OK\r\n");
}

TEST(Evologics, AnInstantMessageWithoutAnswerIsRepeatedAndThenFails) {
  S2cBench bench;
  bench.say("AT!RI2");
  bench.say("AT*SENDIM,3,2,ack,abc");
  for (std::size_t tries = 1; tries <= 3; ++tries) {
    EXPECT_EQ(bench.port.sent.size(), tries);
    bench.accept(0.2);
    EXPECT_EQ(bench.wait(4.1), "");
    EXPECT_EQ(bench.wait(0.2), tries < 3 ? "" : "FAILEDIM,2\r\n");
  }
  EXPECT_EQ(bench.port.sent.size(), 3u);
}

TEST(Evologics, AMessageWithoutAcknowledgementEndsWithItsSound) {
  S2cBench bench;
  bench.say("AT*SENDIM,3,255,noack,abc");
  EXPECT_EQ(bench.port.sent.at(0).destination, kBroadcastId);
  bench.accept(0.2);
  EXPECT_EQ(bench.wait(0.3), "");
  EXPECT_EQ(bench.say("AT*SENDIM,3,255,noack,abc"), "OK\r\n");
}

TEST(Evologics, TheAddressBeyondTheHighestIsThatOfAll) {
  S2cBench bench;
  bench.say("AT!AM14");
  EXPECT_EQ(bench.say("AT*SENDIM,3,16,noack,abc"), "ERROR WRONG DESTINATION ADDRESS\r\n");
  for (const auto* all : {"15", "255"}) {
    EXPECT_EQ(bench.say("AT*SENDIM,3," + std::string(all) + ",noack,abc"), "OK\r\n");
    EXPECT_EQ(bench.port.sent.back().destination, kBroadcastId);
    bench.accept(0.2);
    bench.wait(0.3);
  }
  EXPECT_THAT(bench.receive(bench.message_from(5, kBroadcastId, "hi")), StartsWith("RECVIM,2,5,15,noack,"));
}

TEST(Evologics, AReceptionCancelsAMessageUnlessItIsForced) {
  S2cBench bench;
  modem_event_t detected{};
  detected.modem_event = modem_event_t::PACKET_DETECTED;
  bench.protocol->on_event(detected);
  EXPECT_EQ(bench.say("AT*SENDIM,3,2,noack,abc"), "OK\r\n");
  EXPECT_EQ(bench.wait(0), "CANCELEDIM,2\r\n");
  EXPECT_TRUE(bench.port.sent.empty());
  EXPECT_EQ(bench.say("AT*SENDIM,3,2,force,abc"), "OK\r\n");
  EXPECT_EQ(bench.port.sent.size(), 1u);
  EXPECT_EQ(bench.refuse(modem_receipt_t::REFUSED_BUSY), "CANCELEDIM,2\r\n");
}

TEST(Evologics, ASynchronousMessageStartsAtTheModemsTime) {
  S2cBench bench;
  EXPECT_EQ(bench.say("AT*SENDIMS,3,2,103000000,abc"), "OK\r\n");
  EXPECT_EQ(bench.port.sent.at(0).start, SimTime::from_seconds(103));
  bench.accept(0.2);
  bench.wait(4);
  EXPECT_EQ(bench.say("AT*SENDIMS,3,2,90000000,abc"), "OK\r\n");
  EXPECT_EQ(bench.wait(0), "EXPIREDIMS,2\r\n");
  EXPECT_EQ(bench.say("AT*SENDIMS,3,2,900000000,abc"), "ERROR OUT OF RANGE\r\n");
  EXPECT_EQ(bench.say("AT*SENDIMS,3,2,,abc"), "OK\r\n");
  EXPECT_EQ(bench.port.sent.back().start, bench.port.at);
}

TEST(Evologics, APiggyBackMessageFollowsTheNextAcknowledgement) {
  S2cBench bench;
  EXPECT_EQ(bench.say("AT*SENDPBM,3,5,abc"), "OK\r\n");
  EXPECT_EQ(bench.say("AT*SENDPBM,3,5,abc"), "BUSY DELIVERING MESSAGE\r\n");
  EXPECT_TRUE(bench.port.sent.empty());
  modem_receive_t packet = bench.message_from(5, 1, "hi");
  packet.wants_ack = true;
  bench.receive(packet);
  ASSERT_EQ(bench.port.sent.size(), 1u);
  EXPECT_EQ(bench.port.sent[0].destination, 5);
  EXPECT_EQ(bench.port.sent[0].start, SimTime::from_seconds(100.3));
}

TEST(Evologics, BurstsAreQueuedRepeatedAndReported) {
  S2cBench bench;
  EXPECT_EQ(bench.say("AT*SEND,6,2," + kData), "OK\r\n");
  EXPECT_EQ(bench.say("AT*SEND,2,2,hi"), "OK\r\n");
  bench.wait(0);
  ASSERT_EQ(bench.port.sent.size(), 1u);
  EXPECT_EQ(bench.port.sent[0].options.rate_number, kS2cBurstRate);
  bench.accept(0.2);
  bench.wait(0.3);
  EXPECT_EQ(bench.receive(bench.answer_from(2, modem_receive_t::ACK, 1.0, "\x01")), "DELIVERED,1,2\r\n");
  bench.wait(0);
  for (int tries = 0; tries < 4; ++tries) {
    ASSERT_EQ(bench.port.sent.size(), 2u + static_cast<std::size_t>(tries));
    bench.accept(0.2);
    EXPECT_EQ(bench.wait(4.3), tries < 3 ? "" : "FAILED,2,2\r\n");
  }
  for (int i = 0; i < 17; ++i) bench.say("AT*SEND,2,2,hi");
  EXPECT_EQ(bench.say("AT*SEND,2,2,hi"), "ERROR BUFFER FULL\r\n");
}

TEST(Evologics, InDataModeCommandsAreEscapedAndAnswersWrapped) {
  S2cBench bench("mode=data");
  EXPECT_EQ(bench.ask_in_pieces("+++AT*SENDIM,6,2,noack," + kData + "\n"), "+++AT*SENDIM:2:OK\r\n");
  EXPECT_EQ(bench.port.sent.at(0).payload, kData);
  bench.accept(0.1);
  bench.wait(1);
  EXPECT_EQ(bench.say("+++AT!L1"), "+++AT!L:2:OK\r\n");
  EXPECT_EQ(bench.say("+++AT?L"), "+++AT?L:1:1\r\n");
  EXPECT_EQ(bench.say("+++AT?MODE"), "+++AT?MODE:2:AT\r\n");
  EXPECT_EQ(bench.receive(bench.message_from(5, 1, "hello")),
            "+++AT:" + std::to_string(("RECVIM,5,5,1,noack,"s + kQuality).size() + 5) +
                ":RECVIM,5,5,1,noack," + kQuality + "hello\r\n");
  EXPECT_EQ(bench.say("+++ATC"), "+++ATC:2:OK\r\n");
  EXPECT_EQ(bench.say("AT?L"), "1\r\n");
  EXPECT_EQ(bench.say("ATO"), "OK\r\n");
  EXPECT_EQ(bench.say("+++AT?L"), "+++AT?L:1:1\r\n");
}

TEST(Evologics, InDataModeOtherBytesGoToTheRemoteAddressAsBursts) {
  S2cBench bench("mode=data");
  EXPECT_EQ(bench.ask("lost"), "+++AT:9:DROPCNT,4\r\n");
  bench.say("+++AT!AR2");
  bench.ask("a\n+" + kData + "++");
  EXPECT_EQ(bench.say("+++AT?AR"), "+++AT?AR:1:2\r\n");
  bench.ask("end+");
  bench.wait(0.1);
  ASSERT_EQ(bench.port.sent.size(), 1u);
  const auto& sent = bench.port.sent[0];
  EXPECT_EQ(sent.destination, 2);
  EXPECT_EQ(sent.payload, "a\n+" + kData + "++" + "end+");
  modem_receive_t packet = bench.message_from(5, 1, sent.payload, kS2cBurstRate);
  packet.header_number = sent.options.header_number;
  EXPECT_EQ(bench.receive(packet), sent.payload);
}

TEST(Evologics, MessagesOfEveryKindHold64Bytes) {
  S2cBench bench;
  const std::string data(64, 'x');
  EXPECT_EQ(bench.say("AT*SENDIM,p7,64,2,force," + data), "OK\r\n");
  EXPECT_EQ(bench.port.sent.at(0).payload, data);
  EXPECT_EQ(bench.say("AT*SENDIM,p7,65,2,force,x" + data), "ERROR WRONG FORMAT\r\n");
}

TEST(Evologics, ItsClockIsTheVehicles) {
  S2cBench bench;
  bench.port.clock_ahead = SimDuration::from_milliseconds(1250);
  EXPECT_EQ(bench.say("AT?CLOCK"), "101\r\n");
  bench.say("AT@ZX1");
  EXPECT_EQ(bench.say("AT*SENDIMS,3,2,103000000,abc"), "OK\r\n");
  EXPECT_EQ(bench.port.sent.at(0).start, SimTime::from_seconds(101.75));
  bench.accept(0.2);
  EXPECT_EQ(bench.wait(3), "SENDEND,2,ims,103000000,200000\r\n");
}

TEST(Evologics, ListsItsSettingsAndItsStatusUpToAnEmptyLine) {
  S2cBench bench;
  for (const auto* command : {"AT&V", "AT?S"}) {
    const std::string lines = bench.say(command);
    EXPECT_THAT(lines, HasSubstr(": ")) << command;
    EXPECT_TRUE(lines.ends_with("\r\n\r\n")) << command;
  }
  bench.say("AT!L3");
  bench.say("AT!AL9");
  EXPECT_THAT(bench.say("AT&V"), AllOf(HasSubstr("[*]!L: 3\r\n"), HasSubstr("[*]Local Address: 9\r\n")));
  EXPECT_EQ(bench.say("AT&W"), "OK\r\n");
  EXPECT_THAT(bench.say("AT&V"), Not(HasSubstr("[*]")));
  bench.say("AT!L2");
  EXPECT_EQ(bench.say("ATZ0"), "OK\r\n");
  EXPECT_EQ(bench.say("AT?L"), "3\r\n") << "as stored";
  EXPECT_EQ(bench.say("AT&F"), "OK\r\n");
  EXPECT_EQ(bench.say("AT?L"), "0\r\n");
  EXPECT_EQ(bench.say("AT?AL"), "1\r\n");
  EXPECT_EQ(bench.say("ATN"), "INITIATION NOISE\r\n");
  EXPECT_EQ(bench.say("ATA"), "INITIATION LISTEN\r\n");
  EXPECT_EQ(bench.say("ATD"), "INITIATION DEAF\r\n");
}

TEST(Evologics, ItsVoltageFallsWithTheBattery) {
  S2cBench bench;
  vehicle_battery_t battery{};
  battery.capacity_j = 100;
  battery.energy_left_j = 50;
  bench.port.charge = battery;
  EXPECT_EQ(bench.say("AT?BV"), "22.0\r\n");
  bench.port.charge->battery_empty = true;
  EXPECT_EQ(bench.say("AT?BV"), "0.0\r\n");
}

TEST(Evologics, RefusesOptionsThatItLacks) {
  EXPECT_THROW(S2cBench("mode=serial"), InvalidArgument);
  EXPECT_THROW(S2cBench("colour=red"), InvalidArgument);
}

}  // namespace
}  // namespace halocline::modem_gateway
