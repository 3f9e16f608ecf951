// SPDX-License-Identifier: BSD-3-Clause
// Runs over several hosts as jobs of SLURM (scripts/run --slurm), with network namespaces as hosts
// (scripts/slurm_node). Each case runs inside a network namespace of its own (scripts/isolated).
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <regex>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/support/process.h"
#include "tests/support/working_folder.h"

namespace halocline::testing {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

std::string script(const std::string& name) { return std::string(HALOCLINE_SOURCE_DIR) + "/scripts/" + name; }

template <class Condition>
bool comes_true(Condition condition) {
  const auto end = std::chrono::steady_clock::now() + kHangLimit;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(20ms);
  }
  return true;
}

// A SLURM of two hosts, in the folder of the test, which ends with it.
class RunSlurm : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists("/usr/sbin/slurmctld") || getuid() != 0) GTEST_SKIP() << "needs slurm-wlm, and root";
    fs::copy(HALOCLINE_TEST_DATA "/scenarios/two_vehicles.toml", scenario_);
    slurm_ = std::make_unique<Process>(std::vector<std::string>{
        script("slurm_node"), "--nodes", "2", "/bin/sh", "-c",
        "echo \"$SLURM_CONF\" >made && mv made conf && while [ ! -e stop ]; do sleep 0.1; done"});
    ASSERT_TRUE(comes_true([&] { return fs::exists("conf"); })) << slurm_->output();
    std::getline(std::ifstream("conf"), conf_);
  }
  void TearDown() override {
    if (!slurm_) return;
    std::ofstream("stop") << "\n";
    EXPECT_EQ(slurm_->wait(), 0) << slurm_->output();
  }

  [[nodiscard]] std::unique_ptr<Process> started(const std::vector<std::string>& command) const {
    std::vector<std::string> all{"/usr/bin/env", "TMPDIR=" + here_, "SLURM_CONF=" + conf_,
                                 "HALOCLINE_BIN=" HALOCLINE_BIN_DIR};
    all.insert(all.end(), command.begin(), command.end());
    return std::make_unique<Process>(all);
  }
  [[nodiscard]] std::unique_ptr<Process> run(const std::vector<std::string>& options) const {
    std::vector<std::string> all{script("run"), "--slurm", scenario_};
    all.insert(all.end(), options.begin(), options.end());
    return started(all);
  }
  std::string output_of(const std::vector<std::string>& command) const {
    const auto process = started(command);
    EXPECT_EQ(process->wait(), 0) << process->output();
    return process->output();
  }
  [[nodiscard]] std::string log(const std::string& name) const { return here_ + "/" + name; }

  // The log of `halocline run` with so many channel servers and blocks of vehicles.
  [[nodiscard]] std::string log_of_one_process(int parts) const {
    const std::string count = std::to_string(parts);
    Process one({HALOCLINE_BIN_DIR "/halocline", "run", scenario_, "--set", "channel_server.shards=" + count,
                 "--set", "vehicle_sim.blocks=" + count, "--out", here_ + "/one", "--no-csv", "--quiet"});
    EXPECT_EQ(one.wait(), 0) << one.output();
    return text_of(here_ + "/one/two_vehicles.lcm");
  }
  static std::string text_of(const std::string& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  struct Program {
    pid_t pid = 0;
    std::string host;
  };
  // What `run` printed of its programs, once it has printed it of all.
  static std::map<std::string, Program> programs_of(const Process& run, std::size_t count) {
    static const std::regex line("halocline-([a-z0-9/-]+): process ([0-9]+) on (host-[12])\n");
    std::map<std::string, Program> programs;
    comes_true([&] {
      const std::string output = run.output();
      for (std::sregex_iterator match(output.begin(), output.end(), line), end; match != end; ++match)
        programs[(*match)[1]] = {std::stoi((*match)[2]), (*match)[3]};
      return programs.size() >= count;
    });
    EXPECT_EQ(programs.size(), count) << run.output();
    return programs;
  }
  static bool is_running(pid_t pid) { return kill(pid, 0) == 0; }

  TemporaryFolder folder_;
  std::string here_ = fs::current_path().string(), scenario_ = here_ + "/two_vehicles.toml", conf_;
  std::unique_ptr<Process> slurm_;
};

TEST_F(RunSlurm, TwoHostsInLockstepWriteTheLogOfOneProcess) {
  const auto run = this->run({"--hosts", "2", "--lockstep", "--log", log("run.lcm")});
  EXPECT_EQ(run->wait(), 0) << run->output();
  EXPECT_TRUE(text_of("run.lcm") == log_of_one_process(1));
  EXPECT_THAT(run->output(), HasSubstr("\nreport      " + here_ + "/run.html\n"));
  EXPECT_FALSE(fs::exists("run.lcm.journal"));
}

