// SPDX-License-Identifier: BSD-3-Clause
// The sentences of the Micromodem about what was received, and the commands of single packets.
#include <cstdint>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "clients/modem_gateway/protocols/fields.h"
#include "core/check.h"
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

// A packet of three frames at rate 1, the second wrong.
modem_receive_t three_frames(const Bench& bench) {
  modem_receive_t packet = bench.packet_from(2, 1, std::string(kHardBytes) + "bad" + "good");
  packet.rate_number = 1;
  packet.num_frames = 3;
  packet.frame_bytes = {6, 3, 4};
  packet.frames_good = 5;
  return packet;
}

TEST(Micromodem, ReportsAPacketFrameByFrameAndItsStatisticsLast) {
  Bench bench("pps=yes");
  const auto lines = bench.hear(three_frames(bench));
  ASSERT_EQ(lines.size(), 5u);
  EXPECT_EQ(lines[0], "CACYC,0,2,1,1,0,3");
  EXPECT_EQ(lines[1], "CARXD,2,1,0,1,000A0D2B2CFF");
  EXPECT_EQ(lines[2], "CAMSG,BAD_CRC,2");
  EXPECT_EQ(lines[3], "CARXD,2,1,0,3,676F6F64");
  // Arrived at 99.75 s with 120 dB, 30 dB above the noise, SINR 20 dB, Doppler 0.0004: peak 32767 10^((120 -
  // 180) / 20) = 33.
  EXPECT_EQ(lines[4],
            "CACST,6,1,19700101000139.750000,12,33,30,30,120,250,0,0,0,0,1,2,1,3,3,3,1,30,30,25,20,-20.0,252,"
            "0.60,90,"
            "25000,5000");
}

TEST(Micromodem, TheFirstGenerationHasTheOlderStatistics) {
  Bench bench(kFirstGeneration + std::string(" pps=yes"));
  const auto lines = bench.hear(three_frames(bench));
  EXPECT_THAT(lines.back(), StartsWith("CACST,1,000139.7500,2,33,30,30,120,250,"));
  EXPECT_EQ(fields_of(lines.back(), ',').size(), 30u);  // the id and 29 fields
}

TEST(Micromodem, TellsOfADetectedPacketAtOnceHowItIsModulated) {
  Bench bench;
  EXPECT_THAT(bench.detect(0), ElementsAre("CARXP,0"));
  EXPECT_THAT(bench.detect(4), ElementsAre("CARXP,1"));
}

TEST(Micromodem, LeavesOutWhatItsSettingsTurnOff) {
  Bench bench;
  bench.say("CCCFG,CST,0");
  bench.say("CCCFG,RXP,0");
  EXPECT_THAT(bench.detect(1), IsEmpty());
  EXPECT_THAT(bench.hear(three_frames(bench)).size(), 4u);
}

packet_outcome_t loss_of(std::int8_t outcome) {
  packet_outcome_t loss{};
  loss.source_id = 2;
  loss.destination_id = loss.receiver_id = 1;
  loss.outcome = outcome;
  loss.rate_number = 1;
  loss.num_frames = 2;
  loss.departure_utime = 99'000'000;
  loss.travel_time_s = 0.5;
  loss.strongest_path_doppler_factor = 1;
  return loss;
}

TEST(Micromodem, ReportsLostPacketsAsWell) {
  Bench bench;
  EXPECT_THAT(
      bodies(bench.lose(loss_of(packet_outcome_t::BIT_ERRORS))),
      ElementsAre("CAMSG,BAD_CRC,1", "CAMSG,BAD_CRC,2", StartsWith("CACST,6,1,19700101000139.500000,")));
  EXPECT_THAT(bodies(bench.lose(loss_of(packet_outcome_t::HALF_DUPLEX))),
              ElementsAre("CAMSG,PACKET_TIMEOUT,2", StartsWith("CACST,6,2,")));
}

