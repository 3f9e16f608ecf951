// SPDX-License-Identifier: BSD-3-Clause
#include "halocline/sweep/sweep_summary.h"

#include <limits>
#include <set>

#include "core/check.h"
#include "core/shared_module.h"
#include "runs/analysis/outcome_summary.h"
#include "runs/timeline/outcome_ledger.h"

namespace halocline::clients {
namespace {

Share share(std::int64_t count, std::int64_t of, double level) {
  return {count, of, wilson_interval(count, of, level)};
}

PointSummary summary_of(const std::vector<const RunMetrics*>& runs, double level) {
  PointSummary point;
  point.completed = runs.size();
  Delivered all;
  OutcomeCounts outcomes{};
  std::map<std::pair<std::string, std::string>, Delivered> pairs;
  std::int64_t all_outcomes = 0;
  for (const RunMetrics* run : runs) {
    all.packets += run->all.packets;
    all.received += run->all.received;
    for (std::size_t i = 0; i < kOutcomes; ++i) {
      outcomes[i] += run->outcomes[i];
      all_outcomes += run->outcomes[i];
    }
    for (const auto& [pair, delivered] : run->by_pair) {
      pairs[pair].packets += delivered.packets;
      pairs[pair].received += delivered.received;
    }
  }
  point.delivery = share(all.received, all.packets, level);
  for (std::size_t i = 0; i < kOutcomes; ++i) point.outcomes[i] = share(outcomes[i], all_outcomes, level);
  for (const auto& [pair, d] : pairs) point.delivery_by_pair[pair] = share(d.received, d.packets, level);
  for (std::size_t i = 0; i < kRunNumbers; ++i) {
    std::vector<double> values;
    for (const RunMetrics* run : runs) values.push_back(run->numbers[i]);
    point.numbers[i] = info_of(i).is_share ? share_estimate(values, level) : mean_estimate(values, level);
  }
  return point;
}

}  // namespace

double Share::value() const {
  return of > 0 ? static_cast<double>(count) / static_cast<double>(of)
                : std::numeric_limits<double>::quiet_NaN();
}

std::vector<std::pair<std::string, std::string>> SweepResults::pairs() const {
  std::set<std::pair<std::string, std::string>> all;
  for (const PointSummary& point : points) {
    for (const auto& [pair, delivery] : point.delivery_by_pair) all.insert(pair);
  }
  return {all.begin(), all.end()};
}

SweepResults summed_up(const SweepPlan& plan, std::vector<std::optional<RunMetrics>> runs,
                       std::vector<std::string> folders) {
  require(runs.size() == plan.runs() && folders.size() == plan.runs(),
          "a sweep has a result and a folder a run");
  SweepResults results{plan, std::move(runs), std::move(folders), {}};
  for (std::size_t point = 0; point < plan.points(); ++point) {
    std::vector<const RunMetrics*> done;
    for (std::size_t i = 0; i < plan.seeds.size(); ++i) {
      const auto& run = results.runs[point * plan.seeds.size() + i];
      if (run) done.push_back(&*run);
    }
    results.points.push_back(summary_of(done, plan.level));
  }
  return results;
}

void write_netcdf(const SweepResults& results, const std::string& path) {
  static const auto write = reinterpret_cast<NetcdfWriter*>(
      module_symbol("halocline_sweep_netcdf.so", "halocline_write_sweep_netcdf"));
  write(results, path);
}

}  // namespace halocline::clients
