// SPDX-License-Identifier: BSD-3-Clause
// `halocline sweep` as a person starts it: every run done once, whatever stopped it before, on one machine or
// by a job array.
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/support/process.h"

namespace halocline {
namespace {

namespace fs = std::filesystem;
using halocline::testing::Process;
using ::testing::HasSubstr;

// The processes that have `text` in their command line, of this user and this machine.
std::vector<pid_t> processes_with(const std::string& text) {
  std::vector<pid_t> found;
  for (const auto& entry : fs::directory_iterator("/proc")) {
    const std::string name = entry.path().filename();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    std::ostringstream command;
    command << std::ifstream(entry.path() / "cmdline").rdbuf();
    if (command.str().find(text) != std::string::npos) found.push_back(std::stoi(name));
  }
  return found;
}

bool becomes_true(const std::function<bool()>& condition) {
  const auto end = std::chrono::steady_clock::now() + testing::kHangLimit;
  while (!condition() && std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  return condition();
}

class SweepCommand : public ::testing::Test {
 protected:
  ~SweepCommand() override { fs::remove_all(folder_); }

  std::vector<std::string> command(std::vector<std::string> more) const {
    std::vector<std::string> all{HALOCLINE_BIN_DIR "/halocline", "sweep"};
    all.insert(all.end(), more.begin(), more.end());
    all.insert(all.end(), {"--out", folder_});
    return all;
  }
  // Two winds with two seeds each.
  static std::vector<std::string> four_runs(const std::string& duration_s = "4") {
    return {HALOCLINE_TEST_DATA "/scenarios/two_vehicles.toml",
            "--axis",
            "environment.wind_mps=2,12",
            "--seeds",
            "1..2",
            "--duration",
            duration_s};
  }
  std::size_t results() const {
    std::size_t count = 0;
    std::error_code none;
    for (const auto& entry : fs::recursive_directory_iterator(folder_, none))
      count += entry.path().filename() == "result.json" ? 1 : 0;
    return count;
  }
  std::string text(const std::string& name) const {
    std::ostringstream all;
    all << std::ifstream(folder_ + "/" + name).rdbuf();
    return all.str();
  }

  std::string folder_ = ::testing::TempDir() + "halocline-sweep-command-" + std::to_string(getpid()) + "-" +
                        ::testing::UnitTest::GetInstance()->current_test_info()->name();
};

TEST_F(SweepCommand, DoesEveryRunOnceAndMakesTheTables) {
  Process first(command(four_runs()));
  ASSERT_EQ(first.wait(), 0) << first.output();
  EXPECT_EQ(results(), 4u);
  EXPECT_TRUE(fs::exists(folder_ + "/sweep.nc"));
  EXPECT_THAT(text("runs.csv"), HasSubstr("3,1,12,2,1,"));
  const std::string points = text("points.csv");
  Process again(command({}));  // its own plan, and nothing left to do
  ASSERT_EQ(again.wait(), 0) << again.output();
  EXPECT_THAT(again.output(), HasSubstr("4 runs, 0 to do here"));
  EXPECT_EQ(text("points.csv"), points);
}

TEST_F(SweepCommand, ADamagedResultIsDoneAgain) {
  Process first(command(four_runs()));
  ASSERT_EQ(first.wait(), 0) << first.output();
  const std::string points = text("points.csv");
  for (const auto& entry : fs::recursive_directory_iterator(folder_)) {
    if (entry.path().filename() != "result.json") continue;
    std::stringstream json;
    json << std::ifstream(entry.path()).rdbuf();
    std::string damaged = json.str();
    const std::size_t digit = damaged.find_first_of("123456789");
    ASSERT_NE(digit, std::string::npos);
    damaged[digit] = damaged[digit] == '9' ? '8' : '9';  // still JSON
    std::ofstream(entry.path()) << damaged;
    break;
  }
  Process again(command({}));
  ASSERT_EQ(again.wait(), 0) << again.output();
  EXPECT_THAT(again.output(), HasSubstr("4 runs, 1 to do here"));
  EXPECT_EQ(text("points.csv"), points);
}

TEST_F(SweepCommand, AChangedFileOfTheScenarioIsDoneAgain) {
  const std::string cast = folder_ + ".csv";
  std::vector<std::string> options = four_runs();
  options.insert(options.end(),
                 {"--set", "environment.profile=file", "--set", "environment.profile_file=" + cast});
  const auto done_with = [&](const std::string& speed_mps) {
    std::ofstream(cast) << "depth_m,sound_speed_mps\n0,1500\n200," << speed_mps << "\n";
    Process sweep(command(options));
    EXPECT_EQ(sweep.wait(), 0) << sweep.output();
    return sweep.output();
  };
  EXPECT_THAT(done_with("1490"), HasSubstr("4 runs, 4 to do here"));
  EXPECT_THAT(done_with("1490"), HasSubstr("4 runs, 0 to do here"));
  EXPECT_THAT(done_with("1510"), HasSubstr("4 runs, 4 to do here"));
  fs::remove(cast);
}

TEST_F(SweepCommand, MoreSeedsRunOnlyWhatIsNew) {
  Process first(command(four_runs()));
  ASSERT_EQ(first.wait(), 0) << first.output();
  Process more(command({"--seeds", "1..3"}));
  ASSERT_EQ(more.wait(), 0) << more.output();
  EXPECT_THAT(more.output(), HasSubstr("6 runs, 2 to do here"));
}

TEST_F(SweepCommand, AnInterruptedSweepGoesOn) {
  Process first(command(four_runs("100000")));  // longer than anyone waits
  ASSERT_TRUE(becomes_true([&] { return fs::exists(folder_ + "/runs"); })) << first.output();
  first.signal(SIGTERM);
  EXPECT_EQ(first.wait(), 1) << first.output();
  EXPECT_EQ(results(), 0u);
  Process rest(command({"--duration", "4"}));
  EXPECT_EQ(rest.wait(), 0) << rest.output();
  EXPECT_EQ(results(), 4u);
}

TEST_F(SweepCommand, ASweepThatIsKilledLeavesNoRunBehind) {
  auto words = four_runs("100000");
  words.insert(words.end(), {"--jobs", "2"});
  Process sweep(command(words));
  ASSERT_TRUE(becomes_true([&] { return processes_with(folder_ + "/runs/").size() == 2; })) << sweep.output();
  sweep.signal(SIGKILL);
  sweep.wait();
  EXPECT_TRUE(becomes_true([&] { return processes_with(folder_ + "/runs/").empty(); }));
}

TEST_F(SweepCommand, AFailedRunIsReportedAndStopsNoOther) {
  auto words = four_runs();
  // Unreadable as a log's folder: the run cannot write there.
  Process list(command([&] {
    auto all = words;
    all.emplace_back("--list");
    return all;
  }()));
  ASSERT_EQ(list.wait(), 0) << list.output();
  std::istringstream lines(list.output());
  std::string number, run_folder;
  lines >> number >> run_folder;
  fs::create_directories(run_folder + "/run.lcm");  // a folder where the log is to be
  Process sweep(command(words));
  EXPECT_EQ(sweep.wait(), 1);
  EXPECT_THAT(sweep.output(), HasSubstr("run 0 ("));
  EXPECT_THAT(sweep.output(), HasSubstr("1 of 4 runs have no result"));
  EXPECT_EQ(results(), 3u);
  EXPECT_THAT(text("runs.csv"), HasSubstr("0,0,2,1,0,"));
}

TEST_F(SweepCommand, AWrongValueIsReportedBeforeAnythingRuns) {
  auto words = four_runs();
  words[2] = "environment.wind_mps=2,1200";
  Process sweep(command(words));
  EXPECT_EQ(sweep.wait(), 2);
  EXPECT_THAT(sweep.output(), HasSubstr("wind_mps is 1200"));
  EXPECT_FALSE(fs::exists(folder_ + "/runs"));
}

TEST_F(SweepCommand, TheTasksOfAJobArrayDoAllRunsAndGatherMakesTheSameTables) {
  auto words = four_runs();
  const std::string script = folder_ + "-array.sh";
  words.insert(words.end(), {"--slurm", script, "--slurm-tasks", "3"});
  Process write(command(words));
  ASSERT_EQ(write.wait(), 0) << write.output();
  Process syntax({"/bin/bash", "-n", script});
  EXPECT_EQ(syntax.wait(), 0) << syntax.output();
  for (const char* task : {"0", "1", "2"}) {  // as sbatch calls it
    Process run({"/usr/bin/env", std::string("SLURM_ARRAY_TASK_ID=") + task, "SLURM_CPUS_PER_TASK=1",
                 "/bin/bash", script});
    EXPECT_EQ(run.wait(), 0) << text(std::string("slurm-") + task + ".txt");
  }
  EXPECT_EQ(results(), 4u);
  Process gather(command({"--gather"}));
  EXPECT_EQ(gather.wait(), 0) << gather.output();
  EXPECT_THAT(text("runs.csv"), HasSubstr("3,1,12,2,1,"));
  fs::remove(script);
}

// The real thing where it is installed (./scripts/setup test): a SLURM of one node in a namespace of its own.
TEST_F(SweepCommand, SlurmRunsTheJobArray) {
  if (!fs::exists("/usr/sbin/slurmctld") || getuid() != 0) GTEST_SKIP() << "needs slurm-wlm, and root";
  auto words = four_runs();
  const std::string script = folder_ + "-array.sh", scripts = HALOCLINE_SOURCE_DIR "/scripts/";
  words.insert(words.end(), {"--slurm", script, "--slurm-tasks", "3"});
  Process write(command(words));
  ASSERT_EQ(write.wait(), 0) << write.output();
  Process slurm({scripts + "isolated", scripts + "slurm_node", "/bin/bash", "-ec",
                 "sbatch --test-only \"$0\"; sbatch --wait \"$0\"", script});
  EXPECT_EQ(slurm.wait(), 0) << slurm.output();
  EXPECT_THAT(slurm.output(), HasSubstr("Submitted batch job"));
  EXPECT_EQ(results(), 4u);
  EXPECT_TRUE(fs::exists(folder_ + "/slurm-2.txt"));
  fs::remove(script);
}

}  // namespace
}  // namespace halocline