TEST(Micromodem, MiniPacketsHaveThirteenBits) {
  Bench bench;
  EXPECT_THAT(bench.say("CCMUC,1,2,1FFF"), ElementsAre("CAMUC,1,2,1FFF"));
  EXPECT_EQ(bench.port.sent.at(0).payload, "\x1f\xff");
  EXPECT_EQ(bench.port.sent.at(0).options.kind, modem_send_t::MINI_PACKET);
  modem_receive_t mini = bench.packet_from(2, 1, std::string("\x00\x2b", 2), modem_receive_t::MINI_PACKET);
  const auto lines = bench.hear(mini);
  EXPECT_THAT(lines, ElementsAre("CAMUA,2,1,002B", StartsWith("CACST,6,0,")));
  EXPECT_EQ(field(lines[1], 18), "2");  // packet type: mini-packet of frequency-shift keying
}

TEST(Micromodem, PingsReportTheOneWayTime) {
  Bench bench;
  EXPECT_THAT(bench.say("CCMPC,1,2"), ElementsAre("CAMPC,1,2"));
  EXPECT_EQ(bench.port.sent.at(0).options.kind, modem_send_t::PING);
  EXPECT_THAT(bench.hear(bench.answer_from(2, modem_receive_t::PING_REPLY, 0.9134)),
              ElementsAre("CAMPR,2,1,0.4567", StartsWith("CACST,")));
  EXPECT_THAT(bench.hear(bench.packet_from(2, 1, "", modem_receive_t::PING)),
              ElementsAre("CAMPA,2,1", StartsWith("CACST,")));
}

TEST(Micromodem, TheSecondGenerationHasAnotherPing) {
  Bench bench;
  EXPECT_THAT(bench.say("CCCMD,PNG,1,2,1,0,0"), ElementsAre("CACMD,PNG,1,2,1,0,0"));
  EXPECT_THAT(
      bench.hear(bench.answer_from(2, modem_receive_t::PING_REPLY, 0.9134)),
      ElementsAre("CACMR,PNR,1970-01-01T00:01:39.750000,2,1,0.456700,30.0,25.00,0,0,", StartsWith("CACST,")));
  modem_receive_t ping = bench.packet_from(2, 1, "", modem_receive_t::PING);
  ping.header_number = bench.port.sent.at(0).options.header_number;
  EXPECT_THAT(bench.hear(ping),
              ElementsAre("CACMA,1970-01-01T00:01:39.750000,PNG,2,1,30.0,25.00,0,0,0", StartsWith("CACST,")));
  // Its data is left out.
  EXPECT_THAT(bench.say("CCCMD,PNG,1,2,1,0,0A0B0C"), ElementsAre("CACMD,PNG,1,2,1,0,3"));
  // Firmware from 3 on says first what it is.
  Bench newest("revision=3.0.0");
  EXPECT_THAT(newest.hear(ping)[0], "CACMA,PNG,1970-01-01T00:01:39.750000,2,1,30.0,25.00,0,0,0");
}

TEST(Micromodem, FlexiblePacketsAreSentAndReportedAsTriplets) {
  Bench bench;
  EXPECT_THAT(bench.say("CCTDP,2,1,0,0,000A0D2B2CFF"), ElementsAre("CATDP,0,2,1,0,0,6"));
  EXPECT_EQ(bench.port.sent.at(0).payload, kHardBytes);
  modem_receive_t packet = bench.packet_from(2, 1, "\x0a\x0b\x0c");
  packet.rate_number = 1;
  packet.header_number = bench.port.sent.at(0).options.header_number;
  EXPECT_THAT(bench.hear(packet), ElementsAre("CARDP,2,1,1,0,0,,1;3;0A0B0C", StartsWith("CACST,")));
  packet.num_frames = 2;
  packet.frame_bytes = {2, 1};
  packet.frames_good = 2;
  EXPECT_THAT(bench.hear(packet)[0], "CARDP,2,1,1,0,0,,0;2;0A0B;1;1;0C");
  Bench newer("newer_lines=yes");
  EXPECT_THAT(newer.hear(packet)[0], "CARFP,1970-01-01T00:01:39.750000,0,2,1,1,1,0,0,,,0;2;0A0B;1;1;0C");
  bench.say("CCCFG,recv.base64data,1");
  EXPECT_THAT(bench.hear(packet)[0], "CARDP,2,1,1,0,0,,0;2;Cgs=;1;1;DA==");
  // A word may take the place of 0.
  EXPECT_THAT(bench.say("CCTDP,2,1,0,False,0A"), ElementsAre("CATDP,0,2,1,0,False,1"));
}

