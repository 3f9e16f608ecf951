// SPDX-License-Identifier: BSD-3-Clause
// The examples in the comments of the headers of runs/, compiled and run (tests/docs/check_examples).
#include <filesystem>
#include <vector>

#include <gtest/gtest.h>

#include "runs/plot/plot.h"
#include "tests/support/working_folder.h"

namespace halocline::clients {
namespace {

TEST(HeaderExamples, Plot) {
  const halocline::testing::TemporaryFolder folder;
  const std::vector<double> delays{1.25, 1.5}, levels{-60, -71.5};
  Plot plot{.title = "Arrivals", .charts = {{.x = "delay, s", .y = "level, dB"}}};
  plot.charts[0].series.push_back({.title = "paths", .style = Series::kStems, .x = delays, .y = levels});
  write_plot(plot, "arrivals.svg");
  EXPECT_GT(std::filesystem::file_size("arrivals.svg"), 1000u);
}

}  // namespace
}  // namespace halocline::clients
