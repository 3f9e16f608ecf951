// SPDX-License-Identifier: BSD-3-Clause
// An emulated Micromodem and WHOI's Python driver, pyacomms, and the node of ros_acomms on it: what it waits
// for, in its order.
//
// Formats and order: patel999jay/pyacomms at 34e0c69b (micromodem.py, commstate.py, messageparser.py,
// cyclestats.py), a newer message parser and flexibledataprotocol.py of acomms 2, and ros_acomms in
// MarineRoboticsGroup/multi-spurdog at ea7cb7a0.
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "clients/modem_gateway/protocols/fields.h"
#include "clients/modem_gateway/protocols/micromodem/nmea.h"
#include "tests/clients/modem_gateway/interface_dialogue.h"

namespace halocline::modem_gateway {
namespace {

using ::testing::ElementsAre;
using testing::has_in_turn;
using ::testing::HasSubstr;

class Pyacomms : public ::testing::TestWithParam<const char*>, public testing::InterfaceDialogue {
 protected:
  Pyacomms()
      : InterfaceDialogue({{"one", 1, "micromodem-psk-1", 0, 0, "micromodem", GetParam()},
                           {"two", 2, "micromodem-psk-1", 1000, 0, "micromodem", GetParam()},
                           {"transponder", 3, "micromodem-psk-1", 0, 750, "", "", testing::kTransponder}}) {}

