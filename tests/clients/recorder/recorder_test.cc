// SPDX-License-Identifier: BSD-3-Clause
// The real program on a bus of its own, whose publisher sends what it is told to.
#include <chrono>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <numeric>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bus/logs/flow_head.h"
#include "bus/logs/log_reader.h"
#include "bus/messages/channels.h"
#include "bus/runtime/node_process.h"
#include "bus/transport/transport.h"
#include "tests/bus/messages_for_tests.h"
#include "tests/integration/bus_listener.h"
#include "tests/support/process.h"
#include "tests/support/working_folder.h"

namespace halocline {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using testing::Process;

constexpr double kPatience_s = 60;  // of a busy machine

// A publisher whose network loses what it is told to.
class Publisher : public testing::BusListener {
 public:
  Publisher() : BusListener("publisher") {}
  enum class Way { kArrives, kIsLost };
  void publish(std::int64_t sequence, Way way = Way::kArrives) {
    auto state = bus::testing::valid_message<vehicle_state_t>(1);
    state.session = 4711;
    state.sequence = sequence;
    if (way == Way::kIsLost) bus_.set_outbox([](std::string_view, const void*, std::size_t) {});
    bus_.publish("STATE.a", state);
    bus_.set_outbox(nullptr);
    dispatch();
  }
};

class Recorder : public ::testing::Test {
 protected:
  [[nodiscard]] static std::unique_ptr<Process> run(std::vector<std::string> options) {
    options.insert(options.begin(), HALOCLINE_BIN_DIR "/halocline-recorder");
    return std::make_unique<Process>(options);
  }
  // One that records already.
  [[nodiscard]] std::unique_ptr<Process> started(const std::vector<std::string>& options) {
    auto recorder = run(options);
    EXPECT_TRUE(publisher_.listen_until(kPatience_s, [&] {
      return recorder->output().find("records to") != std::string::npos;
    })) << recorder->output();
    return recorder;
  }
  // Of the states in the log, in its order.
  static std::vector<std::int64_t> recorded(const std::string& path) {
    std::vector<std::int64_t> sequences;
    if (!std::filesystem::exists(path) || std::filesystem::is_empty(path)) return sequences;
    clients::LogReader log(path);
    const bus::FlowType type = bus::flow_type_of("STATE.a");
    for (clients::LoggedEvent event; log.next(event);) {
      const auto head = bus::flow_head(type, event.data);
      if (event.channel == "STATE.a" && head) sequences.push_back(head->sequence);
    }
    return sequences;
  }
  void expect_recorded(const std::string& path, std::int64_t count) {
    EXPECT_TRUE(publisher_.listen_until(
        kPatience_s, [&] { return recorded(path).size() >= static_cast<std::size_t>(count); }));
    std::vector<std::int64_t> expected(static_cast<std::size_t>(count));
    std::iota(expected.begin(), expected.end(), 0);
    EXPECT_THAT(recorded(path), ::testing::UnorderedElementsAreArray(expected));
  }
  // Its exit code, and its last line.
  static void expect_end(Process& recorder, int exit_code, const std::string& last) {
    recorder.signal(SIGTERM);
    EXPECT_EQ(recorder.wait(60s), exit_code) << recorder.output();
    EXPECT_THAT(recorder.output(), HasSubstr(last));
  }
  static std::string bytes_of(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  testing::TemporaryFolder folder_;
  Publisher publisher_;
  using Way = Publisher::Way;
};

TEST_F(Recorder, HasEveryMessageOnceThoughTheBusLosesEveryThird) {
  const auto recorder = started({"--log", "run.lcmlog"});
  for (int i = 0; i < 300; ++i) publisher_.publish(i, i % 3 == 2 ? Way::kIsLost : Way::kArrives);
  expect_recorded("run.lcmlog", 300);
  expect_end(*recorder, 0, "in run.lcmlog; it lacks none\n");
  clients::LogReader log("run.lcmlog");
  for (clients::LoggedEvent event; log.next(event);) {
    EXPECT_FALSE(event.channel.starts_with(bus::channels::kRepair.prefix)) << event.channel;
  }
}

TEST_F(Recorder, HasWhatWasPublishedLastBeforeItIsStopped) {
  const auto recorder = started({"--log", "run.lcmlog"});
  for (int i = 0; i < 20; ++i) publisher_.publish(i);
  expect_end(*recorder, 0, "it lacks none\n");
  EXPECT_EQ(recorded("run.lcmlog").size(), 20u);
  // Its own last words, too.
  clients::LogReader log("run.lcmlog");
  std::string last_status;
  for (clients::LoggedEvent event; log.next(event);) {
    if (event.channel.starts_with("STATUS.recorder"))
      last_status.assign(event.data.begin(), event.data.end());
  }
  EXPECT_THAT(last_status, HasSubstr("stopped; "));
}

TEST_F(Recorder, StampsAreTheWallTimesOfArrivalAndForeignBytesAreRecorded) {
  const std::int64_t before = bus::wall_now().to_utime();
  const auto recorder = started({"--log", "run.lcmlog"});
  lcm::LCM lcm(bus::effective_url(""));
  lcm.publish("of somebody", "abc", 3);
  lcm.publish("of somebody", "abc", 3);
  publisher_.publish(0);
  expect_recorded("run.lcmlog", 1);
  expect_end(*recorder, 0, "it lacks none\n");
  clients::LogReader log("run.lcmlog");
  int foreign = 0;
  for (clients::LoggedEvent event; log.next(event);) {
    EXPECT_GE(event.stamp_us, before);
    EXPECT_LE(event.stamp_us, bus::wall_now().to_utime());
    foreign += event.channel == "of somebody" && event.data.size() == 3 ? 1 : 0;
  }
  EXPECT_EQ(foreign, 2);
}

// A publisher that cannot repair.
TEST_F(Recorder, SaysHowManyMessagesOfWhomItLacks) {
  const auto recorder = started({"--log", "run.lcmlog"});
  publisher_.publish(0);
  expect_recorded("run.lcmlog", 1);
  lcm::LCM lcm(bus::effective_url(""));
  auto state = bus::testing::valid_message<vehicle_state_t>(1);
  state.session = 99;
  for (const std::int64_t sequence : {5, 9}) {
    state.sequence = sequence;
    lcm.publish("STATE.b", &state);
  }
  publisher_.publish(1);
  publisher_.listen_for(0.5);
  expect_end(*recorder, 3, "; it lacks 3: STATE.b 3\n");
}

TEST_F(Recorder, AfterAKillItGoesOnWithWhatWasPublishedMeanwhile) {
  const auto first = started({"--log", "run.lcmlog"});
  for (int i = 0; i < 10; ++i) publisher_.publish(i);
  expect_recorded("run.lcmlog", 10);
  first->signal(SIGKILL);
  first->wait();
  const std::string before = bytes_of("run.lcmlog");
  std::ofstream("run.lcmlog", std::ios::binary | std::ios::app) << before.substr(0, 40);  // cut short
  for (int i = 10; i < 20; ++i) publisher_.publish(i);
  const auto second = started({"--log", "run.lcmlog", "--append"});
  for (int i = 20; i < 30; ++i) publisher_.publish(i);
  expect_recorded("run.lcmlog", 30);
  expect_end(*second, 0, "it lacks none\n");
  EXPECT_TRUE(bytes_of("run.lcmlog").starts_with(before));
  clients::LogReader log("run.lcmlog");
  for (clients::LoggedEvent event; log.next(event);) {
  }
  EXPECT_TRUE(log.bad_stretches().empty());
}

TEST_F(Recorder, TwoOfThemHaveAll) {
  const auto one = started({"--log", "one.lcmlog"}), two = started({"--log", "two.lcmlog"});
  for (int i = 0; i < 100; ++i) publisher_.publish(i, i % 5 == 2 ? Way::kIsLost : Way::kArrives);
  for (const char* log : {"one.lcmlog", "two.lcmlog"}) expect_recorded(log, 100);
  expect_end(*one, 0, "it lacks none\n");
  expect_end(*two, 0, "it lacks none\n");
}

TEST_F(Recorder, NeverTouchesAFileThatItWasNotToldToReplace) {
  std::ofstream("notes.txt") << "no log";
  std::ofstream("sea.toml") << "[scenario]\nname = \"sea\"\n";
  std::filesystem::create_directory("folder");
  const std::vector<std::pair<std::vector<std::string>, std::string>> refusals{
      {{"--log", "notes.txt"}, "notes.txt is there already; --force replaces it, --append goes on behind it"},
      {{"--log", "notes.txt", "--append"}, "notes.txt"},
      {{"--log", "folder"}, "folder is no file that a log could be written to"},
      {{"--log", "nowhere/run.lcmlog"}, "cannot write the log nowhere/run.lcmlog: No such file or directory"},
      {{"--log", "new.lcmlog", "--force", "--append"}, "allowed is one of them"},
      {{"sea.toml", "--log", "./sea.toml", "--force"}, "./sea.toml is what is read"},
      {{}, "--log is missing"}};
  for (const auto& [options, reason] : refusals) {
    const auto recorder = run(options);
    EXPECT_EQ(recorder->wait(60s), 2) << recorder->output();
    EXPECT_THAT(recorder->output(), HasSubstr(reason));
  }
  EXPECT_EQ(bytes_of("notes.txt"), "no log");
  EXPECT_EQ(bytes_of("sea.toml"), "[scenario]\nname = \"sea\"\n");
}

TEST_F(Recorder, AFileThatAnotherOneWritesIsRefused) {
  const auto first = started({"--log", "run.lcmlog"});
  const auto second = run({"--log", "run.lcmlog", "--force"});
  EXPECT_EQ(second->wait(60s), 2);
  EXPECT_THAT(second->output(), HasSubstr("another recorder writes run.lcmlog"));
  publisher_.publish(0);
  expect_recorded("run.lcmlog", 1);
  expect_end(*first, 0, "it lacks none\n");
}

TEST_F(Recorder, AFullDiskIsReportedAndTheLogIsSoundUpToThere) {
  // A file of 64 blocks of 512 bytes at most.
  Process recorder({"/bin/dash", "-c", "trap '' XFSZ; ulimit -f 64; exec \"$0\" --log run.lcmlog",
                    HALOCLINE_BIN_DIR "/halocline-recorder"});
  ASSERT_TRUE(publisher_.listen_until(
      kPatience_s, [&] { return recorder.output().find("records to") != std::string::npos; }));
  int sequence = 0;
  ASSERT_TRUE(publisher_.listen_until(kPatience_s, [&] {
    publisher_.publish(sequence++);
    return recorder.output().find("log-refused") != std::string::npos;
  }));
  expect_end(recorder, 1, "; the disk refused ");
  EXPECT_GT(recorded("run.lcmlog").size(), 0u);
  clients::LogReader log("run.lcmlog");
  for (clients::LoggedEvent event; log.next(event);) {
  }
  EXPECT_TRUE(log.bad_stretches().empty());
}

TEST_F(Recorder, InLockstepTheConductorWritesTheLog) {
  const auto recorder = run({"--log", "run.lcmlog", "--time-source", "lockstep"});
  EXPECT_EQ(recorder->wait(60s), 2);
  EXPECT_THAT(recorder->output(), HasSubstr("in lockstep the conductor writes the log"));
}

}  // namespace
}  // namespace halocline
