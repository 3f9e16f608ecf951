// SPDX-License-Identifier: BSD-3-Clause
#include "halocline/sweep/sweep_summary.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netcdf.h>
#include <unistd.h>

namespace halocline::clients {
namespace {

class SweepSummaryTest : public ::testing::Test {
 protected:
  SweepSummaryTest() { std::filesystem::create_directories(folder_); }
  ~SweepSummaryTest() override { std::filesystem::remove_all(folder_); }

  static RunMetrics metrics(std::int64_t received, std::int64_t packets) {
    RunMetrics m;
    m.all = {packets, received};
    m.by_pair[{"a", "b"}] = m.all;
    m.outcomes[0] = received;
    m.outcomes[9] = packets - received;
    m[RunNumber::kDeliveryRatio] = static_cast<double>(received) / static_cast<double>(packets);
    return m;
  }
  // Two winds by two models, two seeds; the last run failed.
  static SweepResults results() {
    SweepPlan plan;
    plan.scenario = "harbour.toml";
    plan.axes = {{"environment.wind_mps", {"2", "12"}}, {"propagation.model", {"\"rays\"", "\"straight\""}}};
    plan.seeds = {1, 2};
    std::vector<std::optional<RunMetrics>> runs;
    for (int i = 0; i < 7; ++i) runs.emplace_back(metrics(i, 10));
    runs.emplace_back(std::nullopt);
    return summed_up(plan, std::move(runs), std::vector<std::string>(8, "folder"));
  }
  std::string folder_ = ::testing::TempDir() + "halocline-sweep-" + std::to_string(getpid());
};

TEST_F(SweepSummaryTest, PointsPoolTheirSeeds) {
  const SweepResults r = results();
  ASSERT_EQ(r.points.size(), 4u);
  EXPECT_EQ(r.points[1].delivery.count, 2 + 3);
  EXPECT_EQ(r.points[1].delivery.of, 20);
  EXPECT_NEAR(r.points[1].delivery.interval.low, wilson_interval(5, 20, 0.95).low, 1e-15);
  EXPECT_EQ(r.points[3].completed, 1u);
  EXPECT_TRUE(std::isnan(r.points[3].numbers[2].interval.low));
  EXPECT_DOUBLE_EQ(r.points[1].numbers[2].mean, 0.25);
  EXPECT_EQ(r.points[1].outcomes[9].count, 15);
}

TEST_F(SweepSummaryTest, TablesHaveARowAPointPairAndRun) {
  write_csvs(results(), folder_);
  for (const auto& [name, rows] : {std::pair("points.csv", 5), {"pairs.csv", 5}, {"runs.csv", 9}}) {
    std::ifstream file(folder_ + "/" + name);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), rows) << name;
  }
}

// A variable of doubles as netCDF gives it back.
std::vector<double> doubles(int file, const char* name, std::size_t count) {
  int variable = -1;
  EXPECT_EQ(nc_inq_varid(file, name, &variable), NC_NOERR) << name;
  std::vector<double> values(count);
  EXPECT_EQ(nc_get_var_double(file, variable, values.data()), NC_NOERR) << name;
  return values;
}

std::string text_attribute(int file, int variable, const char* name) {
  std::size_t length = 0;
  EXPECT_EQ(nc_inq_attlen(file, variable, name, &length), NC_NOERR) << name;
  std::string text(length, ' ');
  EXPECT_EQ(nc_get_att_text(file, variable, name, text.data()), NC_NOERR);
  return text;
}

TEST_F(SweepSummaryTest, NetcdfHoldsTheGridWithUnitsByItsConventions) {
  const SweepResults r = results();
  write_netcdf(r, folder_ + "/sweep.nc");
  int file = -1, variable = -1, dimensions = 0;
  ASSERT_EQ(nc_open((folder_ + "/sweep.nc").c_str(), NC_NOWRITE, &file), NC_NOERR);
  EXPECT_EQ(text_attribute(file, NC_GLOBAL, "Conventions"), "CF-1.8");
  EXPECT_EQ(doubles(file, "environment_wind_mps", 2), (std::vector<double>{2, 12}));
  ASSERT_EQ(nc_inq_varid(file, "environment_wind_mps", &variable), NC_NOERR);
  EXPECT_EQ(text_attribute(file, variable, "units"), "m s-1");
  ASSERT_EQ(nc_inq_varid(file, "delivery_ratio_of_run", &variable), NC_NOERR);
  ASSERT_EQ(nc_inq_varndims(file, variable, &dimensions), NC_NOERR);
  EXPECT_EQ(dimensions, 3);
  const auto runs = doubles(file, "delivery_ratio_of_run", 8);
  EXPECT_DOUBLE_EQ(runs[6], 0.6);
  EXPECT_TRUE(std::isnan(runs[7]));
  const auto intervals = doubles(file, "delivery_share_interval", 8);
  EXPECT_DOUBLE_EQ(intervals[2], r.points[1].delivery.interval.low);
  EXPECT_DOUBLE_EQ(intervals[3], r.points[1].delivery.interval.high);
  EXPECT_DOUBLE_EQ(doubles(file, "pair_delivery_share", 4)[1], 0.25);
  nc_close(file);
}

TEST_F(SweepSummaryTest, AFileThatCannotBeWrittenIsAnError) {
  EXPECT_THROW(write_netcdf(results(), "/nowhere/sweep.nc"), std::runtime_error);
  EXPECT_THROW(write_csvs(results(), "/nowhere"), std::runtime_error);
}

}  // namespace
}  // namespace halocline::clients
