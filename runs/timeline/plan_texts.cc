// SPDX-License-Identifier: BSD-3-Clause
#include "runs/timeline/plan_texts.h"

#include <cmath>

#include <fmt/format.h>

namespace halocline::clients {
namespace {

std::string behaviour_text(const vehicle_plan_t& plan) {
  const auto waypoints = waypoints_of(plan, plan.behaviour_index);
  if (!waypoints.empty())
    return fmt::format("steers for waypoint {} of {}", plan.waypoint_index + 1, waypoints.size());
  const auto index = static_cast<std::size_t>(plan.behaviour_index);
  if (index >= plan.behaviours.size()) return "carries out its plan";
  switch (plan.behaviours[index].behaviour_kind) {
    case plan_behaviour_t::HEADING:
      return "keeps its heading";
    case plan_behaviour_t::LOITER:
      return "loiters";
    case plan_behaviour_t::FOLLOW:
      return "follows " + plan.behaviours[index].leader_name;
    case plan_behaviour_t::WAIT:
      return "waits";
    case plan_behaviour_t::SEEK_LINK:
      return "seeks where it is heard by " + plan.behaviours[index].listener_names;
    default:
      return "carries out its plan";
  }
}

std::string doing(const autopilot_status_t& status, const vehicle_plan_t* plan) {
  switch (status.autopilot_activity) {
    case autopilot_status_t::WAITING_FOR_STATE:
      return "waits for the first state of its vehicle";
    case autopilot_status_t::LOST_STATE:
      return "has lost its vehicle's state";
    case autopilot_status_t::FOLLOWING_LEG: {
      const auto legs = plan != nullptr ? waypoints_of(*plan, status.behaviour_index).size() : 0;
      return legs > 0 ? fmt::format("follows leg {} of {}", status.waypoint_index + 1, legs)
                      : fmt::format("follows leg {}", status.waypoint_index + 1);
    }
    case autopilot_status_t::KEEPING_HEADING:
      return "keeps its heading";
    case autopilot_status_t::LOITERING:
      return "loiters";
    case autopilot_status_t::HOLDING:
      return "holds at the end of its plan";
    case autopilot_status_t::FINISHED:
      return "has finished its plan";
    case autopilot_status_t::WAITING_FOR_LEADER:
      return "circles until its leader reports";
    case autopilot_status_t::FOLLOWING_LEADER:
      return "follows its leader";
    case autopilot_status_t::LEADER_LOST:
      return "has lost its leader and keeps its course";
    case autopilot_status_t::CIRCLING_SAFELY:
      return "has lost its leader and circles at the safe depth";
    case autopilot_status_t::WAITING:
      return "waits";
    case autopilot_status_t::SURFACING:
      return "has finished its plan and rises";
    case autopilot_status_t::SEEKING_LINK:
      return "seeks where it is best heard";
    default:
      return "";
  }
}

}  // namespace

std::vector<Vec3> waypoints_of(const vehicle_plan_t& plan, std::int32_t behaviour_index) {
  std::vector<Vec3> waypoints;
  for (std::size_t i = 0; i < plan.waypoint_behaviour.size(); ++i) {
    if (plan.waypoint_behaviour[i] != behaviour_index) continue;
    const std::vector<double>& place = plan.waypoint_ned_m[i];
    waypoints.emplace_back(place[0], place[1], place[2]);
  }
  return waypoints;
}

std::string activity_text(const autopilot_status_t& status, const vehicle_plan_t* plan) {
  std::string text = doing(status, plan);
  if (status.depth_rule == autopilot_status_t::DEPTH_DESCENDING)
    text += ", descends until it sees the seabed";
  if (status.depth_rule == autopilot_status_t::DEPTH_AVOIDING_SEABED) text += ", kept above the seabed";
  return text;
}

std::string progress_text(const vehicle_plan_t& plan) {
  if (!plan.plan_ended) return behaviour_text(plan);
  if (plan.at_end == vehicle_plan_t::SURFACE) return "has done its plan and rises";
  return plan.at_end == vehicle_plan_t::STOP ? "has done its plan and stopped"
                                             : "has done its plan and holds";
}

double whole_number(double value) { return std::round(value) + 0.0; }

}  // namespace halocline::clients
