// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/pages/plan_json.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <vector>

#include "runs/timeline/plan_texts.h"

namespace halocline::monitor {
namespace {

using nlohmann::json;

const char* kind_text(const vehicle_plan_t& plan) {
  constexpr const char* kKinds[] = {"waypoints", "heading", "loiter",   "survey",
                                    "follow",    "wait",    "seek link"};
  const auto index = static_cast<std::size_t>(plan.behaviour_index);
  if (index >= plan.behaviours.size()) return "waypoints";
  const int kind = plan.behaviours[index].behaviour_kind;
  return kind >= 0 && kind < static_cast<int>(std::size(kKinds)) ? kKinds[kind] : "unknown";
}

const char* end_text(const vehicle_plan_t& plan) {
  switch (plan.at_end) {
    case vehicle_plan_t::LOOP:
      return "loop";
    case vehicle_plan_t::HOLD:
      return "hold";
    case vehicle_plan_t::SURFACE:
      return "surface";
    default:
      return "stop";
  }
}

// Returns the index, among all waypoints of the plan, of the one that is steered for; null when there is
// none.
json leg_of(const vehicle_plan_t& plan) {
  if (plan.plan_ended != 0 || clients::waypoints_of(plan, plan.behaviour_index).empty()) return nullptr;
  const auto before = std::count_if(plan.waypoint_behaviour.begin(), plan.waypoint_behaviour.end(),
                                    [&](std::int32_t behaviour) { return behaviour < plan.behaviour_index; });
  return before + plan.waypoint_index;
}

// Returns the activity of a vehicle with a capital first letter.
std::string activity_of(const clients::VehicleRecord& vehicle, const autopilot_status_t& status, SimTime at) {
  std::string text = clients::activity_text(status, vehicle.plan_at(at));
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

}  // namespace

json plan_json(const clients::VehicleRecord& vehicle, SimTime at) {
  if (vehicle.plans.empty()) return nullptr;
  const auto* known = vehicle.plans.at_or_before(at);
  const vehicle_plan_t& plan = (known == nullptr ? vehicle.plans.front() : *known).value;
  json waypoints = json::array();
  for (const std::vector<double>& place : plan.waypoint_ned_m) waypoints.push_back(place);
  return {{"kind", kind_text(plan)},
          {"at_end", end_text(plan)},
          {"radius_m", plan.acceptance_radius_m},
          {"leg", leg_of(plan)},
          {"waypoints", std::move(waypoints)}};
}

std::string activity_at(const clients::VehicleRecord& vehicle, SimTime at) {
  const auto* status = vehicle.activity.at_or_before(at);
  return status == nullptr ? "" : activity_of(vehicle, status->value, at);
}

json activities_json(const clients::VehicleRecord& vehicle, const TimeWindow& window) {
  json all = json::array();
  std::string last;
  for (const auto& [at, status] : vehicle.activity.between(window.from, window.to)) {
    std::string text = activity_of(vehicle, status, at);
    if (text == last) continue;
    all.push_back({{"begin_s", at.seconds()}, {"label", text}});
    last = std::move(text);
  }
  return all;
}

}  // namespace halocline::monitor
