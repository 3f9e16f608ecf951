// SPDX-License-Identifier: BSD-3-Clause
// The vehicles of clients/examples in their languages: built and started by the commands in their own first
// comments, each joins a run on a private bus, sends a packet that a simulated vehicle receives, and receives
// one.
#include <algorithm>
#include <cctype>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/process.h"
#include "tests/support/working_folder.h"

namespace halocline::testing {
namespace {

using namespace std::chrono_literals;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string kSource = HALOCLINE_SOURCE_DIR;

std::string text_of(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

// The lines of a file's first comment that begin with a prompt.
std::vector<std::string> commands_in(const std::string& path) {
  std::ifstream file(path);
  std::vector<std::string> commands;
  for (std::string line; std::getline(file, line);) {
    const auto prompt = line.find("   $ ");
    if (prompt != std::string::npos) commands.push_back(line.substr(prompt + 5));
  }
  return commands;
}

bool prints(const Process& process, const std::string& text) {
  const auto end = std::chrono::steady_clock::now() + halocline::testing::kHangLimit;
  while (process.output().find(text) == std::string::npos && std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(20ms);
  return process.output().find(text) != std::string::npos;
}

class ForeignVehicle : public ::testing::TestWithParam<const char*> {
 protected:
  ForeignVehicle() {
    for (const char* folder : {"lcmtypes", "clients", "scripts"})
      std::filesystem::create_directory_symlink(kSource + "/" + folder, folder);
  }
  // As typed at the root of the tree. The run leaves its files, and scripts/join finds them, in this folder.
  [[nodiscard]] Process shell(const std::string& command) const {
    return Process(
        {"/usr/bin/env", "TMPDIR=" + here_, "HALOCLINE_BIN=" HALOCLINE_BIN_DIR, "/bin/bash", "-c", command});
  }

  TemporaryFolder folder_;
  std::string here_ = std::filesystem::current_path().string();
};

TEST_P(ForeignVehicle, JoinsARunAndExchangesPacketsWithASimulatedVehicle) {
  std::vector<std::string> commands = commands_in(kSource + "/clients/examples/" + GetParam());
  ASSERT_GE(commands.size(), 2u);
  const std::string start = commands.back() + " --depth 30 --every 1.3";
  commands.pop_back();
  for (const std::string& command : commands) {
    Process build = shell(command);
    ASSERT_EQ(build.wait(), 0) << command << "\n" << build.output();
  }
  Process run = shell("exec scripts/run_distributed " HALOCLINE_TEST_DATA
                      "/scenarios/two_vehicles.toml --duration 90 --log run.lcmlog");
  ASSERT_TRUE(prints(run, "to join their bus: ./scripts/join")) << run.output();
  Process vehicle = shell(start);
  // Its modem is the one that it has announced: 0.1 s and 20 bytes at 640 bit/s.
  EXPECT_TRUE(prints(vehicle, "packet 0 accepted, receipt 0, 0.350 s long\n")) << vehicle.output();
  EXPECT_TRUE(prints(vehicle, " at vehicle 1: received\n")) << vehicle.output();
  EXPECT_TRUE(prints(vehicle, " s: from vehicle 2, ")) << vehicle.output();
  EXPECT_THAT(vehicle.output(), Not(HasSubstr("no CLOCK")));
  run.signal(SIGTERM);
  EXPECT_EQ(run.wait(), 0) << run.output();
  // What was sent is what came: "hello " at vehicle 1 from vehicle 77.
  Process exported =
      shell(HALOCLINE_BIN_DIR
            "/halocline log export run.lcmlog --out csv --channel 'RECEIVE\\.alpha|STATE\\.visitor'");
  ASSERT_EQ(exported.wait(), 0) << exported.output();
  EXPECT_THAT(text_of("csv/receive.csv"),
              ContainsRegex("RECEIVE.alpha,[^\n]*,77,1,1,[^\n]*,68656c6c6f20[0-9a-f]*\n"));
  EXPECT_THAT(text_of("csv/state.csv"), ContainsRegex("STATE.visitor,[^\n]*,77,"));
}

INSTANTIATE_TEST_SUITE_P(Languages, ForeignVehicle,
                         ::testing::Values("c/foreign_vehicle.c", "cpp/foreign_vehicle.cc",
                                           "java/ForeignVehicle.java", "lua/foreign_vehicle.lua",
                                           "python/foreign_vehicle.py"),
                         [](const auto& vehicle) {
                           const std::string file = vehicle.param;
                           return file.substr(0, file.find('/'));
                         });

// The constants of the message up to the first that is none of an outcome, in their order.
std::vector<std::string> words_of_outcomes() {
  std::ifstream file(kSource + "/lcmtypes/packet_outcome_t.lcm");
  std::vector<std::string> words;
  for (std::string line; std::getline(file, line);) {
    std::istringstream fields(line);
    std::string keyword, type, name, equals, value;
    if (!(fields >> keyword >> type >> name >> equals >> value) || keyword != "const") continue;
    if (value != std::to_string(words.size()) + ";") break;
    for (char& c : name) c = c == '_' ? ' ' : static_cast<char>(std::tolower(c));
    words.push_back(name);
  }
  return words;
}

TEST_P(ForeignVehicle, HasAWordForEachOutcome) {
  const std::vector<std::string> words = words_of_outcomes();
  ASSERT_GE(words.size(), 18u);
  const std::string text = text_of(kSource + "/clients/examples/" + GetParam());
  std::size_t at = text.find("by the number in packet_outcome_t");
  ASSERT_NE(at, std::string::npos);
  const std::string list = text.substr(text.find('"', at), text.find_first_of("})", at) - text.find('"', at));
  std::vector<std::string> listed;
  for (std::size_t begin = 0; (begin = list.find('"', begin)) != std::string::npos;) {
    const std::size_t end = list.find('"', begin + 1);
    listed.push_back(list.substr(begin + 1, end - begin - 1));
    begin = end + 1;
  }
  EXPECT_EQ(listed, words);
}

TEST_P(ForeignVehicle, StaysBelowTwoHundredLines) {
  const std::string text = text_of(kSource + "/clients/examples/" + GetParam());
  EXPECT_LT(std::count(text.begin(), text.end(), '\n'), 200);
}

}  // namespace
}  // namespace halocline::testing
