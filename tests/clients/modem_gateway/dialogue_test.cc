// SPDX-License-Identifier: BSD-3-Clause
// Two Micromodems, two EvoLogics modems and a transponder in quiet water without losses: what hosts write at
// one end, and read at the other.
#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "clients/modem_gateway/protocols/fields.h"
#include "tests/clients/modem_gateway/interface_dialogue.h"

namespace halocline::modem_gateway {
namespace {

using testing::has_in_turn;
using ::testing::HasSubstr;
using ::testing::Not;

// 1500 m/s: 1000 m are 0.6667 s, 750 m 0.5 s.
class Dialogue : public ::testing::Test, public testing::InterfaceDialogue {
 protected:
  Dialogue()
      : InterfaceDialogue({{"one", 1, "micromodem-psk-1", 0, 0, "micromodem", "lbl=3"},
                           {"two", 2, "micromodem-psk-1", 1000, 0, "micromodem"},
                           {"transponder", 3, "micromodem-psk-1", 0, 750, "", "", testing::kTransponder},
                           {"four", 4, "s2c-im", 0, 300, "evologics"},
                           {"five", 5, "s2c-im", 750, 300, "evologics"}}) {}
};

TEST_F(Dialogue, APingTellsTheOneWayTime) {
  say(0, "$CCMPC,1,2\r\n", 6);
  EXPECT_THAT(heard[0], has_in_turn({"$CAMPC,1,2*", "$CATXP,", "$CATXF,", "$CAXST,", "$CARXP,",
                                     "$CAMPR,2,1,0.6667*", "$CACST,6,0,"}));
  EXPECT_THAT(heard[1], has_in_turn({"$CARXP,0*", "$CAMPA,1,2*", "$CACST,6,0,"}));
  say(0, "$CCCMD,PNG,1,2,1,0,0\r\n", 6);
  EXPECT_THAT(heard[0], has_in_turn({"$CACMD,PNG,1,2,1,0,0*", "$CACMR,PNR,1970-01-01T00:00:", ",2,1,0.6666",
                                     "$CACST,6,0,"}));
  EXPECT_THAT(heard[1], has_in_turn({"$CARXP,1*", "$CACMA,1970-01-01T00:00:", ",PNG,1,2,"}));
}

TEST_F(Dialogue, ATransponderAnswersWithItsTravelTime) {
  say(0, "$CCPDT,1,1,0,0,3000,1,0,0,0\r\n", 6);
  EXPECT_THAT(heard[0], has_in_turn({"$SNPDT,1,1,0,0,3000,1,0,0,0*", "$SNTTA,0.5000,,,,"}));
  say(0, "$CCPNT,9000,5,5,3000,9500,0,0,0,1\r\n", 6);
  EXPECT_THAT(heard[0], has_in_turn({"$SNPNT,9000,", "$SNTTA,0.5000,,,,"}));
}

// Four at unequal ranges, and a modem that is none. Answers of more than half a second overlap.
TEST(LongBaseline, FourTranspondersAnswerOnePingAndEachHasItsTravelTime) {
  std::vector<testing::InterfaceVehicle> fleet{
      {"auv", 1, "micromodem-psk-1", 0, 0, "micromodem", "lbl=11/12/13/14"},
      {"other", 2, "micromodem-psk-1", 200, 200, "micromodem"}};
  const double ranges_m[] = {1000, 431.7, 1013.3, 777.7};
  for (int i = 0; i < 4; ++i)
    fleet.push_back({"t" + std::to_string(i), 11 + i, "micromodem-psk-1", i % 2 == 0 ? ranges_m[i] : 0,
                     i % 2 == 0 ? 0 : ranges_m[i], "", "", testing::kTransponder});
  testing::InterfaceDialogue lbl(fleet);
  for (const auto* command : {"$CCPDT,1,1,0,0,3000,1,1,1,1\r\n", "$CCPNT,9000,5,5,3000,1,1,1,1,1\r\n"}) {
    lbl.run.outcomes.clear();
    lbl.say(0, command, 8);
    const std::size_t at = lbl.heard[0].find("$SNTTA,");
    ASSERT_NE(at, std::string::npos) << lbl.heard[0];
    const auto times = fields_of(std::string_view(lbl.heard[0]).substr(at), ',');
    int answers = 0;
    std::vector<double> begins_s;
    for (const packet_outcome_t& outcome : lbl.run.outcomes) {
      if (outcome.packet_kind != modem_receive_t::PING_REPLY || outcome.receiver_id != 1) continue;
      ++answers;
      begins_s.push_back(1e-6 * static_cast<double>(outcome.departure_utime) + outcome.travel_time_s);
      const auto place = static_cast<std::size_t>(outcome.source_id - 11);
      EXPECT_EQ(outcome.outcome, packet_outcome_t::RECEIVED);
      EXPECT_NEAR(number_in(times.at(1 + place), 0, 10).value_or(-1), outcome.travel_time_s, 1e-4);
      EXPECT_NEAR(outcome.travel_time_s, ranges_m[place] / 1500, 1e-6);
    }
    EXPECT_EQ(answers, 4);
    EXPECT_LT(*std::max_element(begins_s.begin(), begins_s.end()) -
                  *std::min_element(begins_s.begin(), begins_s.end()),
              1);
    EXPECT_THAT(lbl.heard[1], Not(HasSubstr("CAMPA")));
  }
}

TEST_F(Dialogue, AFlexiblePacketOf100BytesArrivesWholeAndIsAcknowledged) {
  const std::string data = "000A0D2B2CFF" + std::string(188, 'A');
  say(0, "$CCTDP,2,1,1,0," + data + "\r\n", 10);
  EXPECT_THAT(heard[0], has_in_turn({"$CATDP,0,2,1,1,0,100*", "$CATXF,100*", "$CAXST,", "$CAACK,2,1,1,1*",
                                     "$CACST,6,0,"}));
  EXPECT_THAT(heard[1], has_in_turn({"$CARXP,1*",
                                     "$CARDP,1,2,1,1,0,,1;64;" + data.substr(0, 128) + ";1;36;" +
                                         data.substr(128) + "*",
                                     "$CACST,6,0,"}));
}

TEST_F(Dialogue, ThreeFramesAreAcknowledgedOneByOne) {
  say(0, "$CCCYC,0,1,2,1,1,3\r\n", 0.2);
  for (const auto* frame : {"61", "000A0D2B2CFF", "63"})
    hosts[0]->write("$CCTXD,1,2,1," + std::string(frame) + "\r\n");
  wait(12);
  EXPECT_THAT(heard[0],
              has_in_turn({"$CACYC,0,1,2,1,1,3*", "$CADRQ,", "$CADRQ,", "$CADRQ,", "$CAACK,2,1,1,1*",
                           "$CAACK,2,1,2,1*", "$CAACK,2,1,3,1*", "$CACST,6,0,"}));
  EXPECT_THAT(heard[1], has_in_turn({"$CARXP,1*", "$CACYC,0,1,2,1,1,3*", "$CARXD,1,2,1,1,61*",
                                     "$CARXD,1,2,1,2,000A0D2B2CFF*", "$CARXD,1,2,1,3,63*", "$CACST,6,0,"}));
}

TEST_F(Dialogue, AtRateZeroACyclePacketComesFirst) {
  say(0, "$CCCYC,0,1,2,0,1,1\r\n", 4);
  EXPECT_THAT(heard[0],
              has_in_turn({"$CACYC,0,1,2,0,1,1*", "$CATXF,2*", "$CAXST,", "$CADRQ,", ",1,2,1,32,1*"}));
  EXPECT_THAT(heard[1], has_in_turn({"$CARXP,0*", "$CACYC,0,1,2,0,1,1*", "$CACST,"}));
  say(0, "$CCTXD,1,2,1,000A0D2B2CFF\r\n", 10);
  EXPECT_THAT(heard[0], has_in_turn({"$CATXD,1,2,1,6*", "$CAXST,", "$CAACK,2,1,1,1*", "$CACST,"}));
  EXPECT_THAT(heard[1], has_in_turn({"$CARXP,0*", "$CARXD,1,2,1,1,000A0D2B2CFF*", "$CACST,"}));
}

TEST_F(Dialogue, AnotherModemIsPolled) {
  say(0, "$CCCYC,0,2,1,1,0,1\r\n", 3);
  EXPECT_THAT(heard[1], has_in_turn({"$CACYC,0,2,1,1,0,1*", "$CADRQ,", ",2,1,0,64,1*"}));
  say(1, "$CCTXD,2,1,0,000A0D2B2CFF\r\n", 6);
  EXPECT_THAT(heard[0], has_in_turn({"$CARXP,1*", "$CACYC,0,2,1,1,0,1*", "$CARXD,2,1,0,1,000A0D2B2CFF*",
                                     "$CACST,6,0,"}));
}

TEST_F(Dialogue, ALineOfAnotherModemIsSet) {
  say(0, "$CCMEC,1,2,3,2,17\r\n", 8);
  EXPECT_THAT(heard[0],
              has_in_turn({"$CAMEC,1,2,3,2,17*", "$CARXP,0*", "$CAMER,2,1,3,2,17*", "$CACST,6,0,"}));
}

TEST_F(Dialogue, InstantMessagesOfEveryKindArriveAsWhatTheyAre) {
  for (const std::size_t host : {2, 3}) say(host, "AT@ZX1\n", 0.1);
  say(3, "AT*SENDPBM,4,4,back\n", 0.2);
  EXPECT_EQ(heard[3], "OK\r\n");
  say(2, "AT*SENDIM,4,5,ack,a\r\nd\n", 4);
  EXPECT_THAT(heard[2], has_in_turn({"OK\r\n", "SENDSTART,5,im,", "SENDEND,5,im,", "RECVSTART\r\n",
                                     "RECVEND,", "RECVSRV,5,4,ack,", "DELIVEREDIM,5\r\n", "RECVSTART\r\n",
                                     "RECVPBM,4,5,4,", ",back\r\n"}));
  EXPECT_THAT(heard[3], has_in_turn({"RECVSTART\r\n", "RECVEND,", "RECVIM,4,4,5,ack,", ",0.0000,a\r\nd\r\n",
                                     "SENDSTART,4,pbm,"}));
  say(2, "AT?T\n", 0.2);
  EXPECT_EQ(heard[2], "500000\r\n");
  say(2, "AT*SENDIMS,4,5,,abcd\n", 4);
  EXPECT_THAT(heard[3], has_in_turn({"RECVIMS,4,4,5,", ",0.0000,abcd\r\n"}));
  say(2, "AT*SENDIM,4,5,force,abcd\n", 4);
  EXPECT_THAT(heard[3], has_in_turn({"RECVIM,4,4,5,force,", ",0.0000,abcd\r\n"}));
  say(2, "AT*SEND,4,5,abcd\n", 6);
  EXPECT_THAT(heard[2], HasSubstr("DELIVERED,1,5\r\n"));
  EXPECT_THAT(heard[3], has_in_turn({"RECV,4,4,5,", ",500000,0.0000,abcd\r\n"}));  // 750 m
  say(3, "AT?P\n", 1);
  EXPECT_EQ(heard[3].substr(0, 11), "0 1000\n0 0\n");
}

// Three of ten packets are lost, data and acknowledgements: then a message is repeated, and none is reported
// twice.
TEST(Repetitions, BurstsAndInstantMessagesThroughLossyWaterArriveOnceAndInTheirOrder) {
  testing::InterfaceDialogue lossy(
      {{"one", 1, "s2c-im", 0, 0, "evologics"}, {"two", 2, "s2c-im", 750, 0, "evologics"}}, 0.3);
  std::string all;
  for (char name = 'a'; name < 'k'; ++name) all += "AT*SEND,4,2,000" + std::string(1, name) + "\n";
  lossy.say(0, "AT!RC9\n", 0.2);
  lossy.say(0, all, 150);
  EXPECT_THAT(lossy.heard[0], Not(HasSubstr("FAILED")));
  std::size_t at = 0, received = 0;
  std::vector<std::string> done, data;
  for (int i = 0; i < 10; ++i) {
    done.push_back("DELIVERED," + std::to_string(i + 1) + ",2\r\n");
    data.push_back(",000" + std::string(1, static_cast<char>('a' + i)) + "\r\n");
  }
  EXPECT_THAT(lossy.heard[0], has_in_turn(done));
  EXPECT_THAT(lossy.heard[1], has_in_turn(data));
  while ((at = lossy.heard[1].find("RECV,", at)) != std::string::npos) ++received, ++at;
  EXPECT_EQ(received, 10u);
  const auto sent = std::count_if(
      lossy.run.outcomes.begin(), lossy.run.outcomes.end(), [](const packet_outcome_t& outcome) {
        return outcome.packet_kind == modem_receive_t::DATA && outcome.receiver_id == 2;
      });
  EXPECT_GT(sent, 10) << "nothing was repeated";
}

}  // namespace
}  // namespace halocline::modem_gateway
