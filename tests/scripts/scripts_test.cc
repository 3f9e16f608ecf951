// SPDX-License-Identifier: BSD-3-Clause
// What a person types, as far as it can be tried without building or installing anything.
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
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
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

std::string script(const std::string& name) { return std::string(HALOCLINE_SOURCE_DIR) + "/scripts/" + name; }

TEST(Isolated, PassesTheExitCodeAndTheArguments) {
  Process process({script("isolated"), "/bin/sh", "-c", "echo \"$1\"; exit 7", "sh", "two words"});
  EXPECT_EQ(process.wait(), 7);
  EXPECT_EQ(process.output(), "two words\n");
}

TEST(Isolated, PassesSignals) {
  Process process(
      {script("isolated"), "/bin/sh", "-c", "trap 'exit 5' TERM; echo ready; while :; do sleep 0.05; done"});
  while (process.output() != "ready\n" && process.running()) std::this_thread::sleep_for(5ms);
  process.signal(SIGTERM);
  EXPECT_EQ(process.wait(), 5);
}

TEST(Isolated, HasLoopbackWithMulticastAndNothingElse) {
  Process process({script("isolated"), "/bin/sh", "-c", "ip -o link; ip route"});
  EXPECT_EQ(process.wait(), 0);
  const std::string output = process.output();
  EXPECT_THAT(output, HasSubstr("MULTICAST"));
  EXPECT_THAT(output, HasSubstr("224.0.0.0/4 dev lo"));
  EXPECT_THAT(output, Not(HasSubstr("eth")));
}

TEST(Isolated, WithoutACommandItPrintsItsUse) {
  Process process({script("isolated")});
  EXPECT_EQ(process.wait(), 2);
  EXPECT_THAT(process.output(), HasSubstr("./scripts/isolated COMMAND"));
}

// Programs that build, install or start something: found first in PATH, each leaves its name in `called` and
// fails.
class Stubs {
 public:
  Stubs() {
    for (const char* program :
         {"cmake",      "ninja",   "ctest",   "g++",     "make",    "apt-get",         "apt",
          "dpkg-query", "sudo",    "npm",     "node",    "java",    "javac",           "lcm-gen",
          "lcm-logger", "doxygen", "gnuplot", "unshare", "nsenter", "clang-format-14", "run-clang-tidy-14",
          "slurmctld",  "sbatch",  "srun",    "tc",      "nft"}) {
      std::ofstream(folder_ + "/" + program)
          << "#!/bin/sh\necho " << program << " >>'" << folder_ << "/called'\nexit 99\n";
      std::filesystem::permissions(folder_ + "/" + program, std::filesystem::perms::owner_all);
    }
  }
  ~Stubs() { std::filesystem::remove_all(folder_); }
  Stubs(const Stubs&) = delete;
  Stubs& operator=(const Stubs&) = delete;

  [[nodiscard]] std::vector<std::string> before(const std::vector<std::string>& command) const {
    std::vector<std::string> all{"/usr/bin/env", "PATH=" + folder_ + ":" + std::getenv("PATH"),
                                 "HALOCLINE_BIN="};
    all.insert(all.end(), command.begin(), command.end());
    return all;
  }
  [[nodiscard]] std::string called() const {
    std::ifstream file(folder_ + "/called");
    return {std::istreambuf_iterator<char>(file), {}};
  }

 private:
  static std::string made() {
    std::string folder = ::testing::TempDir() + "halocline-stubs-" + std::to_string(getpid());
    std::filesystem::create_directories(folder);
    return folder;
  }
  std::string folder_ = made();
};

// Scripts of scripts/ and studies/; their folders hold modules of a script.
std::vector<std::string> all_scripts() {
  std::vector<std::string> paths;
  for (const char* folder : {HALOCLINE_SOURCE_DIR "/scripts", HALOCLINE_SOURCE_DIR "/studies"}) {
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      if (!entry.is_directory() && entry.path().extension() != ".md") paths.push_back(entry.path().string());
  }
  return paths;
}

