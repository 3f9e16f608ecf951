// SPDX-License-Identifier: BSD-3-Clause
#include "halocline/sweep/sweep_plan.h"

#include <algorithm>
#include <set>
#include <string_view>

#include <fmt/format.h>

#include "bus/config/carried_files.h"
#include "core/check.h"
#include "core/csv_table.h"
#include "core/files/input_file.h"

namespace halocline::clients {
namespace {

constexpr std::int64_t kMaxSeed = 9'000'000'000'000'000;

std::string trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(" \t") - first + 1));
}

// Splits a text at the commas outside of quotes and brackets.
std::vector<std::string> split(std::string_view text) {
  std::vector<std::string> parts{""};
  int depth = 0;
  char quote = 0;
  for (const char c : text) {
    if (quote != 0) {
      quote = c == quote ? '\0' : quote;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else {
      depth += (c == '[' || c == '{') ? 1 : (c == ']' || c == '}') ? -1 : 0;
    }
    if (c == ',' && depth == 0 && quote == 0) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  for (std::string& part : parts) part = trimmed(part);
  return parts;
}

std::vector<std::string> values_of(const std::string& key, const std::string& text) {
  std::vector<std::string> values = split(text);
  for (const std::string& value : values)
    require(!value.empty(),
            "axis " + key + ": a value is missing in '" + text + "'; allowed is key=value,value,...");
  require(std::set<std::string>(values.begin(), values.end()).size() == values.size(),
          "axis " + key + " has a value twice");
  return values;
}

}  // namespace

std::size_t SweepPlan::points() const {
  std::size_t count = 1;
  for (const SweepAxis& axis : axes) count *= std::min(axis.values.size(), kMaxRuns + 1);
  return count;
}

SweepAxis parse_axis(const std::string& text) {
  const auto equals = text.find('=');
  const std::string key = trimmed(std::string_view(text).substr(0, std::min(equals, text.size())));
  const bool named = !key.empty() && key.find_first_of(" \t\"'") == std::string::npos;
  require(equals != std::string::npos && named,
          "axis '" + text + "'; allowed is section.key=value,value,... with values in TOML or words");
  return {key, values_of(key, text.substr(equals + 1))};
}

std::vector<std::int64_t> parse_seeds(const std::string& text) {
  std::set<std::int64_t> seeds;
  const std::string wrong =
      "seeds '" + text + "'; allowed are whole numbers and ranges, 0 to 9e15: 1..20 or 1,5,9..12";
  for (const std::string& part : split(text)) {
    const auto dots = part.find("..");
    const auto first = parse_number(trimmed(part.substr(0, dots)), std::int64_t{0}, kMaxSeed);
    const auto last = dots == std::string::npos
                          ? first
                          : parse_number(trimmed(part.substr(dots + 2)), std::int64_t{0}, kMaxSeed);
    require(first && last && *first <= *last, wrong);
    require(*last - *first < static_cast<std::int64_t>(SweepPlan::kMaxRuns), wrong);
    for (std::int64_t seed = *first; seed <= *last; ++seed) seeds.insert(seed);
  }
  return {seeds.begin(), seeds.end()};
}

std::string to_text(const std::vector<std::int64_t>& seeds) {
  std::string text;
  for (std::size_t i = 0; i < seeds.size();) {
    std::size_t last = i;
    while (last + 1 < seeds.size() && seeds[last + 1] == seeds[last] + 1) ++last;
    text += (text.empty() ? "" : ", ") + std::to_string(seeds[i]);
    if (last > i) text += ".." + std::to_string(seeds[last]);
    i = last + 1;
  }
  return text;
}

void check(const SweepPlan& plan) {
  require(!plan.scenario.empty(), "a sweep needs a scenario");
  require(!plan.seeds.empty(), "a sweep needs a seed");
  std::set<std::string> keys;
  for (const SweepAxis& axis : plan.axes) {
    require(!axis.values.empty(), "axis " + axis.key + " has no values");
    require(keys.insert(axis.key).second, "axis " + axis.key + " is given twice");
  }
  require(plan.points() <= SweepPlan::kMaxRuns && plan.runs() <= SweepPlan::kMaxRuns,
          "the sweep has more than " + std::to_string(SweepPlan::kMaxRuns) + " runs");
}

SweepRun run_of(const SweepPlan& plan, std::size_t index) {
  SweepRun run;
  run.index = index;
  run.point = index / plan.seeds.size();
  run.seed = plan.seeds.at(index % plan.seeds.size());
  run.at.resize(plan.axes.size());
  std::size_t rest = run.point;
  for (std::size_t i = plan.axes.size(); i-- > 0; rest /= plan.axes[i].values.size())
    run.at[i] = rest % plan.axes[i].values.size();
  run.overrides = plan.overrides;
  for (std::size_t i = 0; i < plan.axes.size(); ++i)
    run.overrides.push_back(plan.axes[i].key + "=" + plan.axes[i].values[run.at[i]]);
  if (plan.duration_s > 0) run.overrides.push_back("scenario.duration_s=" + format_number(plan.duration_s));
  run.overrides.push_back("scenario.seed=" + std::to_string(run.seed));
  return run;
}

void visit(bus::ConfigVisitor& v, SweepPlan& plan) {
  v.section("sweep", "Runs of one scenario over a grid of overrides and seeds", [&](bus::ConfigVisitor& s) {
    s.file("scenario", plan.scenario, bus::FileNames::kFiles, "scenario file");
    std::string seeds = to_text(plan.seeds);
    s.text("seeds", seeds, {}, "whole numbers and ranges: 1..20 or 1,5,9..12");
    bus::report_refusal(s, "seeds", [&] { plan.seeds = parse_seeds(seeds); });
    s.number("duration_s", plan.duration_s, {0, 3.2e7, "s", "simulated time of each run; 0: the scenario's"});
    s.number("level", plan.level, {0.5, 0.9999, "", "level of the confidence intervals"});
  });
  v.list(
      "axis", "a key that takes several values", plan.axes.size(),
      [&](std::size_t n) { plan.axes.resize(n); },
      [&](bus::ConfigVisitor& a, std::size_t i) {
        SweepAxis& axis = plan.axes[i];
        std::string values = fmt::format("{}", fmt::join(axis.values, ", "));
        a.text("key", axis.key, {}, "section.key of the scenario");
        a.text("values", values, {}, "in TOML or words, between commas");
        bus::report_refusal(a, "values", [&] { axis.values = values_of(axis.key, values); });
      });
  v.list(
      "set", "an override at every point", plan.overrides.size(),
      [&](std::size_t n) { plan.overrides.resize(n); },
      [&](bus::ConfigVisitor& o, std::size_t i) {
        o.text("override", plan.overrides[i], {}, "section.key=value");
      });
}

SweepPlan load_plan(const std::string& path) {
  SweepPlan plan;
  auto file = bus::ConfigFile::load(path);
  file.read([&](bus::ConfigVisitor& v) { visit(v, plan); });
  file.check(/*whole_file=*/true);
  return plan;
}

std::string to_toml(const SweepPlan& plan) {
  SweepPlan anywhere = plan;
  anywhere.scenario = absolute_place(plan.scenario.place());
  return bus::to_toml([&](bus::ConfigVisitor& v) { visit(v, anywhere); }, /*with_comments=*/false);
}

}  // namespace halocline::clients
