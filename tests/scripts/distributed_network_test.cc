// SPDX-License-Identifier: BSD-3-Clause
// A scenario with [network] as separate processes (scripts/run --distributed), which start halocline-network
// with the rest.
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/process.h"
#include "tests/support/working_folder.h"

namespace halocline {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using testing::Process;

std::string bytes_of(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

// Requests, warnings and waits of DACAP answer what modems notice within the instant, so over udpm they leave
// the log of one process as well, byte for byte, and with it the same outcomes.
TEST(DistributedNetwork, LeavesTheLogOfOneProcessInLockstep) {
  const testing::TemporaryFolder folder;
  const std::string here = std::filesystem::current_path().string();
  const std::string scenario = HALOCLINE_SOURCE_DIR "/scenarios/networks/hidden_terminals.toml";
  Process one({HALOCLINE_BIN_DIR "/halocline", "run", scenario, "--set", "scenario.duration_s=300", "--log",
               here + "/one.lcm", "--out", here + "/one", "--no-csv", "--quiet"});
  ASSERT_EQ(one.wait(), 0) << one.output();
  Process many({"/usr/bin/env", "TMPDIR=" + here, "HALOCLINE_BIN=" HALOCLINE_BIN_DIR,
                HALOCLINE_SOURCE_DIR "/scripts/run_distributed", scenario, "--lockstep", "--duration", "300",
                "--log", here + "/many.lcm"});
  EXPECT_EQ(many.wait(), 0) << many.output();
  EXPECT_THAT(many.output(), HasSubstr("halocline-network: process"));
  const std::string log = bytes_of(here + "/many.lcm");
  EXPECT_THAT(log, HasSubstr("NETWORK_EVENT.hub")) << "packets were delivered";
  EXPECT_TRUE(log == bytes_of(here + "/one.lcm"));
}

}  // namespace
}  // namespace halocline
