// SPDX-License-Identifier: BSD-3-Clause
// DUNE's Micromodem tasks at an emulated Micromodem: lines without checksums, data before its cycle, times as
// the first fields of SNTTA.
//
// Formats and order: LSTS/dune, src/Sensors/MLBLTracker/Task.cpp of 2025 and the LBL navigation task.
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/clients/modem_gateway/interface_dialogue.h"

namespace halocline::modem_gateway {
namespace {

using testing::has_in_turn;
using ::testing::HasSubstr;
using ::testing::Not;

class DuneMicromodem : public ::testing::Test, public testing::InterfaceDialogue {
 protected:
  // The host of the first is a console, of the second a vehicle. Transponders have the frequencies of their
  // answers.
  DuneMicromodem()
      : InterfaceDialogue(
            {{"console", 1, "micromodem-psk-1", 0, 0, "micromodem", "revision=0.94.0.00 lbl=3:26000/4:27000"},
             {"vehicle", 2, "micromodem-psk-1", 1000, 0, "micromodem", "revision=0.94.0.00"},
             {"north", 3, "micromodem-psk-1", 0, 750, "", "", testing::kTransponder},
             {"south", 4, "micromodem-psk-1", 0, -600, "", "", testing::kTransponder}}) {
    for (const std::size_t host : {0, 1}) {
      say(host,
          "$CCCFG,SRC," + std::to_string(host + 1) + "\r\n$CCCFG,XST,0\r\n$CCCFG,CTO,10\r\n$CCCFG,TAT,20\r\n",
          0.2);
      EXPECT_THAT(heard[host],
                  has_in_turn({"$CACFG,SRC,", "$CACFG,XST,0*", "$CACFG,CTO,10*", "$CACFG,TAT,20*"}));
    }
  }
};

TEST_F(DuneMicromodem, AFrameGivenBeforeItsCycleIsSent) {
  // 32 bytes in small letters.
  const std::string hex = "a10203040506070809" + std::string(46, '0');
  say(0, "$CCTXD,1,2,0," + hex + "\r\n$CCCYC,0,1,2,0,0,1\r\n", 12);
  EXPECT_THAT(heard[0], has_in_turn({"$CATXD,1,2,0,32*", "$CACYC,0,1,2,0,0,1*", "$CATXF,32*"}));
  EXPECT_THAT(heard[0], Not(HasSubstr("CADRQ")));
  EXPECT_THAT(heard[1], HasSubstr("$CARXD,1,2,0,1,A10203040506070809" + std::string(46, '0') + "*"));
}

TEST_F(DuneMicromodem, AReportToAllIsHeard) {
  const std::string hex = "52" + std::string(62, '0');
  say(1, "$CCTXD,2,0,0," + hex + "\r\n$CCCYC,0,2,0,0,0,1\r\n", 12);
  EXPECT_THAT(heard[0], HasSubstr("$CARXD,2,0,0,1," + hex + "*"));
}

TEST_F(DuneMicromodem, AnAbortIsAMiniPacket) {
  say(0, "$CCMUC,1,2,000a\r\n", 5);
  EXPECT_THAT(heard[0], has_in_turn({"$CAMUC,1,2,000a*", "$CATXP,", "$CATXF,"}));
  EXPECT_THAT(heard[1], HasSubstr("$CAMUA,1,2,000A*"));
  // Ranges are reported to address 15, all.
  say(1, "$CCMUC,2,15,1402\r\n", 5);
  EXPECT_THAT(heard[0], HasSubstr("$CAMUA,2,0,1402*"));
}

TEST_F(DuneMicromodem, RangesToAModemWithinFiveSeconds) {
  say(0, "$CCMPC,1,2\r\n", 5);
  EXPECT_THAT(heard[0], has_in_turn({"$CAMPC,1,2*", "$CAMPR,2,1,0.6667*"}));
}

TEST_F(DuneMicromodem, RangesToATransponderByItsFrequencyWithinFiveSeconds) {
  say(0, "$CCPNT,20000,5,5,5000,27000,0,0,0,1\r\n", 5);
  EXPECT_THAT(heard[0], has_in_turn({"$SNPNT,20000,5,5,5000,27000,0,0,0,1*", "$SNTTA,0.4000,,,,"}));
}

TEST_F(DuneMicromodem, AllTranspondersAreRangedAtOnce) {
  say(0, "$CCPNT,20000,4,4,4000,26000,27000,0,0,1\r\n", 6);
  EXPECT_THAT(heard[0], has_in_turn({"$SNPNT,", "$SNTTA,0.5000,0.4000,,,"}));
}

}  // namespace
}  // namespace halocline::modem_gateway
