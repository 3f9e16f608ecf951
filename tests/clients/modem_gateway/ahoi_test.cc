// SPDX-License-Identifier: BSD-3-Clause
// The frames of the ahoi modem, one by one, in both directions.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "clients/modem_gateway/protocols/fields.h"
#include "core/check.h"
#include "core/names.h"
#include "tests/clients/modem_gateway/fake_port.h"

namespace halocline::modem_gateway {
namespace {

using testing::kHardBytes;
using testing::ProtocolBench;

struct AhoiBench : ProtocolBench {
  explicit AhoiBench(std::string_view options = "") : ProtocolBench("ahoi", options) {}
  // Bytes as hexadecimal, both ways.
  std::string say(std::string_view hex) { return hex_of(as_bytes(ask(as_text(*bytes_of_hex(hex))))); }
  std::string hear(const modem_receive_t& packet) { return hex_of(as_bytes(receive(packet))); }
};
// Level 120 dB, SNR 30 dB, gain 50 dB.
constexpr auto kFooter = "789E00323232";

TEST(Ahoi, ConfirmsAndSendsTheExampleOfThePage) {
  AhoiBench bench;
  EXPECT_EQ(bench.say("1002010200000502"
                      "4142"
                      "1003"),
            "100201FFFF0005001003");
  ASSERT_EQ(bench.port.sent.size(), 1u);
  EXPECT_EQ(bench.port.sent[0].destination, 2);
  EXPECT_EQ(bench.port.sent[0].payload, std::string("\x00\x05"
                                                    "AB",
                                                    4));
  EXPECT_FALSE(bench.port.sent[0].options.wants_ack);
}

TEST(Ahoi, DoublesTheEscapeByteBothWaysAndTakesAnyPieces) {
  AhoiBench bench;
  const std::string frame{"\x10\x02\x01\x02\x07\x00\x10\x10\x07\x00\x0A\x0D\x2B\x2C\xFF\x10\x10\x10\x03", 19};
  EXPECT_EQ(hex_of(as_bytes(bench.ask_in_pieces(frame))), "100201FFFF001010001003");
  ASSERT_EQ(bench.port.sent.size(), 1u);
  EXPECT_EQ(bench.port.sent[0].payload, "\x07\x10" + std::string(kHardBytes) + "\x10");
  modem_receive_t packet = bench.packet_from(2, 1, bench.port.sent[0].payload);
  EXPECT_EQ(bench.hear(packet), "100202010700101007000A0D2B2CFF1010" + std::string(kFooter) + "1003");
}

TEST(Ahoi, ReportsAcknowledgementsWithTheTwoWayTimeWhereAsked) {
  AhoiBench bench;
  bench.say("10020102000109001003");
  EXPECT_TRUE(bench.port.sent.at(0).options.wants_ack);
  EXPECT_EQ(bench.hear(bench.answer_from(2, modem_receive_t::ACK, 0.5, "\x01")),
            "100202017F000900" + std::string(kFooter) + "1003");
  bench.say("1002010200020A001003");
  // 500000 us = 0x0007A120.
  EXPECT_EQ(bench.hear(bench.answer_from(2, modem_receive_t::ACK, 0.5, "\x01")),
            "100202017F000A040007A120" + std::string(kFooter) + "1003");
  EXPECT_EQ(bench.hear(bench.answer_from(2, modem_receive_t::ACK, 0.5, "\x01")), "");  // once
}

TEST(Ahoi, SendsToAllAndHearsWhatIsForItOrAll) {
  AhoiBench bench;
  bench.say(
      "100201FF00000100"
      "1003");
  EXPECT_EQ(bench.port.sent.at(0).destination, kBroadcastId);
  EXPECT_EQ(bench.hear(bench.packet_from(2, kBroadcastId, std::string("\x00\x01", 2))).substr(0, 12),
            "100202FF0000");
  EXPECT_EQ(bench.hear(bench.packet_from(2, 9, std::string("\x00\x01", 2))), "");
}

TEST(Ahoi, AnswersCommands) {
  AhoiBench bench;
  EXPECT_EQ(bench.say("100200FF84000101"
                      "071003"),
            "100201FFFF0001001003"
            "100207FF84000101071003");
  EXPECT_EQ(bench.addresses.vehicle_of(7), ProtocolBench::kVehicle);
  EXPECT_EQ(bench.say("100200FF850002001003"),
            "100207FFFF0002001003"
            "100207FF850002022EE01003");  // 12000 mV
  EXPECT_EQ(bench.say("100200FF990003020A0B1003").substr(20), "100207FF990003020A0B1003");
  EXPECT_EQ(bench.say("100200FF990004001003").substr(20), "100207FF990004020A0B1003");
  EXPECT_TRUE(bench.port.sent.empty());
}

TEST(Ahoi, RefusesWhatIsMalformedUnknownOrTooMuch) {
  AhoiBench bench;
  EXPECT_EQ(bench.say("10020102000009051003"), "100201FFFE0009001003")
      << "five bytes are stated, none is there";
  EXPECT_EQ(bench.say("100201020000092C" + hex_of(std::vector<std::uint8_t>(300, 0x41)) + "1003"),
            "100201FFFE0009001003");
  EXPECT_EQ(bench.say("100201020000097F" + hex_of(std::vector<std::uint8_t>(127, 0x41)) + "1003"),
            "100201FFFE0009001003");
  EXPECT_EQ(bench.say("100200FFF0000A001003"), "100201FFFE000A001003") << "an unknown command";
  EXPECT_EQ(bench.say("100201027F000B001003"), "100201FFFE000B001003") << "acknowledgements are the modem's";
  EXPECT_TRUE(bench.port.sent.empty());
}

TEST(Ahoi, RefusesAThirdPacketAndTellsWhatCouldNotBeSent) {
  AhoiBench bench;
  const std::string frame =
      "10020102000005024142"
      "1003";
  bench.port.unsent_packets = 1;
  EXPECT_EQ(bench.say(frame), "100201FFFF0005001003");
  bench.port.unsent_packets = 2;
  EXPECT_EQ(bench.say(frame), "100201FFFE0005001003");
  ASSERT_EQ(bench.port.sent.size(), 1u);
  EXPECT_EQ(hex_of(as_bytes(bench.refuse(modem_receipt_t::REFUSED_NO_MODEM))), "100201FFFE0005001003");
}

TEST(Ahoi, TheReceiverSeesTheStatusAsItWasSent) {
  AhoiBench bench;
  bench.say(
      "1002010200060500"
      "1003");
  EXPECT_TRUE(bench.port.sent.at(0).options.wants_ack);
  modem_receive_t packet = bench.packet_from(2, 1, bench.port.sent.at(0).payload);
  packet.header_number = bench.port.sent.at(0).options.header_number;
  EXPECT_EQ(bench.hear(packet).substr(4, 10), "0201000605");
}

TEST(Ahoi, SkipsWhatIsNoFrame) {
  AhoiBench bench;
  EXPECT_EQ(bench.say("00411003"
                      "1002010200"
                      "1003"),
            "");
  EXPECT_EQ(bench.say("10020102"
                      "10020102000005001003"),
            "100201FFFF0005001003");  // started again
  EXPECT_THROW(AhoiBench("colour=red"), InvalidArgument);
}

}  // namespace
}  // namespace halocline::modem_gateway