  bool is_newest() const { return std::string_view(GetParam()).find("revision=3") != std::string_view::npos; }
  void ask(std::size_t host, const std::string& body, double seconds) { say(host, nmea_line(body), seconds); }
  // Fields of the sentences of that id, in their order.
  std::vector<std::vector<std::string>> of(std::size_t host, std::string_view id) const {
    std::vector<std::vector<std::string>> found;
    for (const std::string_view line : fields_of(heard[host], '\n')) {
      if (line.empty()) continue;
      const NmeaSentence sentence = nmea_sentence(line.substr(0, line.size() - 1));
      EXPECT_EQ(sentence.problem, NmeaSentence::Problem::kNone) << line;
      if (sentence.id == id) found.emplace_back(sentence.fields.begin(), sentence.fields.end());
    }
    return found;
  }
};

INSTANTIATE_TEST_SUITE_P(Firmware, Pyacomms,
                         ::testing::Values("revision=2.0.31000 lbl=3", "revision=3.0.0 lbl=3"),
                         [](const auto& options) {
                           return std::string(options.param).find("revision=3") != std::string::npos
                                      ? "Newest"
                                      : "Second";
                         });

TEST_P(Pyacomms, StartsAsTheNodeOfRosAcommsDoes) {
  // Each is answered within a second, by the parameter that was asked for.
  for (const auto* name : {"SRC", "TAT", "info.firmware_version"}) {
    ask(0, "CCCFQ," + std::string(name), 0.1);
    const auto answers = of(0, "CACFG");
    ASSERT_EQ(answers.size(), 1u) << name;
    EXPECT_EQ(answers[0][0], name);
    EXPECT_NE(answers[0][1], "") << name;
  }
  for (const auto* setting : {"pwramp.txlevel,3", "xmit.txinhibit,1"}) {
    ask(0, "CCCFG," + std::string(setting), 0.1);
    EXPECT_THAT(heard[0], HasSubstr("$CACFG," + std::string(setting) + "*"));
  }
  ask(0, "CCALQ,0", 0.1);
  EXPECT_THAT(of(0, "CAALQ"), ElementsAre(ElementsAre("AUV", "11")));
  ask(0, "CCTMS,2026-11-24T10:30:06Z,0", 0.1);
  EXPECT_THAT(of(0, "CATMS"), ElementsAre(ElementsAre("0", "2026-11-24T10:30:06Z")));
  ask(0, "CCTMQ,0", 0.1);
  ASSERT_EQ(of(0, "CATMQ").size(), 1u);
  EXPECT_EQ(of(0, "CATMQ")[0].size(), 3u);
  ask(0, "CCCFQ,TOP", 0.1);
  EXPECT_GT(of(0, "CACFG").size(), 10u);
}

// Its states: a cycle packet is over (CATXF) before data is asked for, then that of the data.
TEST_P(Pyacomms, SendsAtRateZeroInTheOrderOfItsStates) {
  ask(0, "CCCYC,0,1,2,0,0,1", 4);
  EXPECT_THAT(heard[0], has_in_turn({"$CACYC,0,1,2,0,0,1*", "$CATXF,", "$CADRQ,"}));
  EXPECT_LT(heard[0].find("$CATXF,"), heard[0].find("$CADRQ,"));
  ask(0, "CCTXD,1,2,0,0000010068656c6c", 8);
  EXPECT_THAT(heard[0], has_in_turn({"$CATXD,1,2,0,8*", "$CATXF,8*"}));
  EXPECT_THAT(of(1, "CARXD"), ElementsAre(ElementsAre("1", "2", "0", "1", "0000010068656C6C")));
}

TEST_P(Pyacomms, AsksForAnUplinkAndReadsTheCycleThatItAskedFor) {
  ask(0, "CCCYC,0,2,1,1,0,1", 3);
  EXPECT_THAT(heard[0], has_in_turn({"$CACYC,0,2,1,1,0,1*", "$CATXF,"}));
  ASSERT_EQ(of(1, "CADRQ").size(), 1u);
  ask(1, "CCTXD,2,1,0,00000100", 6);
  EXPECT_THAT(heard[0],
              has_in_turn({"$CARXP,1*", "$CACYC,0,2,1,1,0,1*", "$CARXD,2,1,0,1,00000100*", "$CACST,"}));
}

// Numbers that it reads as whole: all of CACST but these. Its time has a fraction of six digits.
TEST_P(Pyacomms, ReadsTheStatisticsOfAReception) {
  ask(0, "CCMUC,1,2,0abc", 5);
  EXPECT_THAT(of(1, "CAMUA"), ElementsAre(ElementsAre("1", "2", "0ABC")));
  const auto statistics = of(1, "CACST");
  ASSERT_EQ(statistics.size(), 1u);
  const auto& fields = statistics[0];
  EXPECT_EQ(fields.size(), is_newest() ? 34u : 30u);
  EXPECT_EQ(fields[0], is_newest() ? "8" : "6");
  EXPECT_EQ(fields[2].size(), std::string("20261124103006.345678").size());
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const bool is_decimal = (i >= 21 && i <= 24) || i == 26;
    if (i == 2) continue;
    EXPECT_TRUE(is_decimal ? number_in(fields[i], -1000, 1000).has_value()
                           : integer_in(fields[i], -100'000, 100'000).has_value())
        << i << " " << fields[i];
  }
  const auto sent = of(0, "CAXST");
  ASSERT_EQ(sent.size(), 1u);
  EXPECT_EQ(sent[0].size(), is_newest() ? 17u : 16u);
  EXPECT_EQ(sent[0][0], is_newest() ? "7" : "6");
  EXPECT_EQ(sent[0][2].size(), is_newest() ? 13u : 11u);
}

TEST_P(Pyacomms, SendsAFlexiblePacketOfBothKindsOfFrames) {
  const std::string first = is_newest() ? "CCTFP,0,0," : "CCTFP,";
  ask(0, first + "2,1,1,1,0,08010306ff,4232", 8);
  EXPECT_EQ(of(0, "CATFP").size(), 1u);
  const auto received = of(1, "CARFP");
  ASSERT_EQ(received.size(), 1u);
  ASSERT_EQ(received[0].size(), 11u);
  EXPECT_EQ(received[0][0].size(), std::string("2025-07-01T02:39:55.437363").size());
  EXPECT_EQ(std::vector<std::string>(received[0].begin() + 1, received[0].end()),
            (std::vector<std::string>{"0", "1", "2", "1", "1", "1", "0", "", "1;5;08010306FF", "1;2;4232"}));
  // Of each frame whether it came: the mini-frame's mask and the data's.
  const auto acks = of(0, "CACDR");
  ASSERT_EQ(acks.size(), 1u);
  EXPECT_THAT(std::vector<std::string>(acks[0].begin() + 2, acks[0].begin() + 7),
              ElementsAre("2", "1", "0", "1", "1"));
}

TEST_P(Pyacomms, PingsAndIsTold) {
  ask(0, "CCCMD,PNG,1,2,1,0,", 6);
  EXPECT_THAT(of(0, "CACMD"), ElementsAre(ElementsAre("PNG", "1", "2", "1", "0", "0")));
  const auto replies = of(0, "CACMR");
  ASSERT_EQ(replies.size(), 1u);
  ASSERT_EQ(replies[0].size(), 10u);
  EXPECT_EQ(replies[0][0], "PNR");
  EXPECT_EQ(replies[0][2], "2");
  EXPECT_EQ(replies[0][3], "1");
  EXPECT_NEAR(number_in(replies[0][4], 0, 10).value_or(-1), 1000.0 / 1500, 1e-4);
  for (const std::size_t decimal : {5, 6}) EXPECT_TRUE(number_in(replies[0][decimal], -100, 200));
  for (const std::size_t whole : {7, 8}) EXPECT_TRUE(integer_in(replies[0][whole], 0, 100));
  const auto heard_ping = of(1, "CACMA");
  ASSERT_EQ(heard_ping.size(), 1u);
  EXPECT_EQ(heard_ping[0].size(), 9u);
  EXPECT_EQ(heard_ping[0][is_newest() ? 0 : 1], "PNG");
  EXPECT_THAT(std::vector<std::string>(heard_ping[0].begin() + 2, heard_ping[0].begin() + 4),
              ElementsAre("1", "2"));
}

TEST_P(Pyacomms, PingsTranspondersByDigitsAndByCodes) {
  ask(0, "CCPDT,1,1,0,0,3000,1,0,0,0", 5);
  const auto digital = of(0, "SNTTA");
  ASSERT_EQ(digital.size(), 1u);
  EXPECT_THAT(std::vector<std::string>(digital[0].begin(), digital[0].begin() + 4),
              ElementsAre("0.5000", "", "", ""));
  EXPECT_TRUE(number_in(digital[0][4], 0, 240'000));
  ask(0, "CCPGT,25000,28,D4F2A1,3000,25000,0C3B5E1,0,0,0,0,0", 5);
  EXPECT_EQ(of(0, "SNTTA").size(), 1u);
}

}  // namespace
}  // namespace halocline::modem_gateway
