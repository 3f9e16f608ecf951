// SPDX-License-Identifier: BSD-3-Clause
#include "halocline/sweep/sweep_plan.h"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "core/check.h"
#include "halocline/sweep/sweep_folder.h"

namespace halocline::clients {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(SweepAxis, ValuesAreSplitAtCommasOutsideOfQuotesAndBrackets) {
  const SweepAxis axis = parse_axis("modem.x=1, [2, 3],\"a,b\"");
  EXPECT_EQ(axis.key, "modem.x");
  EXPECT_THAT(axis.values, ElementsAre("1", "[2, 3]", "\"a,b\""));
}

TEST(SweepAxis, WhatIsNoneIsRefused) {
  for (const char* text : {"", "key", "=1", "key=", "key=1,,2", "key=1,1", "two words=1"})
    EXPECT_THROW(parse_axis(text), InvalidArgument) << text;
}

TEST(SweepSeeds, AreRangesAndNumbersEachOnce) {
  EXPECT_THAT(parse_seeds("3..5, 4, 1"), ElementsAre(1, 3, 4, 5));
  EXPECT_EQ(to_text(parse_seeds("3..5, 4, 1")), "1, 3..5");
  for (const char* text : {"", "5..3", "-1", "x", "1..", "1..99999999999"})
    EXPECT_THROW(parse_seeds(text), InvalidArgument) << text;
}

SweepPlan plan() {
  SweepPlan plan;
  plan.scenario = "harbour.toml";
  plan.axes = {{"a.x", {"1", "2"}}, {"b.y", {"\"p\"", "\"q\"", "\"r\""}}};
  plan.seeds = {7, 8};
  plan.overrides = {"c.z=0"};
  plan.duration_s = 20;
  return plan;
}

TEST(SweepPlan, RunsCoverEveryPointWithEverySeedOnce) {
  std::set<std::vector<std::string>> all;
  ASSERT_EQ(plan().runs(), 12u);
  for (std::size_t i = 0; i < 12; ++i) all.insert(run_of(plan(), i).overrides);
  EXPECT_EQ(all.size(), 12u);
  EXPECT_THAT(run_of(plan(), 0).overrides,
              ElementsAre("c.z=0", "a.x=1", "b.y=\"p\"", "scenario.duration_s=20", "scenario.seed=7"));
  EXPECT_THAT(run_of(plan(), 1).at, ElementsAre(0u, 0u));
  EXPECT_THAT(run_of(plan(), 2).at, ElementsAre(0u, 1u));
  EXPECT_THAT(run_of(plan(), 11).at, ElementsAre(1u, 2u));
}

TEST(SweepPlan, IsReadAsItWasWritten) {
  const std::string path = ::testing::TempDir() + "plan-" + std::to_string(getpid()) + ".toml";
  std::ofstream(path) << to_toml(plan());
  const SweepPlan read = load_plan(path);
  std::remove(path.c_str());
  EXPECT_EQ(read.runs(), 12u);
  for (std::size_t i = 0; i < 12; ++i) EXPECT_EQ(run_of(read, i).overrides, run_of(plan(), i).overrides);
  EXPECT_THAT(read.scenario.place(), ::testing::EndsWith("/harbour.toml"));
}

TEST(SweepPlan, AScenarioBehindALinkIsNamedAsTheSystemFindsIt) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::canonical(::testing::TempDir()) / "sweep-plan-link";
  fs::create_directories(folder / "real/deep");
  fs::create_directories(folder / "sweeps");
  fs::create_directory_symlink(folder / "real/deep", folder / "sweeps/link");
  SweepPlan plan;
  plan.scenario = (folder / "sweeps/link/../sea.toml").string();
  EXPECT_NE(to_toml(plan).find("\"" + (folder / "real/sea.toml").string() + "\""), std::string::npos);
  fs::remove_all(folder);
}

TEST(SweepPlan, AllErrorsOfAFileAreReportedTogether) {
  const std::string path = ::testing::TempDir() + "wrong-" + std::to_string(getpid()) + ".toml";
  std::ofstream(path)
      << "[sweep]\nscenario = \"x\"\nseeds = \"9..1\"\n[[axis]]\nkey = \"a\"\nvalues = \",\"\nextra = 1\n";
  try {
    load_plan(path);
    ADD_FAILURE();
  } catch (const InvalidArgument& error) {
    EXPECT_THAT(error.what(), HasSubstr(":3"));
    EXPECT_THAT(error.what(), HasSubstr(":6"));
    EXPECT_THAT(error.what(), HasSubstr("extra is unknown"));
  }
  std::remove(path.c_str());
}

TEST(SweepPlan, WithoutRunsOrWithTooManyIsRefused) {
  SweepPlan twice = plan(), huge = plan(), none = plan();
  twice.axes[1].key = "a.x";
  huge.seeds = parse_seeds("1..999999");
  none.seeds.clear();
  for (const SweepPlan& wrong : {twice, huge, none}) EXPECT_THROW(check(wrong), InvalidArgument);
  EXPECT_NO_THROW(check(plan()));
}

TEST(SweepFolder, ARunIsIdentifiedByWhatItComputes) {
  EXPECT_EQ(run_identity("a"), run_identity("a"));
  EXPECT_NE(run_identity("a"), run_identity("b"));
  EXPECT_EQ(run_identity("a").size(), 16u);
}

TEST(SweepFolder, AResultOfAnotherRunIsNone) {
  const std::string out = ::testing::TempDir() + "halocline-sweep-folder-" + std::to_string(getpid());
  const std::string one = run_folder(out, run_identity("one")),
                    other = run_folder(out, run_identity("other"));
  std::filesystem::create_directories(one);
  write_result(one, {});
  EXPECT_TRUE(result_in(one));
  std::filesystem::copy(one, other);
  EXPECT_FALSE(result_in(other));
  std::filesystem::remove_all(out);
}

TEST(SlurmScript, QuotesPathsForTheShell) {
  EXPECT_THAT(slurm_script("/opt/it's here/halocline", "/data", 3),
              HasSubstr("'/opt/it'\\''s here/halocline' sweep"));
  EXPECT_THAT(slurm_script("/bin/halocline", "/data", 3), HasSubstr("#SBATCH --array=0-2\n"));
}

}  // namespace
}  // namespace halocline::clients
