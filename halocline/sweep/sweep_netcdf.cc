// SPDX-License-Identifier: BSD-3-Clause
// Output of a sweep's results as netCDF-4, through netCDF's C library. Part of the module
// halocline_sweep_netcdf.so, which only sweep_summary.cc loads.
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bus/version.h"
#include "core/atomic_file.h"
#include "core/csv_table.h"
#include "halocline/sweep/run_metrics.h"
#include "halocline/sweep/sweep_plan.h"
#include "halocline/sweep/sweep_summary.h"
#include "runs/analysis/confidence.h"
#include "runs/export/netcdf_output.h"

namespace halocline::clients {
namespace {

using Dimensions = std::vector<int>;

// netCDF file whose variables are defined and written together.
class SweepFile : public NetcdfOutput {
 public:
  using NetcdfOutput::NetcdfOutput;

  void numbers(const std::string& name, const Dimensions& dimensions, const std::vector<double>& values,
               const std::string& unit, const std::string& meaning) {
    const int variable = define(name, Type::kDouble, dimensions, meaning);
    attribute(variable, "_FillValue", std::numeric_limits<double>::quiet_NaN());
    attribute(variable, "units", unit);
    put(variable, values);
  }
  // Writes a dimension's coordinate variable, whose values may not be missing.
  void coordinates(const std::string& name, int dimension, const std::vector<double>& values,
                   const std::string& unit, const std::string& meaning) {
    const int variable = define(name, Type::kDouble, {dimension}, meaning);
    attribute(variable, "units", unit);
    put(variable, values);
  }
  void counts(const std::string& name, const Dimensions& dimensions, const std::vector<long long>& values,
              const std::string& meaning) {
    const int variable = define(name, Type::kLong, dimensions, meaning);
    attribute(variable, "units", "1");
    put(variable, values);
  }
  void texts(const std::string& name, int dimension, const std::vector<std::string>& values,
             const std::string& meaning) {
    const int variable = define(name, Type::kText, {dimension}, meaning);
    std::vector<const char*> pointers;
    for (const std::string& value : values) pointers.push_back(value.c_str());
    put(variable, pointers);
  }