TEST_F(RunSlurm, ChannelServersAndVehiclesAreSpreadOverTheHostsAndAllOthersAreOnTheFirst) {
  const auto run = this->run({"--shards", "2", "--blocks", "2", "--duration", "40", "--log",
                              log("run.lcmlog"), "--partition", "main"});
  const auto programs = programs_of(*run, 10);
  for (const auto& [name, program] : programs) {
    const bool on_second = name == "channel-server/0/2" || name == "vehicle-sim/1/2";
    EXPECT_EQ(program.host, on_second ? "host-2" : "host-1") << name;
    const std::string addresses =
        output_of({"/usr/bin/nsenter", "-n", "-t", std::to_string(program.pid), "ip", "-o", "-4", "address"});
    EXPECT_THAT(addresses, HasSubstr(on_second ? " 10.77.0.12/24" : " 10.77.0.11/24")) << name;
  }
  run->signal(SIGTERM);
  EXPECT_EQ(run->wait(), 0) << run->output();
}

TEST_F(RunSlurm, AKilledProcessIsStartedAgainOnItsHostAndTheLogIsTheSame) {
  const auto run =
      this->run({"--shards", "2", "--blocks", "2", "--lockstep", "--rate", "2", "--log", log("run.lcm")});
  const auto programs = programs_of(*run, 9);
  std::this_thread::sleep_for(1s);
  for (const char* name : {"channel-server/0/2", "vehicle-sim/1/2"}) {
    kill(programs.at(name).pid, SIGKILL);
    const std::string restart = std::string(name) + " ended with exit code 137 on host-2; starting it again";
    EXPECT_TRUE(comes_true([&] { return run->output().find(restart) != std::string::npos; }))
        << run->output();
  }
  EXPECT_EQ(run->wait(), 0) << run->output();
  EXPECT_TRUE(text_of("run.lcm") == log_of_one_process(2));
}

TEST_F(RunSlurm, TwoJobsOnTheSameHostsDoNotReceiveEachOther) {
  const std::vector<std::string> options{"--lockstep", "--rate", "2", "--log"};
  std::vector<std::unique_ptr<Process>> runs;
  for (const char* name : {"first.lcm", "second.lcm"}) {
    auto words = options;
    words.push_back(log(name));
    runs.push_back(run(words));
  }
  for (const auto& run : runs) programs_of(*run, 7);
  EXPECT_TRUE(runs[0]->running() && runs[1]->running()) << "one after the other: not much of a test";
  for (const auto& run : runs) EXPECT_EQ(run->wait(), 0) << run->output();
  const std::string one = log_of_one_process(1);
  EXPECT_TRUE(text_of("first.lcm") == one);
  EXPECT_TRUE(text_of("second.lcm") == one);
}

TEST_F(RunSlurm, SigtermCancelsTheJobAndLeavesNoProcess) {
  const auto run = this->run({"--duration", "100", "--log", log("run.lcmlog")});
  const auto programs = programs_of(*run, 8);
  std::this_thread::sleep_for(3s);
  run->signal(SIGTERM);
  EXPECT_EQ(run->wait(), 0) << run->output();
  for (const auto& [name, program] : programs) EXPECT_FALSE(is_running(program.pid)) << name;
  EXPECT_EQ(output_of({"/usr/bin/squeue", "--noheader"}), "");
  EXPECT_THAT(run->output(), HasSubstr("\nalpha       went "));
  EXPECT_THAT(run->output(), HasSubstr("\nreport      " + here_ + "/run.html\n"));
}

TEST_F(RunSlurm, CtrlCCancelsTheJobWithExitCode130) {
  const auto run = this->run({"--duration", "100", "--lockstep", "--rate", "1", "--log", log("run.lcm")});
  const auto programs = programs_of(*run, 7);
  std::this_thread::sleep_for(2s);
  run->signal(SIGINT);
  EXPECT_EQ(run->wait(), 130) << run->output();
  for (const auto& [name, program] : programs) EXPECT_FALSE(is_running(program.pid)) << name;
}

