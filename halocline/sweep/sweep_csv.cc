// SPDX-License-Identifier: BSD-3-Clause
// Output of a sweep's results as CSV tables.
#include <cmath>
#include <ostream>
#include <sstream>

#include <fmt/ostream.h>

#include "core/atomic_file.h"
#include "core/csv_table.h"
#include "halocline/sweep/run_metrics.h"
#include "halocline/sweep/sweep_plan.h"
#include "halocline/sweep/sweep_summary.h"
#include "runs/analysis/confidence.h"

namespace halocline::clients {
namespace {

// Returns the cell of a value; empty for NaN.
std::string cell(double value) { return std::isnan(value) ? "" : format_number(value); }

std::string column(std::string name) {
  for (char& c : name) c = c == ' ' || c == '-' ? '_' : c;
  return name;
}

void write_axes(std::ostream& out, const SweepResults& results, std::size_t point) {
  const SweepRun run = run_of(results.plan, point * results.plan.seeds.size());
  for (std::size_t i = 0; i < run.at.size(); ++i)
    out << ',' << csv_cell(results.plan.axes[i].values[run.at[i]]);
}

void name_axes(std::ostream& out, const SweepResults& results) {
  for (const SweepAxis& axis : results.plan.axes) out << ',' << axis.key;
}

void write_share(std::ostream& out, const Share& share) {
  out << ',' << share.count << ',' << share.of << ',' << cell(share.value()) << ','
      << cell(share.interval.low) << ',' << cell(share.interval.high);
}

void write_points(std::ostream& out, const SweepResults& results) {
  out << "point";
  name_axes(out, results);
  out << ",runs,level,received,addressed,delivery_share,delivery_wilson_low,delivery_wilson_high";
  for (std::size_t i = 0; i < kRunNumbers; ++i) {
    const std::string name = info_of(i).name;
    out << ',' << name << "_mean," << name << "_t_low," << name << "_t_high";
  }
  for (std::size_t outcome = 0; outcome < kOutcomes; ++outcome) {
    const std::string name = column(outcome_name(outcome));
    out << ',' << name << ',' << name << "_share," << name << "_wilson_low," << name << "_wilson_high";
  }
  out << "\n";
  for (std::size_t p = 0; p < results.points.size(); ++p) {
    const PointSummary& point = results.points[p];
    out << p;
    write_axes(out, results, p);
    out << ',' << point.completed << ',' << format_number(results.plan.level);
    write_share(out, point.delivery);
    for (const MeanEstimate& number : point.numbers)
      out << ',' << cell(number.mean) << ',' << cell(number.interval.low) << ','
          << cell(number.interval.high);
    for (const Share& outcome : point.outcomes)
      out << ',' << outcome.count << ',' << cell(outcome.value()) << ',' << cell(outcome.interval.low) << ','
          << cell(outcome.interval.high);
    out << "\n";
  }
}

void write_pairs(std::ostream& out, const SweepResults& results) {
  out << "point";
  name_axes(out, results);
  out << ",from,to,received,addressed,delivery_share,delivery_wilson_low,delivery_wilson_high\n";
  for (std::size_t p = 0; p < results.points.size(); ++p) {
    for (const auto& [pair, delivery] : results.points[p].delivery_by_pair) {
      out << p;
      write_axes(out, results, p);
      out << ',' << pair.first << ',' << pair.second;
      write_share(out, delivery);
      out << "\n";
    }
  }
}

void write_runs(std::ostream& out, const SweepResults& results) {
  out << "run,point";
  name_axes(out, results);
  out << ",seed,completed,folder,simulated_s";
  for (std::size_t i = 0; i < kRunNumbers; ++i) out << ',' << info_of(i).name;
  out << "\n";
  for (std::size_t i = 0; i < results.runs.size(); ++i) {
    const SweepRun run = run_of(results.plan, i);
    const auto& metrics = results.runs[i];
    out << i << ',' << run.point;
    write_axes(out, results, run.point);
    out << ',' << run.seed << ',' << (metrics ? 1 : 0) << ',' << csv_cell(results.folders[i]) << ','
        << (metrics ? cell(metrics->simulated_s) : "");
    for (std::size_t n = 0; n < kRunNumbers; ++n) out << ',' << (metrics ? cell(metrics->numbers[n]) : "");
    out << "\n";
  }
}

std::string text_of(const SweepResults& results, void (*write)(std::ostream&, const SweepResults&)) {
  std::ostringstream text;
  write(text, results);
  return text.str();
}

}  // namespace

void write_csvs(const SweepResults& results, const std::string& folder) {
  replace_file(folder + "/points.csv", text_of(results, write_points));
  replace_file(folder + "/pairs.csv", text_of(results, write_pairs));
  replace_file(folder + "/runs.csv", text_of(results, write_runs));
}

void print(std::ostream& out, const SweepResults& results) {
  for (std::size_t p = 0; p < results.points.size(); ++p) {
    const PointSummary& point = results.points[p];
    const SweepRun run = run_of(results.plan, p * results.plan.seeds.size());
    for (std::size_t i = 0; i < run.at.size(); ++i)
      out << results.plan.axes[i].key << "=" << results.plan.axes[i].values[run.at[i]] << " ";
    const MeanEstimate& ratio = point.numbers[static_cast<std::size_t>(RunNumber::kDeliveryRatio)];
    const Share& delivery = point.delivery;
    fmt::print(
        out,
        "({} of {} runs): delivered {} of {}, {:.4f} ({:.4f} to {:.4f}); mean of runs {:.4f} ({:.4f} to "
        "{:.4f})\n",
        point.completed, results.plan.seeds.size(), delivery.count, delivery.of, delivery.value(),
        delivery.interval.low, delivery.interval.high, ratio.mean, ratio.interval.low, ratio.interval.high);
  }
}

}  // namespace halocline::clients