TEST(Scripts, HelpIsTheFirstCommentOfEachAndStartsNothing) {
  const Stubs stubs;
  const std::vector<std::string> scripts = all_scripts();
  for (const std::string& path : scripts) {
    std::ifstream file(path);
    std::string interpreter, licence, first;
    std::getline(file, interpreter);
    std::getline(file, licence);
    std::getline(file, first);
    const bool python = interpreter.ends_with("python3");
    const std::string expected =
        first.substr(python ? std::string_view("\"\"\"").size() : std::string_view("# ").size());
    Process help(stubs.before({path, "--help"}));
    EXPECT_EQ(help.wait(), 0) << path;
    EXPECT_THAT(help.output(), StartsWith(expected + "\n")) << path;
    EXPECT_EQ(stubs.called(), "") << path;
  }
  EXPECT_GT(scripts.size(), 30u);
  for (const std::vector<std::string>& command :
       std::vector<std::vector<std::string>>{{"run", "scenarios/harbour.toml", "--help"},
                                             {"run", "--distributed", "--help"},
                                             {"run", "--help", "--distributed"},
                                             {"run", "scenarios/harbour.toml", "--slurm", "--help"}}) {
    std::vector<std::string> words = command;
    words[0] = script("run");
    Process help(stubs.before(words));
    EXPECT_EQ(help.wait(), 0);
    EXPECT_THAT(help.output(), HasSubstr("./scripts/run "));
    EXPECT_EQ(stubs.called(), "");
  }
}

// The stubs are found: what builds meets them.
TEST(Scripts, WithoutHelpTheBuildIsStarted) {
  const Stubs stubs;
  Process build(stubs.before({script("build"), "no-such-preset"}));
  EXPECT_NE(build.wait(), 0);
  EXPECT_EQ(stubs.called(), "cmake\n");
  std::filesystem::remove_all(HALOCLINE_SOURCE_DIR "/build/no-such-preset");
}

TEST(Scripts, ProgressIsShownEveryFourSecondsAndTheRestPassedOn) {
  const std::string lines = ". " + script("shell/progress") +
                            "; take() { case $1 in at*) text=$1 ;; *) pass_on \"$1\" ;; esac; }; "
                            "{ echo 'at 1'; sleep 1.5; printf 'at '; sleep 1; echo 2; echo 'an error'; sleep "
                            "3; } | show_progress start take";
  Process process({"/bin/bash", "-euo", "pipefail", "-c", lines});
  EXPECT_EQ(process.wait(), 0);
  EXPECT_EQ(process.output(), "an error\nat 2\n");
}

TEST(Scripts, AWrongWordIsAnErrorThatPrintsTheUse) {
  Process setup({script("setup"), "everything"});
  EXPECT_EQ(setup.wait(), 2);
  EXPECT_THAT(setup.output(), HasSubstr("Groups: build"));
  Process check({script("check"), "everything"});
  EXPECT_EQ(check.wait(), 2);
  EXPECT_THAT(check.output(), HasSubstr("./scripts/check [NAME...]"));
  Process distributed({script("run_distributed"), "scenarios/seamount.toml", "--nonsense"});
  EXPECT_EQ(distributed.wait(), 2);
  EXPECT_THAT(distributed.output(), HasSubstr("allowed are --duration S"));
}

TEST(Scripts, WithoutSlurmAJobIsRefusedWithWhatIsMissing) {
  const std::string folder = ::testing::TempDir() + "halocline-no-slurm-" + std::to_string(getpid());
  std::filesystem::create_directories(folder);
  for (const char* program : {"bash", "dirname", "sed"})
    std::filesystem::create_symlink(std::string("/usr/bin/") + program, folder + "/" + program);
  Process run({"/usr/bin/env", "PATH=" + folder, script("run"), "--slurm", "scenarios/seamount.toml"});
  EXPECT_EQ(run.wait(), 69);
  EXPECT_THAT(run.output(), HasSubstr("sbatch is not installed: SLURM (Debian: slurm-wlm) is needed"));
  std::filesystem::remove_all(folder);
}

