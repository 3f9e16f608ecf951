// SPDX-License-Identifier: BSD-3-Clause
// Goby's Micromodem driver at two emulated modems a kilometre apart: how it starts, and what its own test
// asks of two modems.
#include <cstddef>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/clients/modem_gateway/goby_driver.h"
#include "tests/clients/modem_gateway/interface_dialogue.h"

namespace halocline::modem_gateway {
namespace {

using ::testing::ElementsAre;
using testing::GobyDriver;
using testing::GobyReception;

class Goby : public ::testing::TestWithParam<const char*>, public testing::InterfaceDialogue {
 protected:
  Goby()
      : InterfaceDialogue(
            {{"one", 1, "micromodem-psk-1", 0, 0, "micromodem", "lbl=3 pps=yes " + std::string(GetParam())},
             {"two", 2, "micromodem-psk-1", 1000, 0, "micromodem", "pps=yes " + std::string(GetParam())},
             {"transponder", 3, "micromodem-psk-1", 0, 750, "", "", testing::kTransponder}}) {
    one.start({"ALL,0"});
    two.start({"ALL,0", "AGN,0", "psk.packet.mod_hdr_version,0"});
    run(16);
    one.take();
    two.take();
  }
  void run(double seconds) {
    wait(seconds, [this] {
      one.work(now_s, heard[0]);
      two.work(now_s, heard[1]);
    });
  }
  bool is_second() const { return std::string(GetParam()).find("=2") != std::string::npos; }