TEST(Micromodem, FramedPacketsHaveAMiniFrameAndData) {
  Bench bench;
  EXPECT_THAT(bench.say("CCTFP,2,1,5,1,0,0102,000A0D2B2CFF"), ElementsAre("CATFP,0,2,1,5,1,0,2,6"));
  ASSERT_EQ(bench.port.sent.size(), 1u);
  const auto sent = bench.port.sent[0];
  EXPECT_EQ(sent.payload, "\x01\x02" + std::string(kHardBytes));
  EXPECT_EQ(sent.options.rate_number, 5);
  EXPECT_EQ(sent.options.frame_bytes, (std::vector<std::int32_t>{2, 6}));
  EXPECT_TRUE(sent.options.wants_ack);
  modem_receive_t packet = bench.packet_from(2, 1, sent.payload);
  packet.rate_number = 5;
  packet.num_frames = 2;
  packet.frame_bytes = {2, 6};
  packet.frames_good = 2;
  packet.wants_ack = true;
  packet.header_number = sent.options.header_number;
  EXPECT_THAT(bench.hear(packet),
              ElementsAre("CARFP,1970-01-01T00:01:39.750000,0,2,1,5,5,1,0,,0;2;0102,1;6;000A0D2B2CFF",
                          StartsWith("CACST,6,1,")));
  EXPECT_THAT(
      bench.hear(bench.answer_from(2, modem_receive_t::ACK, 1.0, "\x02")),
      ElementsAre("CACDR,1970-01-01T00:01:39.750000,0,2,1,0,0,1,0,0,0,0,0,0", StartsWith("CACST,6,0,")));
  // Newer firmware has two fields before; without data the rate is the mini-frame's.
  EXPECT_THAT(bench.say("CCTFP,0,0,2,1,5,0,0,0102,"), ElementsAre("CATFP,0,2,1,5,0,0,2,0"));
  packet.rate_number = bench.port.sent[1].options.rate_number.value_or(-1);
  packet.payload = {1, 2};
  packet.num_frames = 1;
  packet.frame_bytes = {2};
  packet.frames_good = 1;
  packet.wants_ack = false;
  EXPECT_THAT(bench.hear(packet)[0], "CARFP,1970-01-01T00:01:39.750000,0,2,1,1,-1,0,0,,1;2;0102,");
}

TEST(Micromodem, FirmwareFrom3OnHasLongerStatistics) {
  Bench newest("revision=3.0.0 pps=yes"), older("revision=2.0.20000 pps=yes");
  const auto lines = newest.hear(three_frames(newest));
  EXPECT_THAT(lines.back(), StartsWith("CACST,8,1,19700101000139.750000,12,"));
  EXPECT_THAT(lines.back(), ::testing::EndsWith(",25000,5000,0,-1,-1,00"));
  newest.say("CCMUC,1,2,0001");
  newest.accept(0.5);
  EXPECT_EQ(newest.after(1).back(),
            "CAXST,7,19700101,000140.000000,2,0,200,4000,25000,0,1,2,0,1,1,2,2,25000");
  EXPECT_THAT(older.hear(three_frames(older)).back(), StartsWith("CACST,6,1,19700101000139.750000,2,"));
}

TEST(Micromodem, AnotherIsAskedForDataByACyclePacketAndAsksItsHost) {
  Bench asker;
  EXPECT_THAT(asker.say("CCCYC,0,2,3,1,1,3"), ElementsAre("CACYC,0,2,3,1,1,3"));
  ASSERT_EQ(asker.port.sent.size(), 1u);
  EXPECT_EQ(asker.port.sent[0].destination, 2);
  Bench sender;
  sender.say("CCCFG,SRC,2");
  modem_receive_t request =
      sender.packet_from(5, 1, asker.port.sent[0].payload, modem_receive_t::MINI_PACKET);
  request.header_number = asker.port.sent[0].options.header_number;
  EXPECT_THAT(sender.hear(request),
              ElementsAre("CACYC,0,2,3,1,1,3", StartsWith("CACST,"), "CADRQ,000140,2,3,1,64,1"));
  // For the asker itself at any address.
  asker.say("CCCFG,SRC,100");
  asker.say("CCCYC,0,2,100,0,0,1");
  sender.say("CCTXD,2,3,0,");
  sender.addresses.assign(5, 100);
  request.payload.assign(asker.port.sent[1].payload.begin(), asker.port.sent[1].payload.end());
  EXPECT_THAT(sender.hear(request),
              ElementsAre("CACYC,0,2,100,0,0,1", StartsWith("CACST,"), "CADRQ,000140,2,100,0,32,1"));
}

