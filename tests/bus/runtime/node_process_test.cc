// SPDX-License-Identifier: BSD-3-Clause
// Node programs as processes, on a private loopback bus (scripts/isolated; see tests/CMakeLists.txt).
#include "bus/runtime/node_process.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <random>
#include <string>
#include <string_view>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "bus/transport/transport.h"
#include "tests/bus/messages_for_tests.h"
#include "tests/support/process.h"

namespace halocline::bus {
namespace {

using namespace std::chrono_literals;
using halocline::testing::Process;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string kConductor = std::string(HALOCLINE_BIN_DIR) + "/halocline-conductor";

class NodeProcessTest : public ::testing::Test {
 protected:
  NodeProcessTest() {
    bus_.subscribe<sim_clock_t>("ANSWER", [this](const sim_clock_t& m) { answers_.push_back(m.sequence); });
    bus_.subscribe<sim_clock_t>(channels::kClock, [this](const sim_clock_t& m) { clocks_.push_back(m); });
    bus_.subscribe<node_status_t>(
        channels::kStatus, [this](std::string_view, const node_status_t& m) { statuses_.push_back(m); });
  }

  // Handles messages until `done`; false when nothing makes it so.
  bool listen_until(const std::function<bool()>& done) {
    const auto end = std::chrono::steady_clock::now() + halocline::testing::kHangLimit;
    while (!done()) {
      if (std::chrono::steady_clock::now() > end) return false;
      lcm_->handleTimeout(10);
    }
    return true;
  }
  bool receives_status_of(const std::string& node) {
    return listen_until([&] {
      return std::any_of(statuses_.begin(), statuses_.end(),
                         [&](const node_status_t& status) { return status.node_name == node; });
    });
  }
  void request(std::int64_t sequence) {
    sim_clock_t message = testing::valid_message<sim_clock_t>(1);
    message.sequence = sequence;
    bus_.publish("REQUEST", message);
  }

