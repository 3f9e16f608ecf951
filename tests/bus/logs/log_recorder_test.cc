// SPDX-License-Identifier: BSD-3-Clause
// These tests write files, which is what a recorder is for: below the folder for temporary files, and
// removed.
#include "bus/logs/log_recorder.h"

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bus/logs/log_series.h"
#include "bus/runtime/lockstep_runner.h"
#include "core/check.h"
#include "tests/bus/runtime/test_nodes.h"
#include "tests/support/file_size_limit.h"

namespace halocline::bus {
namespace {

using testing::TickingNode;

class LogRecorderTest : public ::testing::Test {
 protected:
  LogRecorderTest()
      : folder_(std::filesystem::path(::testing::TempDir()) /
                ("halocline-log-" +
                 std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()))) {
    std::filesystem::create_directories(folder_);
  }
  ~LogRecorderTest() override { std::filesystem::remove_all(folder_); }

  std::string path(const char* name) const { return (folder_ / name).string(); }
  static std::string bytes_of(const std::string& path) {
    std::ostringstream bytes;
    bytes << std::ifstream(path, std::ios::binary).rdbuf();
    return bytes.str();
  }
  // Stamp, channel and data of each.
  static std::vector<std::tuple<std::int64_t, std::string, std::string>> events_of(const std::string& path) {
    std::vector<std::tuple<std::int64_t, std::string, std::string>> events;
    lcm::LogFile log(path, "r");
    while (const lcm::LogEvent* event = log.readNextEvent()) {
      const auto* data = static_cast<const char*>(event->data);
      events.emplace_back(event->timestamp, event->channel, std::string(data, data + event->datalen));
    }
    return events;
  }
  static LogRotation by_size(std::int64_t bytes, int kept = 0) { return {bytes, SimDuration(), kept}; }
  static void record_all(LockstepRunner& runner, LogRecorder& recorder) {
    runner.set_listener([&](SimTime at, std::string_view channel, std::span<const std::uint8_t> message) {
      recorder.record(at, channel, message);
    });
  }
  void record_run(const std::string& path, const LogRotation& rotation = {}) {
    lcm::LCM lcm("memq://");
    std::vector<std::string> journal;
    TickingNode a(lcm, "a", SimDuration::from_milliseconds(30), journal);
    TickingNode b(lcm, "b", SimDuration::from_milliseconds(70), journal);
    LockstepRunner runner({&a, &b});
    LogRecorder recorder(path, rotation);
    record_all(runner, recorder);
    runner.run_until(SimTime::from_seconds(5));
    runner.stop();
    recorder.close();
  }

  std::filesystem::path folder_;
};

TEST_F(LogRecorderTest, TwoRunsWriteTheSameBytes) {
  record_run(path("one"));
  record_run(path("two"));
  const std::string one = bytes_of(path("one"));
  EXPECT_GT(one.size(), 10'000u);
  EXPECT_EQ(one, bytes_of(path("two")));
}

TEST_F(LogRecorderTest, LcmReadsWhatWasWrittenWithSimulationTimes) {
  record_run(path("log"));
  lcm::LogFile log(path("log"), "r");
  ASSERT_TRUE(log.good());
  std::int64_t number = 0, latest = 0;
  while (const lcm::LogEvent* event = log.readNextEvent()) {
    EXPECT_EQ(event->eventnum, number++);
    EXPECT_GE(event->timestamp, latest);
    latest = event->timestamp;
    if (event->channel.rfind("TICK.", 0) != 0) continue;
    sim_clock_t clock;
    ASSERT_EQ(clock.decode(event->data, 0, event->datalen), event->datalen);
    EXPECT_EQ(clock.utime, event->timestamp);
  }
  EXPECT_EQ(latest, 5'000'000);
  EXPECT_GT(number, 230);  // 167 ticks and 72 ticks and statuses
}

TEST_F(LogRecorderTest, AFileThatCannotBeWrittenIsAnErrorThatNamesIt) {
  try {
    LogRecorder recorder("/nowhere/at/all.lcmlog");
    FAIL();
  } catch (const InvalidArgument& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("/nowhere/at/all.lcmlog"));
  }
}

TEST_F(LogRecorderTest, AFullDiskIsAnError) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  lcm::LCM lcm("memq://");
  std::vector<std::string> journal;
  TickingNode a(lcm, "a", SimDuration::from_milliseconds(1), journal);
  LockstepRunner runner({&a});
  LogRecorder recorder("/dev/full");
  record_all(runner, recorder);
  runner.run_until(SimTime::from_seconds(3));
  EXPECT_THROW(recorder.close(), std::runtime_error);
}