 private:
  int define(const std::string& name, Type type, const Dimensions& dimensions, const std::string& meaning) {
    const int defined = variable(name, type, dimensions);
    attribute(defined, "long_name", meaning);
    return defined;
  }
};

// Returns a variable's name for a key: environment_wind_mps for environment.wind_mps. Names in netCDF begin
// with a letter.
std::string variable_name(const std::string& key) {
  std::string name;
  for (const char c : key) name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  return std::isalpha(static_cast<unsigned char>(name.front())) != 0 ? name : "axis_" + name;
}

// Returns the unit that a key's suffix denotes (CONTRIBUTING.md); 1 for dimensionless values.
std::string unit_of(const std::string& key) {
  static const std::vector<std::pair<const char*, const char*>> units{
      {"_mps", "m s-1"},  {"_hz", "Hz"},     {"_bps", "bit s-1"},         {"_deg", "degree"}, {"_db", "dB"},
      {"_bytes", "byte"}, {"_rpm", "min-1"}, {"_degc", "degree_Celsius"}, {"_s", "s"},        {"_m", "m"}};
  for (const auto& [ending, unit] : units) {
    if (key.ends_with(ending)) return unit;
  }
  return "1";
}

// Returns the values of an axis if all are numbers.
std::optional<std::vector<double>> as_numbers(const SweepAxis& axis) {
  std::vector<double> numbers;
  for (const std::string& value : axis.values) {
    const auto number = parse_number(value);
    if (!number) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

struct Shape {
  Dimensions point, seed, outcome, pair, bound;  // `bound` is the last dimension of an interval
};

Dimensions operator+(Dimensions a, const Dimensions& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

Shape define_axes(SweepFile& file, const SweepResults& results) {
  Shape shape;
  for (const SweepAxis& axis : results.plan.axes) {
    const std::string name = variable_name(axis.key);
    shape.point.push_back(file.dimension(name, axis.values.size()));
    if (const auto numbers = as_numbers(axis))
      file.coordinates(name, shape.point.back(), *numbers, unit_of(axis.key), axis.key);
    else
      file.texts(name, shape.point.back(), axis.values, axis.key);
  }
  std::vector<double> seeds(results.plan.seeds.begin(), results.plan.seeds.end());
  shape.seed = {file.dimension("seed", seeds.size())};
  file.coordinates("seed", shape.seed[0], seeds, "1", "seed of all random draws");
  shape.outcome = {file.dimension("outcome", kOutcomes)};
  std::vector<std::string> outcomes;
  for (std::size_t outcome = 0; outcome < kOutcomes; ++outcome) outcomes.emplace_back(outcome_name(outcome));
  file.texts("outcome", shape.outcome[0], outcomes, "outcome of a packet at a receiver");
  shape.bound = {file.dimension("bound", 2)};
  file.texts("bound", shape.bound[0], {"low", "high"}, "ends of a confidence interval");
  return shape;
}

// Writes two variables: one for the values, one for their intervals.
class Estimates {
 public:
  void add(double value, const ConfidenceInterval& interval) {
    values_.push_back(value);
    intervals_.push_back(interval.low);
    intervals_.push_back(interval.high);
  }
  void write(SweepFile& file, const std::string& name, const Dimensions& dimensions, const Dimensions& bound,
             const std::string& unit, const std::string& meaning, const std::string& kind) const {
    file.numbers(name, dimensions, values_, unit, meaning);
    file.numbers(name + "_interval", dimensions + bound, intervals_, unit, meaning + ": " + kind);
  }

 private:
  std::vector<double> values_, intervals_;
};

constexpr const char* kWilson = "Wilson's interval, packets taken as independent";
constexpr const char* kStudent = "Student's t interval, runs taken as independent";
constexpr const char* kShares = "Wilson's interval by the variance of the runs, taken as independent";

void write_shares(SweepFile& file, const SweepResults& results, const Shape& shape) {
  Estimates delivery, outcomes;
  std::vector<long long> counts, addressed;
  for (const PointSummary& point : results.points) {
    delivery.add(point.delivery.value(), point.delivery.interval);
    addressed.push_back(point.delivery.of);
    for (const Share& outcome : point.outcomes) {
      outcomes.add(outcome.value(), outcome.interval);
      counts.push_back(outcome.count);
    }
  }
  file.counts("addressed_packets", shape.point, addressed,
              "packets at receivers they were addressed to, all seeds");
  delivery.write(file, "delivery_share", shape.point, shape.bound, "1",
                 "share of addressed packets that were received", kWilson);
  file.counts("outcome_count", shape.point + shape.outcome, counts,
              "packets at receivers by outcome, all seeds");
  outcomes.write(file, "outcome_share", shape.point + shape.outcome, shape.bound, "1",
                 "share of packets at receivers by outcome", kWilson);
}

void write_pairs(SweepFile& file, const SweepResults& results, const Shape& shape) {
  const auto pairs = results.pairs();
  if (pairs.empty()) return;
  const Dimensions pair{file.dimension("pair", pairs.size())};
  std::vector<std::string> from, to;
  for (const auto& [sender, receiver] : pairs) {
    from.push_back(sender);
    to.push_back(receiver);
  }
  file.texts("pair_from", pair[0], from, "sender");
  file.texts("pair_to", pair[0], to, "receiver");
  Estimates delivery;
  for (const PointSummary& point : results.points) {
    for (const auto& name : pairs) {
      const auto found = point.delivery_by_pair.find(name);
      const Share share =
          found != point.delivery_by_pair.end() ? found->second : Share{0, 0, wilson_interval(0, 0, 0.95)};
      delivery.add(share.value(), share.interval);
    }
  }
  delivery.write(file, "pair_delivery_share", shape.point + pair, shape.bound, "1",
                 "share of addressed packets that were received, by sender and receiver", kWilson);
}

void write_run_numbers(SweepFile& file, const SweepResults& results, const Shape& shape) {
  std::vector<long long> completed;
  for (const auto& run : results.runs) completed.push_back(run ? 1 : 0);
  file.counts("completed", shape.point + shape.seed, completed, "1 where the run has a result");
  for (std::size_t n = 0; n < kRunNumbers; ++n) {
    const RunNumberInfo& info = info_of(n);
    std::vector<double> values;
    for (const auto& run : results.runs)
      values.push_back(run ? run->numbers[n] : std::numeric_limits<double>::quiet_NaN());
    file.numbers(std::string(info.name) + "_of_run", shape.point + shape.seed, values, info.unit,
                 info.meaning);
    Estimates means;
    for (const PointSummary& point : results.points)
      means.add(point.numbers[n].mean, point.numbers[n].interval);
    means.write(file, info.name, shape.point, shape.bound, info.unit,
                std::string("mean over runs of: ") + info.meaning, info.is_share ? kShares : kStudent);
  }
}

void write_file(const SweepResults& results, const std::string& path) {
  AtomicFile replacement(path);
  SweepFile file(replacement.temporary_path());
  file.attribute("Conventions", "CF-1.8");
  file.attribute("title", "Halocline sweep of " + results.plan.scenario.place());
  file.attribute("source", std::string("halocline ") + bus::kVersion);
  file.attribute("comment", "confidence level " + format_number(results.plan.level));
  const Shape shape = define_axes(file, results);
  write_shares(file, results, shape);
  write_pairs(file, results, shape);
  write_run_numbers(file, results, shape);
  file.close();
  replacement.commit();
}

}  // namespace
}  // namespace halocline::clients

extern "C" halocline::clients::NetcdfWriter halocline_write_sweep_netcdf;

void halocline_write_sweep_netcdf(const halocline::clients::SweepResults& results, const std::string& path) {
  halocline::clients::write_file(results, path);
}
