// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/pages/request_fields.h"

#include "core/check.h"

namespace halocline::monitor {
namespace {

using nlohmann::json;

constexpr double kMaxSeconds = 9e9;

}  // namespace

double number_in(const json& request, const char* member, double lowest, double highest) {
  const auto found = request.find(member);
  require(found != request.end() && found->is_number(), std::string(member) + " is missing; it is a number");
  return require_in_range(found->get<double>(), lowest, highest, member);
}

std::int64_t integer_in(const json& request, const char* member, std::int64_t lowest, std::int64_t highest) {
  const double number = number_in(request, member, static_cast<double>(lowest), static_cast<double>(highest));
  const auto integer = static_cast<std::int64_t>(number);
  require(static_cast<double>(integer) == number, std::string(member) + " is no whole number");
  return integer;
}

std::string text_in(const json& request, const char* member) {
  const auto found = request.find(member);
  require(found != request.end() && found->is_string(), std::string(member) + " is missing; it is a text");
  return found->get<std::string>();
}

TimeWindow window_in(const json& request) {
  return {SimTime::from_seconds(number_in(request, "from_s", -kMaxSeconds, kMaxSeconds)),
          SimTime::from_seconds(number_in(request, "to_s", -kMaxSeconds, kMaxSeconds))};
}

std::size_t max_points_in(const json& request) {
  constexpr std::int64_t kUsual = 1000, kFewest = 8, kMax = 20'000;
  return static_cast<std::size_t>(
      request.contains("max_points") ? integer_in(request, "max_points", kFewest, kMax) : kUsual);
}

const clients::VehicleRecord& vehicle_in(const clients::RunTimeline& timeline, const json& request,
                                         const char* member) {
  const auto& vehicles = timeline.vehicles();
  require(!vehicles.empty(), "there are no vehicles yet");
  const auto last = static_cast<std::int64_t>(vehicles.size()) - 1;
  return vehicles[static_cast<std::size_t>(integer_in(request, member, 0, last))];
}

}  // namespace halocline::monitor
