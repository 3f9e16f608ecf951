// SPDX-License-Identifier: BSD-3-Clause
// Results of a sweep, point by point, with confidence intervals.
//
// Proportions of packets (delivery, outcomes) pool the packets of all seeds and have Wilson's interval, which
// assumes independent packets. Packets of one run share water and paths, so this interval is too narrow when
// runs differ much. The interval of the mean over runs (Student's t, or for proportions an interval within 0
// to 1, confidence.h) only assumes that runs with different seeds are independent: compare the two.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "halocline/sweep/run_metrics.h"
#include "halocline/sweep/sweep_plan.h"
#include "runs/analysis/confidence.h"

namespace halocline::clients {

// Proportion of packets.
struct Share {
  std::int64_t count = 0, of = 0;
  ConfidenceInterval interval;  // Wilson's interval

  double value() const;  // NaN when `of` is 0
};

// Results at one point of the grid.
struct PointSummary {
  std::size_t completed = 0;  // number of completed runs
  Share delivery;
  std::array<Share, kOutcomes> outcomes;
  std::map<std::pair<std::string, std::string>, Share> delivery_by_pair;
  std::array<MeanEstimate, kRunNumbers> numbers;  // means over runs
};

struct SweepResults {
  SweepPlan plan;
  std::vector<std::optional<RunMetrics>> runs;  // indexed by run; empty: failed, or not run yet
  std::vector<std::string> folders;             // folder of each run
  std::vector<PointSummary> points;

  // Returns sender and receiver of every pair in any run, sorted.
  std::vector<std::pair<std::string, std::string>> pairs() const;
};

// Computes the points. `runs` and `folders` must have plan.runs() elements.
SweepResults summed_up(const SweepPlan& plan, std::vector<std::optional<RunMetrics>> runs,
                       std::vector<std::string> folders);

// Writes tables into a folder: points.csv (one row per point), pairs.csv (one row per point and pair),
// runs.csv (one row per run). Each is written completely, then moved into place. Throws std::runtime_error
// when one cannot be written.
void write_csvs(const SweepResults& results, const std::string& folder);

// Writes the same numbers as netCDF-4 after the CF conventions: one dimension for each axis, then seed,
// outcome, pair and bound (low, high). A point without results holds NaN. The first call loads netCDF. Throws
// std::runtime_error.
void write_netcdf(const SweepResults& results, const std::string& path);

// Type of the function that the module halocline_sweep_netcdf.so exports as halocline_write_sweep_netcdf.
using NetcdfWriter = void(const SweepResults& results, const std::string& path);

// Prints one line for each point.
void print(std::ostream& out, const SweepResults& results);

}  // namespace halocline::clients