TEST(Micromodem, ATransmissionStartsOnAWholeSecondWhereSynchronised) {
  Bench bench("pps=yes");
  bench.port.at = SimTime::from_seconds(100.3);
  bench.say("CCCFG,SNV,1");
  bench.say("CCCLK,2026,11,24,10,30,06");
  bench.say("CCMUC,1,2,0001");
  EXPECT_EQ(bench.port.sent.at(0).start, SimTime::from_seconds(101));
  // So the fraction of a second of an arrival is its travel time, in clock mode PPS and set.
  modem_receive_t mini = bench.packet_from(2, 1, std::string("\x00\x01", 2), modem_receive_t::MINI_PACKET);
  mini.arrival_utime = 102'345'678;
  const auto lines = bench.hear(mini);
  EXPECT_EQ(field(lines.back(), 3), "20261124103007.345678");
  EXPECT_EQ(field(lines.back(), 4), "14");  // set by a user 2, pulse from outside 3 << 2
}

TEST(Micromodem, RangesToTranspondersByOnePingToAll) {
  Bench bench("lbl=11/12");
  EXPECT_THAT(bench.say("CCPDT,1,1,0,0,1500,1,1,1,0"), ElementsAre("SNPDT,1,1,0,0,1500,1,1,1,0"));
  ASSERT_EQ(bench.port.sent.size(), 1u);
  EXPECT_EQ(bench.port.sent[0].destination, kBroadcastId);
  EXPECT_EQ(bench.port.sent[0].options.kind, modem_send_t::PING);
  bench.accept(0.3);
  EXPECT_THAT(bench.hear(bench.answer_from(11, modem_receive_t::PING_REPLY, 0.5)), IsEmpty());
  EXPECT_THAT(bench.say("CCPDT,1,1,0,0,1500,1,1,1,0"), ElementsAre(HasSubstr(",NMEA,4,")));
  EXPECT_THAT(bench.after(2.1), IsEmpty());  // 0.3 + 0.3 + 0.1 + 1.5 s
  EXPECT_THAT(bench.after(0.2), ElementsAre("SNTTA,0.2500,,,,000142.20"));
  // An answer that comes later counts no more, and is no ping's of CCMPC.
  EXPECT_THAT(bench.hear(bench.answer_from(12, modem_receive_t::PING_REPLY, 0.9)), IsEmpty());
  EXPECT_THAT(bench.say("CCPNT,9000,5,5,1500,0,12000,0,0,1"),
              ElementsAre("SNPNT,9000,5,5,1500,0,12000,0,0,1"));
  // Of others, whom the host did not name, nothing is said.
  EXPECT_THAT(bench.hear(bench.answer_from(11, modem_receive_t::PING_REPLY, 0.2)), IsEmpty());
  EXPECT_THAT(bench.hear(bench.answer_from(12, modem_receive_t::PING_REPLY, 0.25)),
              ElementsAre(StartsWith("SNTTA,,0.1250,,,")));
}

TEST(Micromodem, TranspondersMayBeNamedByTheFrequencyOrCodeOfTheirAnswer) {
  Bench bench("lbl=11:25000/12:3F0A");
  bench.say("CCPNT,26000,5,5,1500,25000,24000,0,0,1");
  EXPECT_THAT(bench.hear(bench.answer_from(11, modem_receive_t::PING_REPLY, 0.25)),
              ElementsAre(StartsWith("SNTTA,0.1250,,,,")));
  EXPECT_THAT(bench.say("CCPGT,9000,28,00FF,1500,10000,3F0A,25000,0000,0,0,0"),
              ElementsAre(HasSubstr("SNPGT,")));
  EXPECT_THAT(bench.hear(bench.answer_from(12, modem_receive_t::PING_REPLY, 0.5)), IsEmpty());
  EXPECT_THAT(bench.hear(bench.answer_from(11, modem_receive_t::PING_REPLY, 0.25)),
              ElementsAre(StartsWith("SNTTA,0.2500,0.1250,,,")));
}

