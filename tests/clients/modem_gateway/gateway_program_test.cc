// SPDX-License-Identifier: BSD-3-Clause
// The program by itself, on a private bus (scripts/isolated): modem interfaces of its command line, its
// trace, its end.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "acoustics/waveform/moving_link.h"
#include "tests/clients/modem_gateway/host.h"
#include "tests/clients/modem_gateway/waveform_host.h"
#include "tests/support/process.h"
#include "tests/support/working_folder.h"

namespace halocline::modem_gateway {
namespace {

using ::testing::HasSubstr;
using testing::Host;
using testing::work_until;

const std::string kProgram = std::string(HALOCLINE_BIN_DIR) + "/halocline-modem-gateway";

std::string answer_of(Host& host, std::size_t size) {
  std::string text;
  work_until(
      [&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        text += host.read();
      },
      [&] { return text.size() >= size; });
  return text;
}

TEST(GatewayProgram, ServesModemInterfacesOfItsCommandLineBeforeASimulationRuns) {
  const halocline::testing::TemporaryFolder folder;
  std::ofstream("s.toml") << "[[vehicle]]\nname = \"auv-1\"\nid = 1\n[[vehicle]]\nname = \"auv-2\"\nid = 2\n";
  halocline::testing::Process gateway({kProgram, "s.toml", "--modem-interface", "auv-1=nm3:tcp:9601",
                                       "--modem-interface", "auv-2=nm3:pty:line", "--trace", "trace.txt"});
  ASSERT_TRUE(work_until([] { std::this_thread::sleep_for(std::chrono::milliseconds(10)); },
                         [] { return Host("tcp:9601").is_open(); }));
  Host tcp("tcp:9601"), line("pty:line");
  tcp.write("$?");
  EXPECT_EQ(answer_of(tcp, 13), "#A001V52429\r\n");
  line.write("$?");
  EXPECT_EQ(answer_of(line, 13), "#A002V52429\r\n");
  gateway.signal(SIGTERM);
  EXPECT_EQ(gateway.wait(), 0) << gateway.output();
  std::stringstream trace;
  trace << std::ifstream("trace.txt").rdbuf();
  EXPECT_THAT(trace.str(), HasSubstr("0.000000 auv-1 nm3 < $?\n0.000000 auv-1 nm3 > #A001V52429\\r\\n\n"));
}

TEST(GatewayProgram, NamesWhatIsWrongWithAModemInterface) {
  const halocline::testing::TemporaryFolder folder;
  std::ofstream("s.toml") << "[[vehicle]]\nname = \"auv-1\"\nid = 1\n";
  for (const auto& [interface, problem] : {std::pair("auv-9=nm3:tcp:9601", "there is no vehicle 'auv-9'"),
                                           {"auv-1=fax:tcp:9601", "kind of modem interface 'fax'"},
                                           {"auv-1=nm3:udp:9601", "allowed are tcp:PORT"}}) {
    halocline::testing::Process gateway({kProgram, "s.toml", "--modem-interface", interface});
    EXPECT_EQ(gateway.wait(), 2) << interface;
    EXPECT_THAT(gateway.output(), HasSubstr(problem));
  }
}

constexpr auto kFour =
    "[[vehicle]]\nname = \"a\"\nid = 1\n[[vehicle]]\nname = \"b\"\nid = 2\n"
    "[[vehicle]]\nname = \"c\"\nid = 3\n[[vehicle]]\nname = \"d\"\nid = 4\n";

// Killed at once after it has answered: each modem has what its kind keeps, and nothing else.
TEST(GatewayProgram, AModemHasItsSettingsAfterItsGatewayWasKilled) {
  const halocline::testing::TemporaryFolder folder;
  std::ofstream("s.toml") << kFour;
  const std::vector<std::string> command{kProgram,
                                         "s.toml",
                                         "--journal",
                                         "journal",
                                         "--modem-interface",
                                         "a=nm3:tcp:9611",
                                         "--modem-interface",
                                         "b=evologics:tcp:9612",
                                         "--modem-interface",
                                         "c=micromodem:tcp:9613",
                                         "--modem-interface",
                                         "d=ahoi:tcp:9614"};
  const auto wait_for_start = [] {
    return work_until([] { std::this_thread::sleep_for(std::chrono::milliseconds(10)); },
                      [] { return Host("tcp:9614").is_open(); });
  };
  const auto ask = [](int port, const std::string& text, std::size_t size) {
    Host host("tcp:" + std::to_string(port));
    host.write(text);
    return answer_of(host, size);
  };
  const std::string set_id("\x10\x02\x04\xff\x84\x00\x01\x01\x09\x10\x03", 11);
  const std::string ask_id("\x10\x02\x04\xff\x84\x00\x01\x00\x10\x03", 10);
  {
    halocline::testing::Process gateway(command);
    ASSERT_TRUE(wait_for_start()) << gateway.output();
    EXPECT_EQ(ask(9612, "AT!L2\nAT!AL7\nAT&W\nAT!L1\n", 16), "OK\r\nOK\r\nOK\r\nOK\r\n");
    EXPECT_THAT(ask(9613, "$CCCFG,SRC,8\r\n$CCCFG,AGN,77\r\n", 34), HasSubstr("$CACFG,AGN,77*"));
    EXPECT_EQ(ask(9614, set_id, 21).size(), 21u);
    EXPECT_EQ(ask(9611, "$A077", 7), "#A077\r\n");
    gateway.signal(SIGKILL);
    gateway.wait();
  }
  halocline::testing::Process gateway(command);
  ASSERT_TRUE(wait_for_start()) << gateway.output();
  EXPECT_EQ(ask(9611, "$?", 13), "#A077V52429\r\n");
  EXPECT_EQ(ask(9612, "AT?L\nAT?AL\n", 6), "2\r\n7\r\n") << "as AT&W stored it";
  EXPECT_THAT(ask(9613, "$CCCFQ,SRC\r\n$CCCFQ,AGN\r\n", 34),
              ::testing::AllOf(HasSubstr("$CACFG,SRC,8*"), HasSubstr("$CACFG,AGN,77*")));
  EXPECT_EQ(ask(9614, ask_id, 21).substr(18), std::string("\x09\x10\x03"));
  ask(9612, "AT&F\n", 4);
  EXPECT_EQ(ask(9612, "AT?L\nAT?AL\n", 6), "0\r\n2\r\n");
}

TEST(GatewayProgram, TheLinkOfASerialLineIsGoneAfterEachEnd) {
  const halocline::testing::TemporaryFolder folder;
  std::ofstream("s.toml") << kFour;
  const auto pause = [] { std::this_thread::sleep_for(std::chrono::milliseconds(10)); };
  for (const int number : {SIGTERM, SIGINT, SIGHUP}) {
    halocline::testing::Process gateway({kProgram, "s.toml", "--modem-interface", "a=nm3:pty:line"});
    ASSERT_TRUE(work_until(pause, [] { return std::filesystem::exists("line"); }));
    gateway.signal(number);
    EXPECT_EQ(gateway.wait(), 0) << gateway.output();
    EXPECT_FALSE(std::filesystem::is_symlink("line")) << number;
  }
  halocline::testing::Process refused({kProgram, "s.toml", "--modem-interface", "a=nm3:pty:line",
                                       "--modem-interface", "b=nm3:pty:/nowhere/at/all"});
  EXPECT_EQ(refused.wait(), 2) << refused.output();
  EXPECT_FALSE(std::filesystem::is_symlink("line"));
}

// A buoy and a lander 750 m apart: the sound that one plays at an instant comes to the other half a second
// later.
TEST(GatewayProgram, CarriesSoundFromAModemOfWaveformsToAnother) {
  const halocline::testing::TemporaryFolder folder;
  std::ofstream("s.toml") << R"(
[scenario]
duration_s = 60
[terrain.flat]
depth_m = 200.0
[propagation]
model = "straight"
[[vehicle]]
name = "buoy"
id = 1
model = "fixed"
start_ned_m = [0.0, 0.0, 50.0]
[[vehicle]]
name = "lander"
id = 2
model = "fixed"
start_ned_m = [750.0, 0.0, 50.0]
[[modem_interface]]
vehicle = "buoy"
kind = "uasp2"
place = "tcp:9701"
[[modem_interface]]
vehicle = "lander"
kind = "uasp2"
place = "tcp:9702"
)";
  const std::string bin = HALOCLINE_BIN_DIR;
  halocline::testing::Process gateway({kProgram, "s.toml"}),
      vehicles({bin + "/halocline-vehicle-sim", "s.toml"}),
      conductor({bin + "/halocline-conductor", "s.toml"});
  const auto pause = [] { std::this_thread::sleep_for(std::chrono::milliseconds(10)); };
  ASSERT_TRUE(work_until(pause, [] { return Host("tcp:9701").is_open() && Host("tcp:9702").is_open(); }))
      << gateway.output();
  Host buoy("tcp:9701"), lander("tcp:9702");
  testing::DataPort port;
  acoustics::Samples heard{0, 96'000, {}};
  const auto listen = [&] {
    pause();
    port.take(heard);
  };
  const auto seconds = [&] { return static_cast<double>(heard.values.size()) / heard.rate_hz; };
  lander.write(port.istart());
  ASSERT_TRUE(work_until(listen, [&] { return seconds() > 0.5; })) << gateway.output();
  for (const std::string& line : testing::odata(testing::sweep(96'000, 0.1))) buoy.write(line);
  const double at_s = heard.begin_s + seconds() + 5;  // a busy machine carries it late
  buoy.write(testing::ostart(at_s));
  ASSERT_TRUE(work_until(listen, [&] { return heard.begin_s + seconds() > at_s + 0.8; }));
  const double noise = testing::rms({heard.values.begin(), heard.values.begin() + 48'000});
  const auto first = std::find_if(heard.values.begin(), heard.values.end(),
                                  [&](double value) { return std::abs(value) > 20 * noise; });
  ASSERT_NE(first, heard.values.end());
  const double delay_s = heard.begin_s + static_cast<double>(first - heard.values.begin()) / 96'000 - at_s;
  EXPECT_GT(delay_s, 750.0 / 1550);
  EXPECT_LT(delay_s, 750.0 / 1450);
  gateway.signal(SIGTERM);
  EXPECT_EQ(gateway.wait(), 0) << gateway.output();
}

}  // namespace
}  // namespace halocline::modem_gateway
