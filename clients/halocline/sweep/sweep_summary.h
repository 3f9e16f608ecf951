// SPDX-License-Identifier: BSD-3-Clause
// The results of a sweep, point by point, with confidence intervals.
//
// Shares of packets (delivery, outcomes) pool the packets of all seeds and carry Wilson's interval, which
// takes packets as independent; packets of one run share water and paths, so it is too narrow where runs
// differ much. The interval of the mean over runs (Student's t, and of shares one within 0 to 1:
// confidence.h; runs independent by their seeds) does not depend on that: compare the two.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "clients/halocline/analysis/confidence.h"
#include "clients/halocline/sweep/run_metrics.h"
#include "clients/halocline/sweep/sweep_plan.h"

namespace halocline::clients {

struct Share {
  std::int64_t count = 0, of = 0;
  ConfidenceInterval interval;  // Wilson's

  double value() const;  // NaN of none
};

struct PointSummary {
  std::size_t completed = 0;  // runs
  Share delivery;
  std::array<Share, kOutcomes> outcomes;
  std::map<std::pair<std::string, std::string>, Share> delivery_by_pair;
  std::array<MeanEstimate, kRunNumbers> numbers;  // over runs
};

struct SweepResults {
  SweepPlan plan;
  std::vector<std::optional<RunMetrics>> runs;  // by index; empty: failed, or not run yet
  std::vector<std::string> folders;             // likewise
  std::vector<PointSummary> points;

  // Sender and receiver of every pair in any run, in order.
  std::vector<std::pair<std::string, std::string>> pairs() const;
};

// `runs` and `folders` have plan.runs() elements.
SweepResults summed_up(const SweepPlan& plan, std::vector<std::optional<RunMetrics>> runs,
                       std::vector<std::string> folders);

// Tables in a folder: points.csv (a row a point), pairs.csv (a row a point and pair), runs.csv (a row a run).
// Each written whole, then moved into place. Throws std::runtime_error when one cannot be.
void write_csvs(const SweepResults& results, const std::string& folder);

// The same numbers as netCDF-4, by the CF conventions: a dimension an axis, then seed, outcome, pair and
// bound (low, high). A point without results holds NaN. The first call loads netCDF. Throws
// std::runtime_error.
void write_netcdf(const SweepResults& results, const std::string& path);

// What the module halocline_sweep_netcdf.so exports as halocline_write_sweep_netcdf.
using NetcdfWriter = void(const SweepResults& results, const std::string& path);

// For a person: a line a point.
void print(std::ostream& out, const SweepResults& results);

}  // namespace halocline::clients