TEST(Micromodem, GenericRangingHasItsOwnSentence) {
  Bench bench("lbl=11");
  EXPECT_THAT(bench.say("CCPGT,9000,7,1,1500,10000,1,0,0,0,2000,0"),
              ElementsAre("SNPGT,9000,7,1,1500,10000,1,0,0,0,2000,0"));
  EXPECT_THAT(bench.hear(bench.answer_from(11, modem_receive_t::PING_REPLY, 0.25)),
              ElementsAre(StartsWith("SNTTA,0.1250,,,,")));
}

TEST(Micromodem, RangingToNobodyEndsWithItsTimeOut) {
  Bench bench;
  bench.say("CCPDT,1,1,0,0,1500,1,1,1,1");
  EXPECT_THAT(bench.after(1.4), IsEmpty());
  EXPECT_THAT(bench.after(0.2), ElementsAre("SNTTA,,,,,000141.50"));
}

TEST(Micromodem, SetsALineOfAnotherModemAndTellsWhenItIsSet) {
  Bench asker, other;
  EXPECT_THAT(asker.say("CCMEC,1,2,3,2,17"), ElementsAre("CAMEC,1,2,3,2,17"));
  ASSERT_EQ(asker.port.sent.size(), 1u);
  EXPECT_EQ(asker.port.sent[0].destination, 2);
  const auto arrives_at = [](Bench& bench, const testing::FakePort::Sent& sent) {
    modem_receive_t packet = bench.packet_from(2, 1, sent.payload, modem_receive_t::MINI_PACKET);
    packet.header_number = sent.options.header_number;
    return bench.hear(packet);
  };
  EXPECT_THAT(arrives_at(other, asker.port.sent[0]), ElementsAre(StartsWith("CACST,")));
  ASSERT_EQ(other.port.sent.size(), 1u);
  EXPECT_EQ(other.port.sent[0].destination, 2);
  EXPECT_THAT(arrives_at(asker, other.port.sent[0]), ElementsAre("CAMER,2,1,3,2,17", StartsWith("CACST,")));
  EXPECT_EQ(asker.port.sent.size(), 1u);
  EXPECT_THAT(asker.say("CCMEC,1,1,3,2,17"), ElementsAre("CAMEC,1,1,3,2,17", "CAMER,1,1,3,2,17"));
  EXPECT_THAT(asker.say("CCMEC,1,2,16,0,0"), ElementsAre(HasSubstr(",NMEA,3,")));
}

TEST(Micromodem, RefusesSoundsThatAreNoPackets) {
  Bench bench;
  for (const auto* sound : {"CCSWP,1,2", "CCMSQ,1", "CCRSP,0,1,0"})
    EXPECT_THAT(bench.say(sound), ElementsAre(HasSubstr(",NMEA,2,no sound of "))) << sound;
}

TEST(Micromodem, MeasuresTheNoise) {
  Bench bench;
  EXPECT_THAT(bench.say("CCCFR,500"), ElementsAre("CACFR,500"));
  const auto noise = bench.after(0.6);
  ASSERT_EQ(noise.size(), 1u);
  EXPECT_EQ(fields_of(noise[0], ',').size(), 15u);
}

TEST(Micromodem, PacketsForAllGoToAddressesZeroAndFifteen) {
  Bench bench;
  bench.say("CCMUC,1,0,0001");
  bench.say("CCMUC,1,15,0001");
  EXPECT_EQ(bench.port.sent.at(0).destination, kBroadcastId);
  EXPECT_EQ(bench.port.sent.at(1).destination, kBroadcastId);
  bench.addresses.assign(7, 15);
  bench.say("CCMUC,1,15,0001");
  EXPECT_EQ(bench.port.sent.at(2).destination, 7);
}

TEST(Micromodem, RefusesOptionsThatItLacks) {
  for (const auto* wrong :
       {"revision=two", "revision=1.2", "lbl=1/2/3/4/5", "lbl=x", "colour=red", "pps=perhaps"})
    EXPECT_THROW(Bench{wrong}, InvalidArgument) << wrong;
}

}  // namespace
}  // namespace halocline::modem_gateway