// A run leaves its files in `folder`.
std::vector<std::string> in_folder(const std::string& folder, const std::vector<std::string>& command) {
  std::vector<std::string> all{"/usr/bin/env", "TMPDIR=" + folder, "HALOCLINE_BIN=" HALOCLINE_BIN_DIR};
  all.insert(all.end(), command.begin(), command.end());
  return all;
}

bool prints(const Process& process, const std::string& text) {
  const auto end = std::chrono::steady_clock::now() + kHangLimit;
  while (process.output().find(text) == std::string::npos && std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(20ms);
  return process.output().find(text) != std::string::npos;
}

std::string text_of(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<std::string> sections_of(const std::string& report) {
  std::vector<std::string> ids;
  const std::string start = "<section id=\"";
  for (std::size_t at = 0; (at = report.find(start, at)) != std::string::npos;) {
    at += start.size();
    ids.push_back(report.substr(at, report.find('"', at) - at));
  }
  return ids;
}

// Separate processes leave what `halocline run` leaves, and end with the same lines and the same page.
class DistributedReport : public ::testing::Test {
 protected:
  [[nodiscard]] Process distributed(std::vector<std::string> options) const {
    options.insert(options.begin(), {script("run_distributed"), kScenario});
    return Process(in_folder(here_, options));
  }
  // Its last lines, its report and its configuration.
  void expect_report(const Process& run, const std::string& log, const std::string& beside) {
    const std::string output = run.output();
    EXPECT_THAT(output, EndsWith("log         " + log + "\n" + after_log(output)));
    EXPECT_THAT(output, HasSubstr("\nalpha       went "));
    EXPECT_THAT(output, HasSubstr("\npackets     "));
    EXPECT_THAT(output, EndsWith("\nreport      " + beside + ".html\n"));
    const std::string report = text_of(beside + ".html");
    EXPECT_THAT(report, HasSubstr("<svg "));
    EXPECT_EQ(sections_of(report), sections_of(text_of(here_ + "/one/report.html")));
    EXPECT_THAT(text_of(beside + ".toml"), HasSubstr("name = \"two_vehicles\""));
  }

  void SetUp() override {
    Process one(
        {HALOCLINE_BIN_DIR "/halocline", "run", kScenario, "--out", here_ + "/one", "--no-csv", "--quiet"});
    ASSERT_EQ(one.wait(), 0) << one.output();
    ASSERT_EQ(sections_of(text_of(here_ + "/one/report.html")).size(), 9u);
  }

  static constexpr const char* kScenario = HALOCLINE_TEST_DATA "/scenarios/two_vehicles.toml";
  TemporaryFolder folder_;
  std::string here_ = std::filesystem::current_path().string();

 private:
  static std::string after_log(const std::string& output) {
    const auto at = output.find("\nlog         ");
    return at == std::string::npos ? "no line of the log" : output.substr(output.find('\n', at + 1) + 1);
  }
};

TEST_F(DistributedReport, PacedByTheWallClock) {
  Process run = distributed({"--duration", "8", "--rate", "4", "--log", here_ + "/run.lcmlog"});
  EXPECT_EQ(run.wait(), 0) << run.output();
  expect_report(run, here_ + "/run.lcmlog", here_ + "/run");
  Process again = distributed({"--log", here_ + "/run.lcmlog"});
  EXPECT_EQ(again.wait(), 2);
  EXPECT_THAT(again.output(), HasSubstr("run.lcmlog is there already; --force replaces it"));
  // The configuration beside the log is enough for a replay.
  Process replay(
      {HALOCLINE_BIN_DIR "/halocline", "replay", here_ + "/run.lcmlog", "--log", here_ + "/again.lcm"});
  EXPECT_EQ(replay.wait(), 0) << replay.output();
}

// The log is that of one process, byte for byte, so the page is too, but for the log's name.
TEST_F(DistributedReport, InLockstep) {
  Process run = distributed({"--lockstep", "--log", here_ + "/run.lcm"});
  EXPECT_EQ(run.wait(), 0) << run.output();
  expect_report(run, here_ + "/run.lcm", here_ + "/run");
  const std::string report = text_of(here_ + "/run.html");
  std::string one = text_of(here_ + "/one/report.html");
  const auto at = one.find(here_ + "/one/two_vehicles.lcm");
  ASSERT_NE(at, std::string::npos);
  one.replace(at, (here_ + "/one/two_vehicles.lcm").size(), here_ + "/run.lcm");
  EXPECT_TRUE(report == one);
}

TEST_F(DistributedReport, ALogMayLieBesideItsScenarioUnderItsName) {
  std::filesystem::copy_file(kScenario, "sea.toml");
  const auto beside = [&](const std::string& log) {
    return Process(in_folder(here_, {script("run_distributed"), here_ + "/sea.toml", "--duration", "2",
                                     "--lockstep", "--force", "--log", here_ + "/" + log}));
  };
  Process run = beside("sea.lcm");
  EXPECT_EQ(run.wait(), 0) << run.output();
  Process over = beside("sea.toml");
  EXPECT_EQ(over.wait(), 2);
  EXPECT_THAT(over.output(), HasSubstr("sea.toml is what is read"));
  EXPECT_EQ(text_of("sea.toml"), text_of(kScenario));
}

TEST_F(DistributedReport, WhatIsRefusedLeavesNothing) {
  const std::string modem = "family = \"own\"\nsource_level_db = 175\n";
  std::ofstream("modem.toml") << modem;
  std::ofstream("sea.toml")
      << "[scenario]\nname = \"sea\"\nduration_s = 2\n[modem]\nprofile = \"modem.toml\"\n"
         "[[vehicle]]\nname = \"a\"\nid = 1\nstart_ned_m = [0.0, 0.0, 20.0]\n";
  std::filesystem::create_directory("folder");
  const auto refused = [&](const std::string& log) {
    Process run(in_folder(
        here_, {script("run_distributed"), here_ + "/sea.toml", "--force", "--log", here_ + "/" + log}));
    EXPECT_EQ(run.wait(), 2) << run.output();
    return run.output();
  };
  EXPECT_THAT(refused("folder"), HasSubstr("folder is a folder; allowed is a file"));
  EXPECT_FALSE(std::filesystem::exists("folder.toml"));
  EXPECT_THAT(refused("modem.lcm"), HasSubstr("modem.toml is what is read"));
  EXPECT_EQ(text_of("modem.toml"), modem);
}

TEST_F(DistributedReport, CtrlCEndsItWithItsReportAnd130) {
  Process run = distributed({"--duration", "60", "--log", here_ + "/run.lcmlog"});
  ASSERT_TRUE(prints(run, "to join their bus")) << run.output();
  std::this_thread::sleep_for(2s);
  run.signal(SIGINT);
  EXPECT_EQ(run.wait(), 130) << run.output();
  EXPECT_THAT(run.output(), EndsWith("\nreport      " + here_ + "/run.html\n"));
}

TEST(JoinMissed, AVehicleOnABusWithoutARunReportsIt) {
  Process vehicle({script("isolated"), HALOCLINE_BIN_DIR "/foreign-vehicle", "--every", "1"});
  EXPECT_TRUE(prints(vehicle, "no CLOCK for 3 s: start this by ./scripts/join\n")) << vehicle.output();
}

TEST(Scripts, SetupIsSilentAndAsksNoRegistryWhenAllIsThere) {
  const TemporaryFolder folder;
  std::ofstream("apt-get") << "#!/bin/sh\necho asked\n";
  std::filesystem::permissions("apt-get", std::filesystem::perms::owner_all);
  const std::string path = std::filesystem::current_path().string() + ":" + std::getenv("PATH");
  Process setup({"/usr/bin/env", "PATH=" + path, script("setup"), "test"});
  EXPECT_EQ(setup.wait(), 0);
  EXPECT_EQ(setup.output(), "");
}

}  // namespace
}  // namespace halocline::testing
