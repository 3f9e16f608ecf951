// The lines of the EvoLogics protocol, one by one, in both directions.
#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "clients/modem_gateway/protocols/s2c/s2c_core.h"
#include "core/check.h"
#include "core/names.h"
#include "tests/clients/modem_gateway/fake_port.h"

namespace halocline::modem_gateway {
namespace {

using ::testing::HasSubstr;
using testing::kHardBytes;
using testing::ProtocolBench;
using ::testing::StartsWith;
using namespace std::string_literals;

struct S2cBench : ProtocolBench {
  explicit S2cBench(std::string_view options = "") : ProtocolBench("evologics", options) {}
  std::string say(const std::string& command) { return ask(command + "\n"); }
  // A plain message that arrives now.
  modem_receive_t message_from(std::int32_t source, std::int32_t destination, std::string_view data,
                               std::int32_t rate = kS2cImRate) const {
    modem_receive_t packet = packet_from(source, destination, data);
    packet.stamped = true;
    packet.rate_number = rate;
    packet.travel_time_s = 0.4;
    return packet;
  }
  modem_receive_t message_of_kind(S2cKind kind, std::string_view data, std::int32_t rate = kS2cImRate) const {
    const auto bytes = s2c_packet({kind, 0, as_bytes(data)});
    modem_receive_t packet = message_from(5, 1, as_text(bytes), rate);
    packet.stamped = false;
    return packet;
  }
};
const std::string kData(kHardBytes);
// 0.25 s, 120 dB, SINR 20 dB, Doppler factor 1.0004 at 1500 m/s.
constexpr auto kQuality = "250000,-70,160,0.6000,";

TEST(Evologics, StartsAsDuneStartsIt) {
  S2cBench bench;
  for (const auto* command :
       {"ATZ1", "ATZ3", "ATZ4", "AT@CTRL", "AT!AL7", "AT!L0", "AT!G0", "AT!RC3", "AT!RT500", "AT!RI1",
        "AT!ZI120", "AT!AM14", "AT@ZU1", "AT!RP1", "AT!C1", "AT@ZX1"})
    EXPECT_EQ(bench.say(command), "OK\r\n") << command;
  EXPECT_EQ(bench.say("AT?MODE"), "NET\r\n");
  EXPECT_EQ(bench.say("ATI0"), "1.9\r\n");
  EXPECT_EQ(bench.say("ATI1"), "phy: 03, mac: v1.2\r\n");
  EXPECT_EQ(bench.say("AT?CLOCK"), "100.000000\r\n");
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
  EXPECT_EQ(bench.say("hello"), "ERROR UNKNOWN COMMAND\r\n");
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
  EXPECT_EQ(bench.ask(std::string(9000, 'x') + "\nAT?L\n"), "ERROR UNKNOWN COMMAND\r\n0\r\n");
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
              HasSubstr("RECVEND,100050000,250000,-70,160\r\nDELIVEREDIM,2\r\n"));
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

TEST(Evologics, ReportsWhatArrivesByItsKind) {
  S2cBench bench;
  EXPECT_EQ(bench.receive(bench.message_from(5, 1, kData)),
            "RECVIM,6,5,1,noack,"s + kQuality + kData + "\r\n");
  modem_receive_t acknowledged = bench.message_from(5, 1, "hi");
  acknowledged.wants_ack = true;
  EXPECT_EQ(bench.receive(acknowledged), "RECVIM,2,5,1,ack,"s + kQuality + "hi\r\n");
  EXPECT_EQ(bench.receive(bench.message_from(5, kBroadcastId, "hi")),
            "RECVIM,2,5,255,noack,"s + kQuality + "hi\r\n");
  EXPECT_EQ(bench.receive(bench.message_of_kind(S2cKind::kForced, "hi")),
            "RECVIM,2,5,1,force,"s + kQuality + "hi\r\n");
  EXPECT_EQ(bench.receive(bench.message_of_kind(S2cKind::kSynchronous, "hi")),
            "RECVIMS,2,5,1,99750000,"s + kQuality + "hi\r\n");
  EXPECT_EQ(bench.receive(bench.message_of_kind(S2cKind::kPiggyBack, kData)),
            "RECVPBM,6,5,1,"s + kQuality + kData + "\r\n");
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
  packet.stamped = bench.port.sent[0].options.stamped;
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

TEST(Evologics, InDataModeCommandsAreEscapedAndAnswersWrapped) {
  S2cBench bench("mode=data");
  EXPECT_EQ(bench.ask_in_pieces("+++AT*SENDIM,6,2,noack," + kData + "\n"), "+++AT*SENDIM:2:OK\r\n");
  EXPECT_EQ(bench.port.sent.at(0).payload, kData);
  bench.accept(0.1);
  bench.wait(1);
  EXPECT_EQ(bench.say("+++AT!L1"), "+++AT!L:2:OK\r\n");
  EXPECT_EQ(bench.say("+++AT?L"), "+++AT?L:1:1\r\n");
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
  EXPECT_EQ(sent.payload.substr(1), "a\n+" + kData + "++" + "end+");
  modem_receive_t packet = bench.message_from(5, 1, sent.payload, kS2cBurstRate);
  packet.stamped = sent.options.stamped;
  EXPECT_EQ(bench.receive(packet), sent.payload.substr(1));
}

TEST(Evologics, ShowsThePathsFromWhomItHeardLast) {
  S2cBench bench;
  EXPECT_EQ(bench.say("AT?P"), "\r\n");
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
  EXPECT_EQ(bench.port.take(), "0 1000\n1200 100\n\r\n");
  bench.say("AT?P");
  EXPECT_EQ(bench.wait(1), "\r\n");  // the channel did not answer
}

TEST(Evologics, ListsItsSettingsAndItsStatusUpToAnEmptyLine) {
  S2cBench bench;
  for (const auto* command : {"AT&V", "AT?S"}) {
    const std::string lines = bench.say(command);
    EXPECT_THAT(lines, HasSubstr(": ")) << command;
    EXPECT_TRUE(lines.ends_with("\r\n\r\n")) << command;
  }
  EXPECT_EQ(bench.say("AT&W"), "OK\r\n");
  bench.say("AT!L3");
  EXPECT_EQ(bench.say("AT&F"), "OK\r\n");
  EXPECT_EQ(bench.say("AT?L"), "0\r\n");
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
