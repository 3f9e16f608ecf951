// SPDX-License-Identifier: BSD-3-Clause
// The examples in the comments of the headers of halocline/, compiled and run
// (tests/docs/check_examples).
#include <fstream>
#include <iostream>
#include <sstream>

#include <gtest/gtest.h>

#include "halocline/calc/calc.h"
#include "halocline/sweep/sweep_plan.h"
#include "tests/support/working_folder.h"

namespace halocline::clients {
namespace {

TEST(HeaderExamples, Calc) {
  std::ostringstream printed;
  std::streambuf* const to_console = std::cout.rdbuf(printed.rdbuf());
  std::istringstream in("T_degC,S_ppt,depth_m\n25,35,1000\n");
  const int code = run_calc({.quantity = "sound-speed"}, in, std::cout, std::cerr);
  std::cout.rdbuf(to_console);
  EXPECT_EQ(code, kCalcDone);
  EXPECT_EQ(printed.str(), "T_degC,S_ppt,depth_m,c_m_per_s\n25,35,1000,1550.7440275\n");
}

TEST(HeaderExamples, SweepPlan) {
  const halocline::testing::TemporaryFolder folder;
  std::ofstream("plan.toml") << R"(
[sweep]
scenario = "seamount.toml"            # from this file's folder
seeds = "1..20"
duration_s = 120                      # 0: the scenario's
[[axis]]
key = "environment.wind_mps"
values = "2, 6, 12"                   # as in --set
[[set]]
override = "modem.source_level_db=170"  # at every point
)";
  EXPECT_EQ(load_plan("plan.toml").runs(), 60u);
}

}  // namespace
}  // namespace halocline::clients