  std::unique_ptr<lcm::LCM> lcm_ = open_transport(effective_url(""));
  Bus bus_{*lcm_, {"listener", 1}};
  std::vector<std::int64_t> answers_;
  std::vector<sim_clock_t> clocks_;
  std::vector<node_status_t> statuses_;
};

TEST_F(NodeProcessTest, StoppedByASignalItHandlesWhatTheBusHasDeliveredAndPublishesAFinalStatus) {
  for (const int signal : {SIGTERM, SIGINT}) {
    answers_.clear();
    statuses_.clear();
    Process echo({HALOCLINE_ECHO_PROGRAM});
    ASSERT_TRUE(receives_status_of("echo")) << echo.output();
    constexpr std::int64_t kMessages = 400;
    for (std::int64_t i = 0; i < kMessages; ++i) request(i);
    echo.signal(signal);
    EXPECT_EQ(echo.wait(), 0) << echo.output();
    EXPECT_TRUE(listen_until([&] { return answers_.size() == kMessages; })) << answers_.size();
    EXPECT_TRUE(listen_until([&] { return statuses_.back().status_text == "stopped; echo"; }));
  }
}

// A step of an hour is left in its middle, long before the test gives up.
TEST_F(NodeProcessTest, ASignalEndsAStepThatTakesLong) {
  for (const int signal : {SIGTERM, SIGINT}) {
    answers_.clear();
    statuses_.clear();
    Process echo({HALOCLINE_ECHO_PROGRAM, "--set", "echo.work_s=3600"});
    ASSERT_TRUE(receives_status_of("echo")) << echo.output();
    request(1);
    ASSERT_TRUE(listen_until([&] { return answers_.size() == 1; }));
    echo.signal(signal);
    EXPECT_EQ(echo.wait(), 0) << echo.output();
    EXPECT_THAT(echo.output(), HasSubstr("stopped in the middle of a step"));
  }
}

TEST_F(NodeProcessTest, RandomBytesOnItsChannelsDoNotEndIt) {
  Process echo({HALOCLINE_ECHO_PROGRAM, "--log-level", "silent"});
  ASSERT_TRUE(receives_status_of("echo")) << echo.output();
  std::mt19937 random(5);
  for (int round = 0; round < 3000; ++round) {
    std::vector<std::uint8_t> bytes(random() % 300);
    for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
    static const char* const kChannels[] = {"REQUEST", "CLOCK", "STATE.a", "SEND.a"};
    lcm_->publish(kChannels[random() % 4], bytes.data(), static_cast<unsigned>(bytes.size()));
    if (round % 50 == 0) std::this_thread::sleep_for(1ms);
  }
  request(123);
  EXPECT_TRUE(listen_until([&] { return !answers_.empty(); }));
  EXPECT_TRUE(echo.running()) << echo.output();
  EXPECT_TRUE(listen_until([&] { return statuses_.back().messages_refused > 100; }));
}

// A restart takes about as long as the first start did: the shortest of a few, because a busy machine delays
// some.
TEST_F(NodeProcessTest, ARestartedConductorContinuesTheTimeOfTheOthersAsSoonAsItStarts) {
  const std::vector<std::string> command{kConductor, "--set", "time.rate=20", "--set",
                                         "time.clock_period_s=0.5"};
  Process echo({HALOCLINE_ECHO_PROGRAM});
  const auto started = std::chrono::steady_clock::now();
  auto conductor = std::make_unique<Process>(command);
  ASSERT_TRUE(listen_until([&] { return !clocks_.empty(); }));
  const auto first_start = std::chrono::steady_clock::now() - started;
  ASSERT_TRUE(listen_until([&] { return clocks_.back().utime > 10'000'000; }));
  auto shortest = std::chrono::steady_clock::duration::max();
  for (int restart = 0; restart < 5 && shortest >= 2 * first_start; ++restart) {
    while (lcm_->handleTimeout(0) > 0) {
    }
    const sim_clock_t last = clocks_.back();
    const auto killed = std::chrono::steady_clock::now();
    conductor->signal(SIGKILL);
    EXPECT_EQ(conductor->wait(), 128 + SIGKILL);
    const auto restarted = std::chrono::steady_clock::now();
    conductor = std::make_unique<Process>(command);
    ASSERT_TRUE(listen_until([&] { return clocks_.back().session != last.session; }));
    const auto now = std::chrono::steady_clock::now();
    shortest = std::min(shortest, now - restarted);
    const double away_s = std::chrono::duration<double>(now - killed).count();
    EXPECT_GE(clocks_.back().utime, last.utime);
    EXPECT_LT(static_cast<double>(clocks_.back().utime - last.utime), 20 * (away_s + 0.5) * 1e6);
  }
  EXPECT_LT(shortest, 2 * first_start);
  EXPECT_TRUE(echo.running());
}

TEST_F(NodeProcessTest, TwoSourcesOfTheSameProgramHaveSessionsOfTheirOwn) {
  Process one({HALOCLINE_ECHO_PROGRAM, "--name", "one"}), two({HALOCLINE_ECHO_PROGRAM, "--name", "two"});
  ASSERT_TRUE(receives_status_of("one"));
  ASSERT_TRUE(receives_status_of("two"));
  std::map<std::string, std::int64_t> sessions;
  for (const node_status_t& status : statuses_) sessions[status.node_name] = status.session;
  EXPECT_NE(sessions["one"], sessions["two"]);
}

std::string output_of(const std::vector<std::string>& command, int expected_exit_code) {
  Process process(command);
  EXPECT_EQ(process.wait(), expected_exit_code) << process.output();
  return process.output();
}

TEST(NodeCommandLine, HelpShowsAnExample) {
  EXPECT_THAT(output_of({kConductor, "--help"}, 0),
              AllOf(HasSubstr("Examples:\n  halocline-conductor scenarios/"), HasSubstr("69 the network")));
}

TEST(NodeCommandLine, InterfaceAndVersionArePrinted) {
  EXPECT_THAT(output_of({HALOCLINE_ECHO_PROGRAM, "--interface"}, 0), HasSubstr("publishes: ANSWER"));
  EXPECT_THAT(output_of({HALOCLINE_ECHO_PROGRAM, "--version"}, 0), HasSubstr("."));
}

TEST(NodeCommandLine, TheExampleIsAScenarioThatReads) {
  const std::string example = output_of({HALOCLINE_ECHO_PROGRAM, "--example"}, 0);
  EXPECT_THAT(example, HasSubstr("[echo]"));
  EXPECT_NO_THROW(ConfigFile::parse(example, "example"));
}

TEST(NodeCommandLine, PrintConfigShowsOverrides) {
  EXPECT_THAT(output_of({HALOCLINE_ECHO_PROGRAM, "--print-config", "--set", "echo.gain=3"}, 0),
              HasSubstr("gain = 3.0"));
}

TEST(NodeCommandLine, ANetworkThatCannotBeUsedHasAnExitCodeOfItsOwn) {
  const std::string output = output_of({"/usr/bin/unshare", "-n", HALOCLINE_ECHO_PROGRAM}, kExitNetwork);
  EXPECT_THAT(output, HasSubstr("scripts/isolated"));
}

// Processor time that the refusal of a scenario of so many vehicles takes, s.
double refusal_cost_s(int vehicles) {
  const std::string path = ::testing::TempDir() + "halocline-" + std::to_string(vehicles) + "-" +
                           std::to_string(getpid()) + ".toml";
  {
    std::ofstream scenario(path);
    for (int i = 1; i <= vehicles; ++i)
      scenario << "[[vehicle]]\nname = \"v" << i << "\"\nid = " << i << "\n";
  }
  Process conductor({kConductor, path});
  EXPECT_EQ(conductor.wait(), 2);
  EXPECT_THAT(conductor.output(), HasSubstr(":49154: vehicle[16384].name is 'v16385'"));
  std::filesystem::remove(path);
  return conductor.processor_s();
}

// Twice as many cost twice as much, not four times.
TEST(NodeCommandLine, TwentyThousandVehiclesAreRefusedWithTheLineOfTheFirstTooMany) {
  EXPECT_LT(refusal_cost_s(40'000) / refusal_cost_s(20'000), 3);
}

TEST(NodeCommandLine, OptionsOfLockstepNeedLockstep) {
  for (const std::vector<std::string>& given : {std::vector<std::string>{"--rate", "0.3"},
                                                {"--expect", "nobody"},
                                                {"--log", "a.lcm"},
                                                {"--journal", "a"},
                                                {"--drop-after", "x"},
                                                {"--no-lookahead"},
                                                {"--bridge-bus"}}) {
    std::vector<std::string> command{kConductor};
    command.insert(command.end(), given.begin(), given.end());
    EXPECT_THAT(output_of(command, 2), HasSubstr(given[0] + " needs --lockstep"));
  }
}

TEST(NodeCommandLine, LogAndJournalAreTwoFiles) {
  EXPECT_THAT(output_of({kConductor, "--lockstep", "--log", "same", "--journal", "./same"}, 2),
              HasSubstr("allowed are two files"));
}

TEST(NodeCommandLine, TheScenarioIsNeitherLogNorJournal) {
  const std::string path = ::testing::TempDir() + "halocline-read-" + std::to_string(getpid()) + ".toml";
  const std::string text = "[scenario]\nname = \"sea\"\n";
  std::ofstream(path) << text;
  for (const char* option : {"--log", "--journal"}) {
    EXPECT_THAT(output_of({kConductor, path, "--lockstep", option, path}, 2), HasSubstr("is what is read"));
    std::ifstream file(path);
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), text);
  }
  std::filesystem::remove(path);
}