std::vector<std::uint8_t> bytes_of_size(std::size_t size) { return std::vector<std::uint8_t>(size, 7); }

TEST_F(LogRecorderTest, ItAppendsBehindWhatIsThere) {
  const std::vector<std::uint8_t> bytes = bytes_of_size(3);
  for (const LogStart start : {LogStart::kReplace, LogStart::kAppend}) {
    LogRecorder recorder(path("log"), {}, start);
    recorder.record(SimTime::from_utime(start == LogStart::kAppend ? 2 : 1), "A", bytes);
    recorder.close();
  }
  const auto events = events_of(path("log"));
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(std::get<0>(events[0]), 1);
  EXPECT_EQ(std::get<0>(events[1]), 2);
}

TEST_F(LogRecorderTest, WhatIsHandedOverIsInTheFileWhileItIsWritten) {
  LogRecorder recorder(path("log"));
  recorder.record(SimTime::from_utime(1), "A", bytes_of_size(3));
  recorder.flush();
  EXPECT_EQ(events_of(path("log")).size(), 1u);
}

// A batch that does not fit leaves nothing behind; the log goes on when there is room again.
TEST_F(LogRecorderTest, OfWhatTheDiskRefusesNoPartIsInTheLogAndItIsCounted) {
  LogRecorder recorder(path("log"));
  const auto record_batch = [&](std::int64_t utime, int events, std::size_t size) {
    for (int i = 0; i < events; ++i) recorder.record(SimTime::from_utime(utime), "A", bytes_of_size(size));
    recorder.flush();
  };
  record_batch(1, 3, 1000);
  {
    const halocline::testing::FileSizeLimit full(20'000);
    record_batch(2, 30, 1000);
    record_batch(3, 2, 1000);
  }
  record_batch(4, 2, 1000);
  EXPECT_THROW(recorder.close(), std::runtime_error);
  EXPECT_EQ(recorder.events_refused(), 30);
  std::vector<std::int64_t> stamps;
  for (const auto& event : events_of(path("log"))) stamps.push_back(std::get<0>(event));
  EXPECT_THAT(stamps, ::testing::ElementsAre(1, 1, 1, 3, 3, 4, 4));
}

TEST_F(LogRecorderTest, PartsPutTogetherAreTheLogInOnePiece) {
  record_run(path("whole.lcm"));
  record_run(path("cut.lcm"), by_size(5000));
  const auto parts = parts_of_log(path("cut.lcm"));
  ASSERT_GT(parts.size(), 3u);
  auto events = events_of(path("cut.lcm"));
  for (const std::string& part : parts) {
    EXPECT_LE(bytes_of(part).size(), 5000u);
    for (const auto& event : events_of(part)) events.push_back(event);
  }
  EXPECT_EQ(events, events_of(path("whole.lcm")));
}

TEST_F(LogRecorderTest, PartsBeginAtMultiplesOfTheirTime) {
  record_run(path("cut.lcm"), {0, SimDuration::from_seconds(2), 0});
  ASSERT_EQ(parts_of_log(path("cut.lcm")).size(), 2u);
  lcm::LogFile second(part_of_log(path("cut.lcm"), 1), "r");
  EXPECT_EQ(second.readNextEvent()->timestamp, 2'000'000);
}

TEST_F(LogRecorderTest, OnlyTheNewestPartsAreKept) {
  record_run(path("cut.lcm"), by_size(5000, 2));
  EXPECT_FALSE(std::filesystem::exists(path("cut.lcm")));
  EXPECT_EQ(parts_of_log(path("cut.lcm")).size(), 2u);
}

TEST_F(LogRecorderTest, AShorterLogLeavesNoPartOfALongerOne) {
  record_run(path("cut.lcm"), by_size(5000));
  record_run(path("cut.lcm"), by_size(100'000));
  EXPECT_TRUE(parts_of_log(path("cut.lcm")).empty());
}

TEST_F(LogRecorderTest, NamesThatOnlyLookLikePartsAreNone) {
  for (const char* name : {"cut.0001.txt", "cut.001.lcm", "cut.00x1.lcm", "other.0001.lcm", "cut.0002.lcm"})
    std::ofstream(path(name)) << "x";
  EXPECT_EQ(parts_of_log(path("cut.lcm")), (std::vector<std::string>{path("cut.0002.lcm")}));
}

TEST_F(LogRecorderTest, NothingIsWrittenAfterTheClose) {
  LogRecorder recorder(path("log"));
  recorder.close();
  recorder.record(SimTime(), "X", std::vector<std::uint8_t>{1, 2, 3});
  EXPECT_EQ(recorder.events(), 0);
  EXPECT_NO_THROW(recorder.close());
}

}  // namespace
}  // namespace halocline::bus
