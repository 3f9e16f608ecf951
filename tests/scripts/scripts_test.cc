// What a person types, as far as it can be tried without building or installing anything.
#include <csignal>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/process.h"

namespace halocline::testing {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

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
  EXPECT_THAT(output, ::testing::Not(HasSubstr("eth")));
}

TEST(Isolated, WithoutACommandItTellsItsUse) {
  Process process({script("isolated")});
  EXPECT_EQ(process.wait(), 2);
  EXPECT_THAT(process.output(), HasSubstr("./scripts/isolated COMMAND"));
}

TEST(Scripts, AWrongWordIsAnErrorThatTellsTheUse) {
  Process setup({script("setup"), "everything"});
  EXPECT_EQ(setup.wait(), 2);
  EXPECT_THAT(setup.output(), HasSubstr("Groups: build"));
  Process check({script("check"), "everything"});
  EXPECT_EQ(check.wait(), 2);
  EXPECT_THAT(check.output(), HasSubstr("./scripts/check [format]"));
  Process distributed({script("run_distributed"), "scenarios/seamount.toml", "--nonsense"});
  EXPECT_EQ(distributed.wait(), 2);
  EXPECT_THAT(distributed.output(), HasSubstr("allowed are --duration S"));
}

TEST(Scripts, SetupIsSilentAndQuickWhenAllIsThere) {
  const auto start = std::chrono::steady_clock::now();
  Process setup({script("setup"), "build"});
  EXPECT_EQ(setup.wait(), 0);
  EXPECT_EQ(setup.output(), "");
  EXPECT_LT(std::chrono::steady_clock::now() - start, 3s);  // 0.05 s on an idle machine
}

}  // namespace
}  // namespace halocline::testing
