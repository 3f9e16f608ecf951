// SPDX-License-Identifier: BSD-3-Clause
// The program by itself, on a private bus (scripts/isolated): doors of its command line, its trace, its end.
#include <chrono>
#include <csignal>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/clients/modem_gateway/host.h"
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

TEST(GatewayProgram, ServesDoorsOfItsCommandLineBeforeASimulationRuns) {
  const halocline::testing::TemporaryFolder folder;
  std::ofstream("s.toml") << "[[vehicle]]\nname = \"auv-1\"\nid = 1\n[[vehicle]]\nname = \"auv-2\"\nid = 2\n";
  halocline::testing::Process gateway({kProgram, "s.toml", "--door", "auv-1=nm3:tcp:9601", "--door",
                                       "auv-2=nm3:pty:line", "--trace", "trace.txt"});
  ASSERT_TRUE(work_until([] { std::this_thread::sleep_for(std::chrono::milliseconds(10)); },
                         [] { return Host("tcp:9601").is_open(); }));
  Host tcp("tcp:9601"), line("pty:line");
  tcp.write("$?");
  EXPECT_EQ(answer_of(tcp, 13), "#A001V52429\r\n");
  line.write("$?");
  EXPECT_EQ(answer_of(line, 13), "#A002V52429\r\n");
  gateway.signal(SIGTERM);
  EXPECT_EQ(gateway.wait(std::chrono::milliseconds(1000)), 0) << gateway.output();
  std::stringstream trace;
  trace << std::ifstream("trace.txt").rdbuf();
  EXPECT_THAT(trace.str(), HasSubstr("0.000000 auv-1 nm3 < $?\n0.000000 auv-1 nm3 > #A001V52429\\r\\n\n"));
}

TEST(GatewayProgram, NamesWhatIsWrongWithADoor) {
  const halocline::testing::TemporaryFolder folder;
  std::ofstream("s.toml") << "[[vehicle]]\nname = \"auv-1\"\nid = 1\n";
  for (const auto& [door, problem] : {std::pair("auv-9=nm3:tcp:9601", "there is no vehicle 'auv-9'"),
                                      {"auv-1=fax:tcp:9601", "kind of door 'fax'"},
                                      {"auv-1=nm3:udp:9601", "allowed are tcp:PORT"}}) {
    halocline::testing::Process gateway({kProgram, "s.toml", "--door", door});
    EXPECT_EQ(gateway.wait(), 2) << door;
    EXPECT_THAT(gateway.output(), HasSubstr(problem));
  }
}

}  // namespace
}  // namespace halocline::modem_gateway