TEST(NodeCommandLine, AScenarioWithoutEndIsRefused) {
  EXPECT_THAT(output_of({HALOCLINE_ECHO_PROGRAM, "/dev/zero"}, 2),
              HasSubstr("/dev/zero: cannot be read: it is a device; allowed is a regular file"));
  const std::string path = ::testing::TempDir() + "halocline-long-" + std::to_string(getpid()) + ".toml";
  std::ofstream(path).close();
  std::filesystem::resize_file(path, 65u << 20);
  EXPECT_THAT(output_of({HALOCLINE_ECHO_PROGRAM, path}, 2), HasSubstr(path + ": is longer than 64 MB"));
  std::filesystem::remove(path);
}

TEST(NodeCommandLine, AFullStandardOutputIsAFailure) {
  EXPECT_EQ(Process({"/bin/sh", "-c", HALOCLINE_ECHO_PROGRAM " --example >/dev/full"}).wait(), 1);
}

TEST(NodeCommandLine, EveryMistakeIsReportedWithExitCodeTwo) {
  EXPECT_THAT(output_of({HALOCLINE_ECHO_PROGRAM, "--nonsense"}, 2), HasSubstr("--help"));
  EXPECT_THAT(output_of({HALOCLINE_ECHO_PROGRAM, "/nowhere.toml"}, 2), HasSubstr("cannot be read"));
  EXPECT_THAT(output_of({HALOCLINE_ECHO_PROGRAM, "--set", "echo.gain=11", "--set", "time.rate='x'"}, 2),
              ::testing::AllOf(HasSubstr("echo.gain is 11"), HasSubstr("time.rate is 'x'")));
  EXPECT_THAT(output_of({HALOCLINE_ECHO_PROGRAM, "--time-source", "sundial"}, 2),
              HasSubstr("conductor, messages"));
  EXPECT_THAT(output_of({HALOCLINE_ECHO_PROGRAM, "--lcm-url", "tcpq://127.0.0.1:7700"}, 2),
              HasSubstr("udpm://"));
  EXPECT_THAT(output_of({HALOCLINE_ECHO_PROGRAM, "--name", "Not Valid"}, 2), HasSubstr("node name"));
  EXPECT_THAT(output_of({HALOCLINE_ECHO_PROGRAM, "--log-level", "loud"}, 2), HasSubstr("debug, info"));
}

TEST(NodeCommandLine, ControlCharactersOfArgumentsDoNotReachTheTerminal) {
  for (const char* argument : {"/\x1b[2J.toml", "--\x1b[2J"}) {
    EXPECT_THAT(output_of({HALOCLINE_ECHO_PROGRAM, argument}, 2),
                ::testing::AllOf(HasSubstr("?[2J"), ::testing::Not(HasSubstr("\x1b"))));
  }
}

}  // namespace
}  // namespace halocline::bus
