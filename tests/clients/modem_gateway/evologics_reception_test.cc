// SPDX-License-Identifier: BSD-3-Clause
// The lines of an EvoLogics modem about what it hears.
#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "clients/modem_gateway/protocols/s2c/s2c_core.h"
#include "core/names.h"
#include "tests/clients/modem_gateway/s2c_bench.h"

namespace halocline::modem_gateway {
namespace {

using testing::kHardBytes;
using testing::kQuality;
using testing::S2cBench;
using ::testing::StartsWith;
using namespace std::string_literals;

const std::string kHardData(kHardBytes);

TEST(Evologics, ReportsWhatArrivesByItsKind) {
  S2cBench bench;
  EXPECT_EQ(bench.receive(bench.message_from(5, 1, kHardData)),
            "RECVIM,6,5,1,noack,"s + kQuality + kHardData + "\r\n");
  modem_receive_t acknowledged = bench.message_from(5, 1, "hi");
  acknowledged.wants_ack = true;
  EXPECT_EQ(bench.receive(acknowledged), "RECVIM,2,5,1,ack,"s + kQuality + "hi\r\n");
  EXPECT_EQ(bench.receive(bench.message_from(5, kBroadcastId, "hi")),
            "RECVIM,2,5,255,noack,"s + kQuality + "hi\r\n");
  EXPECT_EQ(bench.receive(bench.message_of_kind(S2cKind::kForced, "hi")),
            "RECVIM,2,5,1,force,"s + kQuality + "hi\r\n");
  EXPECT_EQ(bench.receive(bench.message_of_kind(S2cKind::kSynchronous, "hi")),
            "RECVIMS,2,5,1,99750000,"s + kQuality + "hi\r\n");
  EXPECT_EQ(bench.receive(bench.message_of_kind(S2cKind::kPiggyBack, kHardData)),
            "RECVPBM,6,5,1,"s + kQuality + kHardData + "\r\n");
  // 16 bits in 0.25 s; 0.4 s of propagation.
  EXPECT_EQ(bench.receive(bench.message_from(5, 1, "hi", kS2cBurstRate)),
            "RECV,2,5,1,64,-70,160,400000,0.6000,hi\r\n");
}

TEST(Evologics, ReportsMessagesForOthersOnlyWherePromiscuous) {
  S2cBench bench;
  EXPECT_EQ(bench.receive(bench.message_from(5, 9, "hi")), "");
  bench.say("AT!RP1");
  EXPECT_THAT(bench.receive(bench.message_from(5, 9, "hi")), StartsWith("RECVIM,2,5,9,"));
}

TEST(Evologics, ShowsProtocolIdsInExtendedNetworking) {
  S2cBench bench;
  bench.say("AT@ZF1");
  EXPECT_EQ(bench.say("AT*SENDIM,p3,2,2,noack,hi"), "OK\r\n");
  modem_receive_t packet = bench.message_from(5, 1, bench.port.sent.at(0).payload);
  packet.header_number = bench.port.sent[0].options.header_number;
  EXPECT_THAT(bench.receive(packet), StartsWith("RECVIM,p3,2,5,1,noack,"));
}

TEST(Evologics, ExtendedNotificationsShowDetectionsAndLosses) {
  S2cBench bench;
  packet_outcome_t loss{};
  loss.received_level_db = 110;
  loss.sinr_db = -5;
  loss.strongest_path_doppler_factor = 0.999;
  modem_event_t detected{};
  detected.modem_event = modem_event_t::PACKET_DETECTED;
  bench.protocol->on_event(detected);
  EXPECT_EQ(bench.lose(loss), "");
  bench.say("AT@ZX1");
  bench.protocol->on_event(detected);
  EXPECT_EQ(bench.port.take(), "RECVSTART\r\n");
  EXPECT_EQ(bench.lose(loss), "RECVFAILED,-1.5000,-80,85\r\n");
}

TEST(Evologics, PositionsOfAcknowledgedMessagesHaveARange) {
  S2cBench bench;
  bench.say("AT@ZU1");
  vehicle_sensors_t attitude{};
  attitude.heading_rad = std::acos(0.0);  // east
  bench.port.measured = attitude;
  modem_receive_t packet = bench.message_from(5, 1, "hi");
  packet.wants_ack = true;
  packet.packet_sequence = 3;
  bench.receive(packet);
  vehicle_usbl_t bearing{};
  bearing.utime = 99'750'000;
  bearing.send_session = packet.send_session;
  bearing.packet_sequence = 3;
  bearing.packet_kind = packet.packet_kind;
  bearing.angle_deviation_rad = 0.01;
  bench.protocol->on_bearing(bearing);
  // Straight ahead at 0.4 s * 1500 m/s: forward is east.
  EXPECT_EQ(bench.port.take(),
            "USBLLONG,100.000000,99.750000,5,0.0000,600.0000,0.0000,600.0000,0.0000,-0.0000,0.0000,0.0000,1."
            "5708,400000,"
            "-70,160,6.0000\r\n");
  EXPECT_THAT(bench.say("AT?UP"), StartsWith("99.750000,5,600.0000,"));
  packet.wants_ack = false;
  packet.packet_sequence = bearing.packet_sequence = 4;
  bench.receive(packet);
  bench.protocol->on_bearing(bearing);
  EXPECT_THAT(bench.port.take(), StartsWith("USBLANGLES,100.000000,99.750000,5,0.0000,0.0000,1.5708,"));
}

// At least eight lines: DUNE reads 16 numbers up to the carriage return.
TEST(Evologics, ShowsThePathsFromWhomItHeardLast) {
  S2cBench bench;
  const auto zeros = [](int lines) {
    std::string text;
    for (int i = 0; i < lines; ++i) text += "0 0\n";
    return text + "\r\n";
  };
  EXPECT_EQ(bench.say("AT?P"), zeros(8));
  bench.receive(bench.message_from(5, 1, "hi"));
  EXPECT_EQ(bench.say("AT?P"), "");
  EXPECT_EQ(bench.port.paths_asked.back(), 5);
  link_reply_t reply{};
  reply.link_paths.paths.resize(2);
  reply.link_paths.paths[0].path_delay_s = 0.4;
  reply.link_paths.paths[0].path_level_db = 100;
  reply.link_paths.paths[1].path_delay_s = 0.4012;
  reply.link_paths.paths[1].path_level_db = 80;
  bench.protocol->on_paths(reply);
  EXPECT_EQ(bench.port.take(), "0 1000\n1200 100\n" + zeros(6));
  bench.say("AT?P");
  EXPECT_EQ(bench.wait(1), zeros(8));  // the channel did not answer
  bench.say("AT?P");
  reply.link_paths.paths.resize(9);
  bench.protocol->on_paths(reply);
  EXPECT_THAT(bench.port.take(), ::testing::EndsWith("0\n\r\n"));
}

}  // namespace
}  // namespace halocline::modem_gateway
