// SPDX-License-Identifier: BSD-3-Clause
// The sentences of the Micromodem that hosts write, one by one: commands, settings, data cycles.
#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "clients/modem_gateway/protocols/micromodem/nmea.h"
#include "clients/modem_gateway/protocols/protocol.h"
#include "core/names.h"
#include "core/sim_time.h"
#include "tests/clients/modem_gateway/micromodem_bench.h"

namespace halocline::modem_gateway {
namespace {

using testing::bodies;
using testing::field;
using testing::kFirstGeneration;
using testing::kHardBytes;
using Bench = testing::MicromodemBench;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

TEST(Nmea, HasTheChecksumsOfThePage) {
  EXPECT_EQ(nmea_line("CCCFQ,SRC"), "$CCCFQ,SRC*3A\r\n");
  EXPECT_EQ(nmea_line("CAMPR,2,1,0.4567"), "$CAMPR,2,1,0.4567*7C\r\n");
  EXPECT_EQ(nmea_line("CARDP,2,1,1,0,0,,1;3;0A0B0C"), "$CARDP,2,1,1,0,0,,1;3;0A0B0C*28\r\n");
}

TEST(Micromodem, TakesLinesWithAndWithoutChecksumAndWithAnyEnd) {
  Bench bench;
  for (const auto* line : {"$CCCFG,CST,1*37\r\n", "$CCCFG,CST,1*37\n", "$CCCFG,CST,1\r"})
    EXPECT_THAT(bodies(bench.ask(line)), ElementsAre("CACFG,CST,1")) << line;
  EXPECT_THAT(bodies(bench.ask_in_pieces("$CCCFG,A,1\r\n$CCCFG,B,2\r\n")),
              ElementsAre("CACFG,A,1", "CACFG,B,2"));
}

TEST(Micromodem, AnswersWhatIsWrongWithAnErrorWhoseSecondFieldIsNmea) {
  Bench bench;
  EXPECT_THAT(bodies(bench.ask("$CCCFG,CST,1*00\r\n")), ElementsAre("CAERR,000140,NMEA,1,bad checksum"));
  EXPECT_THAT(bench.say("CCXYZ,1"), ElementsAre("CAERR,000140,NMEA,2,unknown command"));
  EXPECT_THAT(bodies(bench.ask("rubbish\n")), ElementsAre(HasSubstr(",NMEA,2,")));
  for (const auto* wrong :
       {"CCCYC,0,1,2,9,0,1", "CCCYC,0,1,2,1,0,4", "CCCYC,0,1,2,1,0", "CCTXD,1,2,2,00", "CCMUC,1,2,3FFF",
        "CCMPC,1", "CCMPC,1,1", "CCCLK,2026,13,01,0,0,0", "CCTDP,2,1,0,0,0", "CCTFP,2,1,1,0,0,,",
        "CCTFP,2,1,9,0,0,,00", "CCCYC,0,2,40,1,0,1", "CCCFG,SRC,x", "CCCFG,"})
    EXPECT_THAT(bench.say(wrong), ElementsAre(HasSubstr(",NMEA,3,"))) << wrong;
  EXPECT_THAT(bodies(bench.ask(std::string(9000, 'x'))), ElementsAre(HasSubstr(",NMEA,")));
}

TEST(Micromodem, EchoesSettingsAsTheyWereSentAndReportsThem) {
  Bench bench;
  for (const auto* setting :
       {"CST,1", "REV,1", "RXP,1", "ALL,0", "XST,1", "psk.packet.mod_hdr_version,1", "NEW,7"})
    EXPECT_THAT(bench.say("CCCFG," + std::string(setting)), ElementsAre("CACFG," + std::string(setting)));
  EXPECT_THAT(bench.say("CCCFQ,NEW"), ElementsAre("CACFG,NEW,7"));
  EXPECT_THAT(bench.say("CCCFQ,SRC"), ElementsAre("CACFG,SRC,1"));
  EXPECT_GT(bench.say("CCCFQ,ALL").size(), 10u);
  EXPECT_GT(bench.say("CCCFQ,TOP").size(), 10u);
  EXPECT_THAT(bench.say("CCCFG,ALL,0"), ElementsAre("CACFG,ALL,0"));
  EXPECT_THAT(bench.say("CCCFQ,NEW"), ElementsAre("CACFG,NEW,0"));
}

TEST(Micromodem, TakesAnAddressThatHoldsForAllModemInterfaces) {
  Bench bench;
  EXPECT_THAT(bench.say("CCCFG,SRC,9"), ElementsAre("CACFG,SRC,9"));
  EXPECT_THAT(bench.say("CCCFQ,SRC"), ElementsAre("CACFG,SRC,9"));
  EXPECT_EQ(bench.addresses.vehicle_of(9), 1);
}

TEST(Micromodem, ReportsItsRevisionEveryFiveSecondsWhereTold) {
  Bench bench(kFirstGeneration);
  EXPECT_THAT(bench.after(11), IsEmpty());
  bench.say("CCCFG,REV,1");
  EXPECT_THAT(bench.after(10.5), ElementsAre("CAREV,000156,AUV,0.94.0.00", "CAREV,000201,AUV,0.94.0.00"));
}

TEST(Micromodem, RebootsAfterASleepOfNoMinutes) {
  Bench bench(kFirstGeneration);
  EXPECT_THAT(bench.say("CCMSC,1,1,0"), ElementsAre("CAMSC,1,1,0"));
  EXPECT_THAT(bench.after(0.4), ElementsAre("CAREV,000140,INIT,0.94.0.00", "CAREV,000140,AUV,0.94.0.00"));
}

TEST(Micromodem, SleepsForItsMinutesAndThenReboots) {
  Bench bench(kFirstGeneration);
  EXPECT_THAT(bench.say("CCMSC,1,1,2"), ElementsAre("CAMSC,1,1,2"));
  EXPECT_EQ(bench.port.sleeps_until, SimTime::from_seconds(220));
  EXPECT_THAT(bench.after(120), IsEmpty());
  EXPECT_THAT(bench.after(0.4), ElementsAre("CAREV,000340,INIT,0.94.0.00", "CAREV,000340,AUV,0.94.0.00"));
  bench.say("CCMSC,1,1,2");
  bench.say("CCMSC,1,1,0");  // woken
  EXPECT_EQ(bench.port.sleeps_until, bench.port.at);
  EXPECT_THAT(bench.after(0.4), ElementsAre(HasSubstr(",INIT,"), HasSubstr(",AUV,")));
}

TEST(Micromodem, SleepsForAsLongAsCanBeToldWhereNoTimeIsSet) {
  Bench bench;
  EXPECT_THAT(bench.say("CCMSC,1,1,-1,0"), ElementsAre("CAMSC,1,1,-1,0"));
  EXPECT_EQ(bench.port.sleeps_until, SimTime::from_seconds(100 + 8191 * 60.0));
}

TEST(Micromodem, AnotherIsToldToSleepByAMiniPacket) {
  Bench bench, other;
  EXPECT_THAT(bench.say("CCMSC,1,2,300"), ElementsAre("CAMSC,1,2,300"));
  ASSERT_EQ(bench.port.sent.size(), 1u);
  EXPECT_EQ(bench.port.sent[0].destination, 2);
  modem_receive_t packet = other.packet_from(2, 1, bench.port.sent[0].payload, modem_receive_t::MINI_PACKET);
  packet.header_number = bench.port.sent[0].options.header_number;
  EXPECT_THAT(other.hear(packet), ElementsAre(StartsWith("CACST,")));
  EXPECT_EQ(other.port.sleeps_until, SimTime::from_seconds(100 + 18'000));
}

TEST(Micromodem, ItsClockIsTheVehicles) {
  Bench bench("pps=yes");
  bench.port.clock_ahead = SimDuration::from_milliseconds(30);
  EXPECT_THAT(bench.say("CCTMQ,0"), ElementsAre("CATMQ,1970-01-01T00:01:40Z,NONE,EXT"));
  bench.port.at = SimTime::from_seconds(100.98);
  EXPECT_THAT(bench.say("CCTMQ,0"), ElementsAre("CATMQ,1970-01-01T00:01:41Z,NONE,EXT"));
  bench.say("CCCFG,SNV,1");
  bench.say("CCMUC,1,2,0001");
  EXPECT_EQ(bench.port.sent.at(0).start, SimTime::from_seconds(101.97)) << "a whole second of that clock";
  bench.accept(0.5);
  EXPECT_THAT(bench.after(2), ElementsAre("CATXP,2", "CATXF,2", StartsWith("CAXST,6,19700101,000142.0000,")));
}

TEST(Micromodem, ItsClockIsSetFromTheNextPulse) {
  Bench bench("pps=yes");
  bench.port.at = SimTime::from_seconds(100.07);
  // The host asks for the second that comes; a pulse later it holds. It compares the answer with its clock
  // when that has come.
  EXPECT_THAT(bench.say("CCCLK,2026,11,24,10,30,06"), ElementsAre("CACLK,2026,11,24,10,30,06"));
  EXPECT_THAT(bench.say("CCCLQ,0,0"), ElementsAre("CACLQ,2026,11,24,10,30,05"));
  bench.port.at = SimTime::from_seconds(101);
  EXPECT_THAT(bench.say("CCTMQ,0"), ElementsAre("CATMQ,2026-11-24T10:30:06Z,USER,EXT"));
  EXPECT_THAT(bench.say("CCTMS,2027-01-02T03:04:05Z,1"), ElementsAre("CATMS,0,2027-01-02T03:04:05Z"));
  EXPECT_THAT(bench.say("CCTMQ,0"), ElementsAre("CATMQ,2027-01-02T03:04:05Z,USER,EXT"));
}

TEST(Micromodem, ADataCycleOfTwoFramesWithAcknowledgement) {
  Bench bench("pps=yes");
  EXPECT_THAT(bench.say("CCCYC,0,1,2,1,1,2"), ElementsAre("CACYC,0,1,2,1,1,2", "CADRQ,000140,1,2,1,64,1"));
  EXPECT_THAT(bench.say("CCTXD,1,2,1,68656C6C6F"), ElementsAre("CATXD,1,2,1,5", "CADRQ,000140,1,2,1,64,2"));
  EXPECT_THAT(bench.say("CCTXD,1,2,1,000A0D2B2CFF"), ElementsAre("CATXD,1,2,1,6"));
  ASSERT_EQ(bench.port.sent.size(), 1u);
  const auto& sent = bench.port.sent[0];
  EXPECT_EQ(sent.destination, 2);
  EXPECT_EQ(sent.payload, "hello" + std::string(kHardBytes));
  EXPECT_EQ(sent.options.rate_number, 1);
  EXPECT_EQ(sent.options.frame_bytes, (std::vector<std::int32_t>{5, 6}));
  EXPECT_TRUE(sent.options.wants_ack);
  EXPECT_EQ(bench.accept(2), "");
  EXPECT_THAT(bench.after(0), ElementsAre("CATXP,11"));
  const auto end = bench.after(2.1);
  ASSERT_EQ(end.size(), 2u);
  EXPECT_EQ(end[0], "CATXF,11");
  EXPECT_EQ(end[1], "CAXST,6,19700101,000140.0000,2,0,200,5000,25000,1,1,2,1,2,2,3,11");
  const auto acks = bench.hear(bench.answer_from(2, modem_receive_t::ACK, 1.0, "\x03"));
  EXPECT_THAT(acks, ElementsAre("CAACK,2,1,1,1", "CAACK,2,1,2,1", StartsWith("CACST,6,0,")));
}

TEST(Micromodem, AnEmptyFrameEndsTheData) {
  Bench bench;
  bench.say("CCCYC,0,1,2,5,0,8");
  EXPECT_THAT(bench.say("CCTXD,1,2,0,61"),
              ElementsAre("CATXD,1,2,0,1", HasSubstr("CADRQ,000140,1,2,0,256,2")));
  EXPECT_THAT(bench.say("CCTXD,1,2,0,"), ElementsAre("CATXD,1,2,0,0"));
  EXPECT_EQ(bench.port.sent.at(0).options.frame_bytes, std::vector<std::int32_t>{1});
  bench.say("CCCYC,0,1,2,5,0,8");
  bench.say("CCTXD,1,2,0,");
  EXPECT_EQ(bench.port.sent.size(), 1u);  // nothing at all: nothing is sent
}

TEST(Micromodem, TextMayHoldCommas) {
  Bench bench;
  bench.say("CCCYC,0,1,2,1,0,1");
  EXPECT_THAT(bench.say("CCTXA,1,2,0,a,b"), ElementsAre("CATXA,1,2,0,3"));
  EXPECT_EQ(bench.port.sent.at(0).payload, "a,b");
}

TEST(Micromodem, RefusesFramesThatAreTooLarge) {
  Bench bench;
  bench.say("CCCYC,0,1,2,1,0,1");
  EXPECT_THAT(bench.say("CCTXD,1,2,0," + std::string(130, '6')), ElementsAre(HasSubstr(",NMEA,3,")));
  EXPECT_THAT(bench.say("CCTXD,1,2,0," + std::string(128, '6')), ElementsAre("CATXD,1,2,0,64"));
}

TEST(Micromodem, FramesThatCameBeforeTheirCycleAreNotAskedFor) {
  Bench bench;
  EXPECT_THAT(bench.say("CCTXD,1,2,0,6162"), ElementsAre("CATXD,1,2,0,2"));
  EXPECT_THAT(bench.say("CCTXD,1,2,1,000A0D2B2CFF"), ElementsAre("CATXD,1,2,1,6"));
  EXPECT_TRUE(bench.port.sent.empty());
  EXPECT_THAT(bench.say("CCCYC,0,1,2,1,0,3"), ElementsAre("CACYC,0,1,2,1,0,3", "CADRQ,000140,1,2,0,64,3"));
  bench.say("CCTXD,1,2,0,");
  ASSERT_EQ(bench.port.sent.size(), 1u);
  EXPECT_EQ(bench.port.sent[0].payload, "ab" + std::string(kHardBytes));
  EXPECT_EQ(bench.port.sent[0].options.frame_bytes, (std::vector<std::int32_t>{2, 6}));
  EXPECT_TRUE(bench.port.sent[0].options.wants_ack);
  // Too large for the rate: reported. Eight wait at most.
  for (int i = 0; i < 8; ++i)
    EXPECT_THAT(bench.say("CCTXD,1,2,0," + std::string(130, '6')), ElementsAre("CATXD,1,2,0,65"));
  EXPECT_THAT(bench.say("CCTXD,1,2,0,61"), ElementsAre(HasSubstr(",NMEA,3,")));
  const auto lines = bench.say("CCCYC,0,1,2,1,0,1");
  EXPECT_EQ(lines.front(), "CACYC,0,1,2,1,0,1");
  EXPECT_EQ(std::count(lines.begin(), lines.end(), "CAERR,000140,DATA,65,frame too large for the cycle"), 8);
  EXPECT_EQ(lines.back(), "CADRQ,000140,1,2,0,64,1");
}

TEST(Micromodem, ACyclePacketThatIsNotSentEndsItsCycle) {
  Bench bench;
  bench.say("CCCYC,0,1,2,0,0,1");
  bench.refuse(modem_receipt_t::REFUSED_BUSY);
  bench.after(0);
  EXPECT_THAT(bench.say("CCCYC,0,1,2,1,0,1"), ElementsAre("CACYC,0,1,2,1,0,1", HasSubstr("CADRQ")));
}

TEST(Micromodem, GivesUpACycleWhoseDataDoesNotCome) {
  Bench bench;
  bench.say("CCCYC,0,1,2,1,0,2");
  EXPECT_THAT(bench.say("CCCYC,0,1,2,1,0,2"), ElementsAre(HasSubstr(",NMEA,4,")));
  EXPECT_THAT(bench.after(5.1), ElementsAre("CAERR,000145,DATA_TIMEOUT,1"));
  EXPECT_THAT(bench.say("CCCYC,0,1,2,1,0,2"), ElementsAre("CACYC,0,1,2,1,0,2", HasSubstr("CADRQ")));
}

TEST(Micromodem, AtRateZeroACyclePacketGoesBeforeTheData) {
  Bench bench("revision=0.94.0.00 pps=yes");
  bench.say("CCCFG,XST,1");
  EXPECT_THAT(bench.say("CCCYC,0,1,2,0,0,1"), ElementsAre("CACYC,0,1,2,0,0,1"));
  ASSERT_EQ(bench.port.sent.size(), 1u);
  EXPECT_EQ(bench.port.sent[0].options.kind, modem_send_t::MINI_PACKET);
  EXPECT_NE(bench.port.sent[0].options.header_number, 0);
  bench.accept(0.7);
  EXPECT_THAT(bench.after(0.7),
              ElementsAre("CATXP,2", "CATXF,2", StartsWith("CAXST,19700101,000140.0000,2,0,"),
                          "CADRQ,000140,1,2,0,32,1"));
  EXPECT_THAT(bench.say("CCTXD,1,2,0," + std::string(66, '6')), ElementsAre(HasSubstr(",NMEA,3,")));
  bench.say("CCTXD,1,2,0,6869");
  ASSERT_EQ(bench.port.sent.size(), 2u);
  EXPECT_EQ(bench.port.sent[1].payload, "hi");
  EXPECT_EQ(bench.port.sent[1].start, SimTime::from_seconds(100.7));
  bench.accept(3.5);
  EXPECT_THAT(bench.after(5), ElementsAre("CATXP,2", "CATXF,2", StartsWith("CAXST,19700101,")));
}

TEST(Micromodem, ARefusedTransmissionIsReportedAsInhibited) {
  Bench bench;
  bench.say("CCMUC,1,2,0042");
  const auto lines = bodies(bench.refuse(modem_receipt_t::REFUSED_NO_MODEM));
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(field(lines[0], 5), "3");  // after the version: date, time, clock mode, transmit mode
  Bench first(kFirstGeneration);       // which reports no transmissions until it is told
  first.say("CCMUC,1,2,0042");
  EXPECT_THAT(bodies(first.refuse(modem_receipt_t::REFUSED_NO_MODEM)),
              ElementsAre("CAERR,000140,XMIT,3,not sent"));
}

TEST(Micromodem, RefusesWhatItCannotQueueAndTakesDataAllTheSame) {
  Bench bench;
  bench.port.unsent_packets = ProtocolPort::kMaxUnsent;
  for (const auto* command :
       {"CCMUC,1,2,0042", "CCMPC,1,2", "CCCMD,PNG,1,2,1,0,0", "CCTDP,2,1,0,0,61", "CCTFP,2,1,1,0,0,61,62",
        "CCCYC,0,1,2,1,0,1", "CCMEC,1,2,1,1,1", "CCMSC,1,2,5", "CCPDT,1,1,0,0,3000,1,0,0,0"})
    EXPECT_THAT(bench.say(command), ElementsAre(HasSubstr(",NMEA,4,"))) << command;
  EXPECT_THAT(bench.say("CCTXD,1,2,0,61"), ElementsAre("CATXD,1,2,0,1"));
  EXPECT_TRUE(bench.port.sent.empty());
}

TEST(Micromodem, HasNoPulseASecondUnlessItIsGivenOne) {
  Bench bench;
  EXPECT_THAT(bench.say("CCTMQ,0"), ElementsAre("CATMQ,1970-01-01T00:01:40Z,NONE,NONE"));
  bench.say("CCTMS,2027-01-02T03:04:05Z,1");
  EXPECT_THAT(bench.say("CCTMQ,0"), ElementsAre("CATMQ,2027-01-02T03:04:05Z,USER,NONE"));
  Bench first(kFirstGeneration);
  first.say("CCCLK,2027,1,2,3,4,5");
  const auto lines = first.hear(first.packet_from(2, 1, "hi"));
  EXPECT_EQ(field(lines.back(), 3), "1");  // clock mode: set, without PPS
}

}  // namespace
}  // namespace halocline::modem_gateway
