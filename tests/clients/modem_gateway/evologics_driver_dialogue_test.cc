// SPDX-License-Identifier: BSD-3-Clause
// DUNE's EvoLogics driver and EvoLogics' own driver for ROS, dmac, at emulated modems half a second apart.
//
// Formats and order: LSTS/dune, src/Transports/Evologics at 0431bb19 and src/DUNE/Hardware/BasicModem at
// 0431bb19; EvoLogics/dmac at 52ee50c5 and 339ecf31.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "clients/modem_gateway/protocols/fields.h"
#include "tests/clients/modem_gateway/interface_dialogue.h"

namespace halocline::modem_gateway {
namespace {

using ::testing::ElementsAre;
using testing::has_in_turn;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class EvologicsDriver : public ::testing::Test, public testing::InterfaceDialogue {
 protected:
  EvologicsDriver()
      : InterfaceDialogue({{"one", 1, "s2c-im", 0, 0, "evologics"},
                           {"two", 2, "s2c-im", 750, 0, "evologics"},
                           {"serial", 3, "s2c-im", 0, 900, "evologics", "mode=data"}}) {}

  // Lines that came, without their ends. A payload may hold one: none does here.
  std::vector<std::string> lines(std::size_t host) {
    std::vector<std::string> lines;
    for (std::size_t end = heard[host].find("\r\n"); end != std::string::npos;
         end = heard[host].find("\r\n")) {
      lines.push_back(heard[host].substr(0, end));
      heard[host].erase(0, end + 2);
    }
    return lines;
  }

  void start_dune(std::size_t host, int address) {
    for (const auto* reset : {"ATZ0\n", "ATZ1\n", "ATZ3\n", "ATZ4\n"}) hosts[host]->write(reset);
    wait(2);
    heard[host].clear();  // flushed
    hosts[host]->write("ATI0\nATI1\n");
    wait(0.1);
    const auto versions = lines(host);
    ASSERT_EQ(versions.size(), 2u);
    EXPECT_NE(versions[0], "1.6") << "of other formats";
    std::array<char, 64> phy{}, mac{};
    EXPECT_EQ(std::sscanf(versions[1].c_str(), "phy:%*[^0]%63[^,], mac:%*[^v]v%63s", phy.data(), mac.data()),
              2)
        << versions[1];
    for (const std::string& setting :
         {std::string("@CTRL"), "!AL" + std::to_string(address), std::string("!L3"), std::string("!G0"),
          std::string("!RC3"), std::string("!RT2000"), std::string("!RI0"), std::string("!ZI0"),
          std::string("!AM14"), std::string("@ZU1"), std::string("!RP1"), std::string("@ZX1")}) {
      say(host, "AT" + setting + "\n", 0.1);
      EXPECT_THAT(lines(host), ElementsAre("OK")) << setting;
    }
  }
  // What it asks after each message, and how it reads it.
  void ask_as_dune(std::size_t host) {
    say(host, "AT?P\n", 1);
    const auto answer = lines(host);
    ASSERT_EQ(answer.size(), 1u) << "one answer up to the carriage return";
    std::vector<std::string> numbers;
    for (const std::string_view line : fields_of(answer[0], '\n')) {
      for (const std::string_view word : words_of(line)) numbers.emplace_back(word);
    }
    ASSERT_GE(numbers.size(), 16u);
    for (const std::string& number : numbers) EXPECT_TRUE(integer_in(number, 0, UINT32_MAX)) << number;
  }
};

TEST_F(EvologicsDriver, DuneStartsSendsAndReceives) {
  start_dune(0, 11);
  start_dune(1, 12);
  say(0, "AT*SENDIM,5,12,ack,hello\n", 4);
  EXPECT_THAT(lines(0),
              ElementsAre("OK", StartsWith("SENDSTART,12,im,"), StartsWith("SENDEND,12,im,"), "RECVSTART",
                          StartsWith("RECVEND,"), StartsWith("RECVSRV,"), "DELIVEREDIM,12"));
  unsigned bytes = 0, source = 0, destination = 0, duration = 0, integrity = 0;
  std::array<char, 16> flag{};
  float rssi = 0, velocity = 0;
  int offset = 0;
  const auto received = lines(1);
  const auto message = std::find_if(received.begin(), received.end(),
                                    [](const std::string& line) { return line.starts_with("RECVIM,"); });
  ASSERT_NE(message, received.end());
  EXPECT_EQ(std::sscanf(message->c_str(), "RECVIM,%u,%u,%u,%15[^,],%u,%f,%u,%f,%n", &bytes, &source,
                        &destination, flag.data(), &duration, &rssi, &integrity, &velocity, &offset),
            8);
  EXPECT_EQ(message->substr(static_cast<std::size_t>(offset)), "hello");
  EXPECT_EQ(std::string(flag.data()), "ack");
  EXPECT_EQ(source, 11u);
  EXPECT_LT(rssi, 0);
  EXPECT_GT(duration, 100'000u);
  say(0, "AT?T\n", 0.1);
  EXPECT_THAT(lines(0), ElementsAre("500000"));
  ask_as_dune(0);
  ask_as_dune(1);
  say(0, "AT?CLOCK\n", 0.1);
  EXPECT_TRUE(integer_in(lines(0).at(0), 0, 1000));
}

TEST_F(EvologicsDriver, DuneIsFreeAgainWhenASoundWithoutAcknowledgementEnds) {
  start_dune(0, 11);
  start_dune(1, 12);
  say(0, "AT*SENDIM,2,12,noack,hi\n", 3);
  EXPECT_THAT(lines(0), ElementsAre("OK", StartsWith("SENDSTART,"), StartsWith("SENDEND,")));
  // A piggy-back message does not make it busy; a burst is acknowledged by itself.
  say(1, "AT*SENDPBM,4,11,back\n", 0.1);
  EXPECT_THAT(lines(1), ElementsAre("OK"));
  const std::string data(100, 'x');
  say(0, "AT*SEND,100,12," + data + "\n", 6);
  EXPECT_THAT(lines(0), ::testing::Contains("DELIVERED,1,12"));
  std::array<unsigned, 6> n{};
  float rssi = 0, velocity = 0;
  int offset = 0;
  const auto received = lines(1);
  const auto burst = std::find_if(received.begin(), received.end(),
                                  [](const std::string& line) { return line.starts_with("RECV,"); });
  ASSERT_NE(burst, received.end());
  EXPECT_EQ(std::sscanf(burst->c_str(), "RECV,%u,%u,%u,%u,%f,%u,%u,%f,%n", &n[0], &n[1], &n[2], &n[3], &rssi,
                        &n[4], &n[5], &velocity, &offset),
            8);
  EXPECT_EQ(burst->substr(static_cast<std::size_t>(offset)), data);
  EXPECT_EQ(n[5], 500'000u);
}

// dmac does not know the interface: it tries data mode first.
TEST_F(EvologicsDriver, DmacFindsANetworkInterface) {
  say(0, "+++AT?MODE\n", 0.1);
  EXPECT_EQ(heard[0], "ERROR WRONG FORMAT\r\n");
  say(0, "AT?MODE\n", 0.1);
  EXPECT_THAT(heard[0], StartsWith("NET"));
  for (const auto* setting : {"@CTRL", "!L3", "!AL1", "@ZX1", "@ZU1"}) {
    say(0, "AT" + std::string(setting) + "\n", 0.1);
    EXPECT_EQ(heard[0], "OK\r\n") << setting;
  }
  for (const auto* table : {"?P", "&V", "?S"}) {
    say(0, "AT" + std::string(table) + "\n", 1);
    EXPECT_TRUE(heard[0].ends_with("\n\r\n")) << table << " " << heard[0];
  }
  say(0, "AT?ZSL\n", 0.1);
  EXPECT_THAT(heard[0], StartsWith("ERROR "));
}

TEST_F(EvologicsDriver, DmacFindsADataInterface) {
  say(2, "+++AT?MODE\n", 0.1);
  EXPECT_EQ(heard[2], "+++AT?MODE:2:AT\r\n");
  say(2, "+++ATO\n+++AT@CTRL\n", 0.1);
  EXPECT_THAT(heard[2], HasSubstr("+++AT@CTRL:2:OK\r\n"));
  say(2, "+++AT!L3\n", 0.1);
  EXPECT_EQ(heard[2], "+++AT!L:2:OK\r\n");
  say(2, "+++AT*SENDIM,5,1,ack,hello\n", 4);
  EXPECT_THAT(heard[2], has_in_turn({"+++AT*SENDIM:2:OK\r\n", "+++AT:13:DELIVEREDIM,1\r\n"}));
  EXPECT_THAT(heard[0], has_in_turn({"RECVIM,5,3,1,ack,", ",hello\r\n"}));
  // What is refused: BUSY or ERROR, a blank and why.
  say(2, "+++AT*SENDIM,5,1,ack,hello\n+++AT*SENDIM,5,1,ack,hello\n", 0.1);
  EXPECT_THAT(heard[2], HasSubstr(":23:BUSY DELIVERING MESSAGE\r\n"));
}

}  // namespace
}  // namespace halocline::modem_gateway
