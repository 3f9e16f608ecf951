// SPDX-License-Identifier: BSD-3-Clause
#include "bus/config/config.h"

#include <cmath>
#include <utility>

#include "core/files/input_file.h"
#include "core/units.h"

namespace halocline::bus {
namespace {

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += (text.empty() ? "" : "\n") + line;
  return text;
}

// Returns 15 degrees rather than 14.999999999999998 if both are the same angle in radians.
double readable_degrees(double radians) {
  constexpr double kScale = 1e9;
  const double rounded = std::round(to_degrees(radians) * kScale) / kScale;
  return to_radians(rounded) == radians ? rounded : to_degrees(radians);
}

}  // namespace

void ConfigVisitor::when(bool counts, std::string_view choice, const std::function<void()>& body) {
  const std::string outer = missing_choice_;
  if (!counts && outer.empty()) missing_choice_ = choice;
  body();
  missing_choice_ = outer;
}

void ConfigVisitor::with_class(KeyClass key_class, const std::function<void()>& body) {
  const KeyClass outer = key_class_;
  key_class_ = std::max(outer, key_class);
  body();
  key_class_ = outer;
}

ConfigErrors::ConfigErrors(std::vector<std::string> lines)
    : InvalidArgument(joined(lines)), lines_(std::move(lines)) {}

void seconds(ConfigVisitor& v, std::string_view key, SimDuration& value, const NumberRule& rule_in_seconds) {
  double value_s = value.seconds();
  v.number(key, value_s, rule_in_seconds);
  value = SimDuration::from_seconds(value_s);
}

void require_readable(ConfigVisitor& v, std::string_view key, const FilePath& path) {
  if (v.writing()) return;
  if (path.empty()) return v.problem(key, "allowed is the name of a file");
  const std::string reason = why_unreadable(path.place());
  if (reason.empty()) return;
  const auto* origin = static_cast<const FileOrigin*>(path.origin().get());
  const bool is_recorded = origin != nullptr && origin->unpacked != nullptr;
  const std::string difference = is_recorded ? origin->unpacked->difference(path.given()) : "";
  v.problem(key, "cannot read " + path.place() + ": " + reason +
                     (difference.empty() ? "" : "; " + difference + "; --set names another"));
}

void report_refusal(ConfigVisitor& v, std::string_view key, const std::function<void()>& attempt) {
  try {
    attempt();
  } catch (const InvalidArgument& error) {
    v.problem(key, error.what());
  }
}

void degrees(ConfigVisitor& v, std::string_view key, double& radians, const NumberRule& rule_in_degrees) {
  // Only a value from the file is converted, so that a default is preserved to the last bit.
  double value_deg = readable_degrees(radians);
  const double before = value_deg;
  v.number(key, value_deg, rule_in_degrees);
  if (value_deg != before) radians = to_radians(value_deg);
}

void degrees(ConfigVisitor& v, std::string_view key, std::vector<double>& radians,
             const NumberRule& rule_in_degrees) {
  std::vector<double> values_deg;
  for (const double angle : radians) values_deg.push_back(readable_degrees(angle));
  const std::vector<double> before = values_deg;
  v.numbers(key, values_deg, rule_in_degrees);
  if (values_deg == before) return;
  radians.clear();
  for (const double angle_deg : values_deg) radians.push_back(to_radians(angle_deg));
}

}  // namespace halocline::bus
