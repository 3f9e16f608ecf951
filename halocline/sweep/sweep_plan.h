// SPDX-License-Identifier: BSD-3-Clause
// Plan of a sweep: a scenario at every point of a grid of overrides, each with every seed.
//
//   [sweep]
//   scenario = "seamount.toml"            # from this file's folder
//   seeds = "1..20"
//   duration_s = 120                      # 0: the scenario's
//   [[axis]]
//   key = "environment.wind_mps"
//   values = "2, 6, 12"                   # as in --set
//   [[set]]
//   override = "modem.source_level_db=170"  # at every point
//
// Runs are numbered from 0. Seeds vary fastest, then the last axis.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bus/config/config.h"
#include "core/files/file_path.h"

namespace halocline::clients {

// Values of one key of the scenario.
struct SweepAxis {
  std::string key;                  // key of the scenario: section.key
  std::vector<std::string> values;  // values as TOML text
};

// Grid of axes, seeds and overrides for one scenario.
struct SweepPlan {
  static constexpr std::size_t kMaxRuns = 1'000'000;

  FilePath scenario;
  std::vector<SweepAxis> axes;
  std::vector<std::int64_t> seeds{1};
  std::vector<std::string> overrides;  // applied at every point
  double duration_s = 0;               // 0: the scenario's duration
  double level = 0.95;                 // level of confidence of intervals

  std::size_t points() const;
  std::size_t runs() const { return points() * seeds.size(); }
};

struct SweepRun {
  std::size_t index = 0, point = 0;
  std::vector<std::size_t> at;  // index of the value on each axis
  std::int64_t seed = 1;
  std::vector<std::string> overrides;  // all overrides, including those for seed and duration
};

// Returns the run with that index, which must be below plan.runs().
SweepRun run_of(const SweepPlan& plan, std::size_t index);

// Parses "environment.wind_mps=2,6,12"; commas within quotes and brackets do not separate values. Throws
// InvalidArgument.
SweepAxis parse_axis(const std::string& text);
// Parses "1..20" or "1,5,9..12" as ascending, distinct seeds from 0 to 9e15. Throws InvalidArgument.
std::vector<std::int64_t> parse_seeds(const std::string& text);
std::string to_text(const std::vector<std::int64_t>& seeds);

// Throws InvalidArgument for a plan without runs, with too many runs, or with an axis twice.
void check(const SweepPlan& plan);

void visit(bus::ConfigVisitor& v, SweepPlan& plan);
// Reads the plan in a file. Throws bus::ConfigErrors.
SweepPlan load_plan(const std::string& path);
// Returns the plan as a file that is valid in any folder.
std::string to_toml(const SweepPlan& plan);

}  // namespace halocline::clients