  // Their clocks run ahead of simulation time by part of a second.
  GobyDriver one{*hosts[0], 1, 0.4}, two{*hosts[1], 2, 0.85};
};

INSTANTIATE_TEST_SUITE_P(Generations, Goby, ::testing::Values("revision=0.94.0.00", "revision=2.0.31000"),
                         [](const auto& revision) {
                           return std::string(revision.param) == "revision=0.94.0.00" ? "First" : "Second";
                         });

TEST_P(Goby, StartsWithoutRepeatingALineAndKeepsItsClock) {
  for (const GobyDriver* driver : {&one, &two}) {
    EXPECT_TRUE(driver->is_started());
    EXPECT_EQ(driver->repeated(), 0);
    EXPECT_EQ(driver->major(), is_second() ? 2 : 0);
    EXPECT_LE(driver->clock_settings(),
              3);  // the first ones before it knows that the modem rebooted, and of what generation it is
  }
  const int settings = one.clock_settings();
  run(60);
  EXPECT_EQ(one.clock_settings(), settings);
  EXPECT_EQ(one.unanswered(), 0u);
}

TEST_P(Goby, APingIsHeardAndAnswered) {
  one.push("CCMPC,1,2");
  run(6);
  const auto asker = one.take(), asked = two.take();
  ASSERT_EQ(asker.size(), 1u);
  EXPECT_EQ(asker[0].type, "PING");
  EXPECT_EQ(asker[0].source, 2);
  EXPECT_THAT(asker[0].times, ElementsAre("0.6667"));
  ASSERT_EQ(asked.size(), 1u);
  EXPECT_EQ(asked[0].type, "PING");
  EXPECT_EQ(asked[0].source, 1);
}

TEST_P(Goby, RangesToTranspondersOfBothKinds) {
  one.configure("TAT,50");
  one.push("CCPDT,1,2,0,0,1383,1,1,1,0");
  run(8);
  const auto digital = one.take();
  ASSERT_EQ(digital.size(), 1u);
  EXPECT_EQ(digital[0].type, "RANGES");
  EXPECT_THAT(digital[0].times, ElementsAre("0.5000", "", "", ""));
  one.configure("TAT,20");
  one.push("CCPNT,26000,5,5,1353,25000,0,0,0,1");
  run(8);
  const auto narrow = one.take();
  ASSERT_EQ(narrow.size(), 1u);
  EXPECT_THAT(narrow[0].times, ElementsAre("0.5000", "", "", ""));
}

TEST_P(Goby, AMiniPacketArrives) {
  two.push("CCMUC,2,1,0123");
  run(5);
  const auto received = one.take();
  ASSERT_EQ(received.size(), 1u);
  EXPECT_EQ(received[0].type, "MINI");
  EXPECT_EQ(received[0].source, 2);
  EXPECT_EQ(received[0].destination, 1);
  EXPECT_THAT(received[0].frames, ElementsAre("0123"));
  EXPECT_EQ(two.transmissions(), is_second() ? 1 : 0);  // the first generation reports them where XST is set
}

TEST_P(Goby, AFrameAtRateZeroIsReceivedOnceAndAcknowledged) {
  one.data = {"000102030405060708090A0B0C0D0E0F101112131415161718191A1B1C1D1E1F"};
  one.cycle(1, 2, 0, true, 1);
  run(20);
  const auto acks = one.take(), data = two.take();
  ASSERT_EQ(data.size(), 1u) << "the statistics of the cycle packet and of the data are one reception";
  EXPECT_EQ(data[0].type, "DATA");
  EXPECT_EQ(data[0].frames, one.data);
  ASSERT_EQ(acks.size(), 1u);
  EXPECT_EQ(acks[0].type, "ACK");
  EXPECT_EQ(acks[0].source, 2);
  EXPECT_THAT(acks[0].acknowledged, ElementsAre(0));
  EXPECT_EQ(one.transmissions(), is_second() ? 1 : 0);
}

TEST_P(Goby, ThreeFramesAtRateTwoAreAcknowledgedTogether) {
  one.data = {std::string(128, '4'), std::string(128, '8'), "00C1FF"};
  one.cycle(1, 2, 2, true, 3);
  run(20);
  const auto acks = one.take(), data = two.take();
  ASSERT_EQ(data.size(), 1u);
  EXPECT_THAT(data[0].frames, ElementsAre(one.data[0], one.data[1], "00C1FF" + std::string(122, '0')));
  ASSERT_EQ(acks.size(), 1u);
  EXPECT_THAT(acks[0].acknowledged, ElementsAre(0, 1, 2));
}

TEST_P(Goby, APolledModemSendsWhatItsHostHas) {
  two.data = {"A1B2"};
  one.cycle(2, 1, 1, true, 3);
  run(20);
  const auto polled = one.take();
  ASSERT_EQ(polled.size(), 1u);
  EXPECT_EQ(polled[0].type, "DATA");
  EXPECT_EQ(polled[0].source, 2);
  EXPECT_THAT(polled[0].frames, ElementsAre("A1B2" + std::string(124, '0')));
}

TEST_P(Goby, AFlexiblePacketIsHandedOnAsOneFrame) {
  if (!is_second()) GTEST_SUCCEED() << "the first generation has none";
  for (GobyDriver* driver : {&one, &two}) driver->configure("psk.packet.mod_hdr_version,1");
  two.push("CCTDP,1,1,0,0,00112233445566778899001122334455667788990011");
  run(8);
  const auto received = one.take();
  ASSERT_EQ(received.size(), 1u);
  EXPECT_EQ(received[0].type, "FLEXIBLE");
  EXPECT_EQ(received[0].source, 2);
  EXPECT_EQ(received[0].destination, 1);
  EXPECT_EQ(received[0].bad_frames, 0u);
  EXPECT_THAT(received[0].frames, ElementsAre("00112233445566778899001122334455667788990011"));
}

TEST_P(Goby, ASynchronisedTransmissionTellsItsTravelTimeByItsArrival) {
  two.configure("SNV,1");
  two.push("CCMUC,2,1,0001");
  run(6);
  const auto received = one.take();
  ASSERT_EQ(received.size(), 1u);
  ASSERT_EQ(received[0].one_way_s.size(), 1u);
  EXPECT_NEAR(received[0].one_way_s[0], 1000.0 / 1500, 1e-4);
}

TEST_P(Goby, AnotherModemsLineIsSet) {
  one.push("CCMEC,1,2,3,1,1");
  run(8);
  EXPECT_EQ(one.take().size(), 1u);
  EXPECT_EQ(one.unanswered(), 0u);
}

}  // namespace
}  // namespace halocline::modem_gateway
