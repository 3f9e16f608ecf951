// These tests write files, which is what a recorder is for: below the folder for temporary files, and removed.
#include "bus/log_recorder.h"

#include <filesystem>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bus/lockstep_runner.h"
#include "core/check.h"
#include "tests/bus/test_nodes.h"

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
  void record_run(const std::string& path) {
    lcm::LCM lcm("memq://");
    std::vector<std::string> journal;
    TickingNode a(lcm, "a", SimDuration::from_milliseconds(30), journal);
    TickingNode b(lcm, "b", SimDuration::from_milliseconds(70), journal);
    LockstepRunner runner(lcm, {&a, &b});
    LogRecorder recorder(lcm, path, [&] { return runner.now(); });
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
  lcm::LCM lcm("memq://");
  try {
    LogRecorder recorder(lcm, "/nowhere/at/all.lcmlog", [] { return SimTime(); });
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
  LockstepRunner runner(lcm, {&a});
  LogRecorder recorder(lcm, "/dev/full", [&] { return runner.now(); });
  runner.run_until(SimTime::from_seconds(3));
  EXPECT_THROW(recorder.close(), std::runtime_error);
}

TEST_F(LogRecorderTest, NothingIsWrittenAfterTheClose) {
  lcm::LCM lcm("memq://");
  LogRecorder recorder(lcm, path("log"), [] { return SimTime(); });
  recorder.close();
  lcm.publish("X", "abc", 3);
  lcm.handleTimeout(0);
  EXPECT_EQ(recorder.events(), 0);
  EXPECT_NO_THROW(recorder.close());
}

}  // namespace
}  // namespace halocline::bus