TEST_F(RunSlurm, AJobThatIsNotWaitedForWritesItsLogOnALossyNetworkToo) {
  for (const char* host : {"--nodelist=host-1", "--nodelist=host-2"})
    output_of({"/usr/bin/srun", host, "--nodes=1", script("lose"), "5", "eth0"});
  const auto run = this->run({"--no-wait", "--lockstep", "--log", log("run.lcm")});
  EXPECT_EQ(run->wait(), 0) << run->output();
  EXPECT_EQ(run->output(), "job 3; its output: " + here_ + "/run.txt; scancel 3 ends it\n");
  EXPECT_TRUE(comes_true([&] { return output_of({"/usr/bin/squeue", "--noheader"}).empty(); }));
  EXPECT_TRUE(text_of("run.lcm") == log_of_one_process(1)) << text_of("run.txt");
}

TEST_F(RunSlurm, AJobCancelledBySlurmEndsWithAReadableLogAndExitCode1) {
  const auto run = this->run({"--duration", "100", "--lockstep", "--rate", "1", "--log", log("run.lcm")});
  const auto programs = programs_of(*run, 7);
  std::this_thread::sleep_for(3s);
  output_of({"/usr/bin/scancel", "1"});
  EXPECT_EQ(run->wait(), 1) << run->output();
  for (const auto& [name, program] : programs) EXPECT_FALSE(is_running(program.pid)) << name;
  EXPECT_THAT(run->output(), HasSubstr("\nalpha       went "));
  EXPECT_THAT(run->output(), HasSubstr("job 1: CANCELLED; its output: " + here_ + "/run.txt\n"));
}

TEST_F(RunSlurm, AHostThatFailsEndsTheJobAndLeavesNoProcess) {
  const auto run = this->run({"--duration", "100", "--log", log("run.lcmlog")});
  const auto programs = programs_of(*run, 8);
  const std::string status =
      text_of("/proc/" + std::to_string(programs.at("channel-server").pid) + "/status");
  kill(std::stoi(status.substr(status.find("PPid:") + 5)), SIGKILL);
  EXPECT_EQ(run->wait(), 1) << run->output();
  EXPECT_THAT(run->output(), HasSubstr("the other hosts ended with exit code 137\n"));
  EXPECT_THAT(run->output(), HasSubstr("job 1: FAILED; its output: "));
  for (const auto& [name, program] : programs) EXPECT_FALSE(is_running(program.pid)) << name;
}

TEST_F(RunSlurm, HostsThatDoNotReceiveEachOtherEndTheJobWithTheReason) {
  output_of({"/usr/bin/srun", "--nodelist=host-2", "--nodes=1", script("lose"), "100", "eth0"});
  const auto run = this->run({"--lockstep", "--log", log("run.lcm")});
  EXPECT_EQ(run->wait(), 1) << run->output();
  EXPECT_THAT(run->output(), HasSubstr("host-2 and host 0 do not receive each other's UDP multicast"));
  EXPECT_THAT(run->output(), HasSubstr(": FAILED; its output: "));
}

TEST_F(RunSlurm, WhatIsWrongIsReportedBeforeAJobIsSubmitted) {
  const std::map<std::vector<std::string>, std::string> expected{
      {{"--hosts", "3"}, "--hosts is '3'; allowed is 1 to 2"},
      {{"--hosts", "0"}, "--hosts is '0'; allowed is 1 to 2"},
      {{"--hosts"}, "--hosts needs a value"},
      {{"--shards", "65"}, "--shards is '65'; allowed is 1 to 64"},
      {{"--nodes=2"}, "--nodes=2 is not for sbatch here"},
      {{"--partition=reef"}, "invalid partition specified: reef"},
      {{"--set", "scenario.seed=3"}, "sbatch: unrecognized option '--set'"},
      {{"--distributed"}, "allowed is one of --distributed and --slurm"}};
  for (const auto& [options, problem] : expected) {
    auto words = options;
    words.insert(words.begin(), {"--log", log("run.lcm")});
    const auto run = this->run(words);
    EXPECT_GT(run->wait(), 0) << problem;
    EXPECT_THAT(run->output(), HasSubstr(problem));
    EXPECT_FALSE(fs::exists("run.toml")) << problem;
  }
  EXPECT_EQ(output_of({"/usr/bin/squeue", "--noheader", "--states=all"}), "");
  Process missing(
      {"/usr/bin/env", "HALOCLINE_BIN=" HALOCLINE_BIN_DIR, script("run"), "--slurm", "no-such.toml"});
  EXPECT_EQ(missing.wait(), 2);
  EXPECT_THAT(missing.output(), HasSubstr("no-such.toml: cannot be read: there is no such file"));
}

}  // namespace
}  // namespace halocline::testing
