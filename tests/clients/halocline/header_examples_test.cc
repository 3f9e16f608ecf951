// SPDX-License-Identifier: BSD-3-Clause
// The examples in the comments of the headers of clients/halocline/, compiled and run
// (tests/docs/check_examples).
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>
#include <vector>

#include <gtest/gtest.h>
#include <lcm/lcm-cpp.hpp>

#include "bus/runtime/lockstep_runner.h"
#include "clients/halocline/calc/calc.h"
#include "clients/halocline/plot/plot.h"
#include "clients/halocline/scenario/composition.h"
#include "clients/halocline/sweep/sweep_plan.h"
#include "core/sim_time.h"
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

TEST(HeaderExamples, Plot) {
  const halocline::testing::TemporaryFolder folder;
  const std::vector<double> delays{1.25, 1.5}, levels{-60, -71.5};
  Plot plot{.title = "Arrivals", .charts = {{.x = "delay, s", .y = "level, dB"}}};
  plot.charts[0].series.push_back({.title = "paths", .style = Series::kStems, .x = delays, .y = levels});
  write_plot(plot, "arrivals.svg");
  EXPECT_GT(std::filesystem::file_size("arrivals.svg"), 1000u);
}

TEST(HeaderExamples, Composition) {
  const halocline::testing::WorkingFolder folder(HALOCLINE_SOURCE_DIR);
  const ScenarioConfig config = load_scenario("scenarios/seamount.toml", {"modem.source_level_db=170"});
  lcm::LCM lcm("memq://");
  Composition all(lcm, config, Composition::kRun);
  bus::LockstepRunner runner(all.nodes());
  runner.run_until(SimTime::from_seconds(1.0));
  EXPECT_EQ(runner.now(), SimTime::from_seconds(1.0));
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
