// SPDX-License-Identifier: BSD-3-Clause
// Hosts of every manner: ends of lines, case, pieces, many commands at once, connections that break off and
// come again.
#include <algorithm>
#include <cstddef>
#include <memory>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/clients/modem_gateway/interface_dialogue.h"

namespace halocline::modem_gateway {
namespace {

using testing::has_in_turn;
using ::testing::HasSubstr;
using ::testing::Not;

// A command that each kind of modem answers at once, without its end.
struct Manner {
  const char* kind;
  const char* profile;
  std::string command, answer;
};

class AnyHost : public ::testing::TestWithParam<Manner>, public testing::InterfaceDialogue {
 protected:
  AnyHost()
      : InterfaceDialogue({{"one", 1, GetParam().profile, 0, 0, GetParam().kind},
                           {"two", 2, GetParam().profile, 500, 0, GetParam().kind}}) {}
  static std::size_t count(const std::string& text, const std::string& part) {
    std::size_t found = 0;
    for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) ++found;
    return found;
  }
  void connect_again() { hosts[0] = std::make_unique<testing::Host>(run.gateway().place_of(0)); }
};

INSTANTIATE_TEST_SUITE_P(
    Kinds, AnyHost,
    ::testing::Values(Manner{"micromodem", "micromodem-psk-1", "$CCCFQ,SRC", "$CACFG,SRC,1*"},
                      Manner{"evologics", "s2c-im", "AT?AL", "1\r\n"},
                      Manner{"unet", "unet-data", R"({"action":"containsAgent","id":"7","agentID":"phy"})",
                             R"("answer":true)"},
                      Manner{"nm3", "nm3", "$?", "#A001V"}),
    [](const auto& manner) { return std::string(manner.param.kind); });

TEST_P(AnyHost, EndsItsLinesAsItLikes) {
  for (const auto* end : {"\r\n", "\n", "\r", "\n\r", "\r\n\r\n"}) {
    say(0, GetParam().command + end, 0.2);
    EXPECT_EQ(count(heard[0], GetParam().answer), 1u) << ::testing::PrintToString(end) << heard[0];
  }
}

TEST_P(AnyHost, WritesManyCommandsAtOnceAndEachIsAnswered) {
  std::string many;
  for (int i = 0; i < 50; ++i) many += GetParam().command + (i % 2 == 0 ? "\r\n" : "\n");
  say(0, many, 0.5);
  EXPECT_EQ(count(heard[0], GetParam().answer), 50u);
}

TEST_P(AnyHost, WritesALineInPiecesWithPausesBetween) {
  for (std::string& each : heard) each.clear();
  for (const char c : GetParam().command + "\r\n") {
    hosts[0]->write(std::string(1, c));
    wait(0.05);
  }
  EXPECT_EQ(count(heard[0], GetParam().answer), 1u) << heard[0];
}

TEST_P(AnyHost, BreaksOffWithinALineAndComesAgain) {
  for (int times = 0; times < 5; ++times) {
    hosts[0]->write(GetParam().command.substr(0, GetParam().command.size() - 1));
    wait(0.1);
    connect_again();
    say(0, GetParam().command + "\n", 0.2);
    EXPECT_EQ(count(heard[0], GetParam().answer), 1u) << heard[0];
  }
  say(1, GetParam().command + "\n", 0.2);
  EXPECT_FALSE(heard[1].empty());
}

class MicromodemManners : public ::testing::Test, public testing::InterfaceDialogue {
 protected:
  MicromodemManners()
      : InterfaceDialogue({{"one", 1, "micromodem-psk-1", 0, 0, "micromodem"},
                           {"two", 2, "micromodem-psk-1", 500, 0, "micromodem"}}) {}
};

TEST_F(MicromodemManners, SmallLettersBlanksAndNoChecksumsAreTaken) {
  say(0, "$cccfq,SRC\n$CCCFQ,SRC*3a \n$CCCFQ,SRC*00\n", 0.2);
  EXPECT_THAT(heard[0], has_in_turn({"$CACFG,SRC,1*", "$CACFG,SRC,1*", ",NMEA,"}));
  say(0, "$ccmuc,1,2,0abc\n", 4);
  EXPECT_THAT(heard[0], HasSubstr("$CAMUC,1,2,0abc*"));
  EXPECT_THAT(heard[1], HasSubstr("$CAMUA,1,2,0ABC*"));
}

// What was given for a cycle before the host broke off is sent; a new host is told how it ended.
TEST_F(MicromodemManners, AHostThatComesAgainIsToldWhatItsModemDoes) {
  say(0, "$CCCYC,0,1,2,1,1,2\r\n$CCTXD,1,2,1,6162\r\n$CCTXD,1,2,1,63", 0.3);
  hosts[0] = std::make_unique<testing::Host>(run.gateway().place_of(0));
  say(0, "$CCTXD,1,2,1,6364\r\n", 10);
  EXPECT_THAT(heard[0], has_in_turn({"$CATXD,1,2,1,2*", "$CATXF,4*", "$CAACK,2,1,1,1*", "$CAACK,2,1,2,1*"}));
  EXPECT_THAT(heard[1], has_in_turn({"$CARXD,1,2,1,1,6162*", "$CARXD,1,2,1,2,6364*"}));
  EXPECT_THAT(heard[0], Not(HasSubstr("CAERR")));
}

// Every command that a modem interface has confirmed is transmitted or reported, however many come at once.
//
// How a kind sends, and the parts of its lines by which answers and reports are counted.
struct Sending {
  const char* kind;
  const char* profile;
  std::string command, from_other;  // the latter wants an acknowledgement, which keeps the modem busy
  std::string confirmed, refused, not_sent;
  std::string played = {};  // reports of transmissions that are no packets
};

const std::string kAhoi(
    "\x10\x02\x01\x02\x00\x00\x05\x02"
    "AB\x10\x03",
    12);
const std::string kAhoiToOne(
    "\x10\x02\x02\x01\x00\x01\x05\x02"
    "AB\x10\x03",
    12);
std::string unet(const std::string& fields) {
  return R"({"action":"send","message":{"clazz":"org.arl.unet.DatagramReq","data":{"msgID":"m","sender":"g",)"
         R"("recipient":"uwlink",)" +
         fields + "}}}\n";
}

class ConfirmedCommands : public ::testing::TestWithParam<Sending>, public testing::InterfaceDialogue {
 protected:
  ConfirmedCommands()
      : InterfaceDialogue({{"one", 1, GetParam().profile, 0, 0, GetParam().kind},
                           {"two", 2, GetParam().profile, 500, 0, GetParam().kind}}) {}
  std::size_t count(const std::string& part) const {
    std::size_t found = 0;
    for (std::size_t at = 0; !part.empty() && (at = heard[0].find(part, at)) != std::string::npos;
         at += part.size())
      ++found;
    return found;
  }
  std::size_t transmitted() const {
    return static_cast<std::size_t>(
        std::count_if(run.outcomes.begin(), run.outcomes.end(), [](const packet_outcome_t& outcome) {
          return outcome.source_id == 1 && outcome.packet_kind != modem_receive_t::ACK;
        }));
  }
};

INSTANTIATE_TEST_SUITE_P(
    Kinds, ConfirmedCommands,
    ::testing::Values(Sending{"ahoi", "ahoi", kAhoi, kAhoiToOne, std::string("\x02\x01\xff\xff\x00\x05", 6),
                              std::string("\x02\x01\xff\xfe\x00\x05", 6), ""},
                      Sending{"evologics", "s2c-im", "AT*SENDIM,2,2,noack,ab\n", "AT*SENDIM,2,1,ack,ab\n",
                              "OK\r\n", "BUSY", "CANCELEDIM"},
                      Sending{"micromodem", "micromodem-psk-1", "$CCMUC,1,2,0001\r\n",
                              "$CCTDP,1,1,1,0,61\r\n", "$CAMUC,", ",NMEA,4,", "0,3,200,"},
                      Sending{"nm3", "nm3", "$B02ab", "$M00102ab", "$B02", "E\r\n", ""},
                      Sending{"unet", "unet-data", unet(R"("to":2,"data":[1])"),
                              unet(R"("to":1,"data":[1],"reliability":true)"), "AGREE", "REFUSE", "FAILURE"},
                      Sending{"uasp2", "generic", "{\"action\":\"ostart\"}\n", "{\"action\":\"ostart\"}\n",
                              "\"ostart\"", "error", "", "\"ostop\""}),
    [](const auto& sending) { return std::string(sending.param.kind); });

TEST_P(ConfirmedCommands, AreTransmittedOrReported) {
  constexpr std::size_t kAtOnce = 40, kLater = 10;
  std::string many;
  for (std::size_t i = 0; i < kAtOnce; ++i) many += GetParam().command;
  for (std::string& each : heard) each.clear();
  hosts[1]->write(GetParam().from_other);
  hosts[0]->write(many);
  for (std::size_t i = 0; i < kLater; ++i) {
    hosts[1]->write(GetParam().from_other);
    wait(1.3);
    hosts[0]->write(GetParam().command);
  }
  wait(60);
  const std::size_t confirmed = count(GetParam().confirmed);
  const std::size_t sent = GetParam().played.empty() ? transmitted() : count(GetParam().played);
  EXPECT_EQ(confirmed + count(GetParam().refused), kAtOnce + kLater) << heard[0];
  EXPECT_EQ(confirmed, sent + count(GetParam().not_sent)) << heard[0];
  EXPECT_GE(sent, 2u);
}

}  // namespace
}  // namespace halocline::modem_gateway
