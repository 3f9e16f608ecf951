// SPDX-License-Identifier: BSD-3-Clause
#include "clients/onboard/autopilot/plan.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "core/elementary.h"

namespace halocline::clients {
namespace {

using Vec2 = Eigen::Vector2d;

bool has_route(const Behaviour& behaviour) {
  return behaviour.kind == BehaviourKind::kWaypoints || behaviour.kind == BehaviourKind::kSurvey;
}

bool is_last(const Plan& plan, std::size_t index) { return index + 1 == plan.behaviours.size(); }

bool is_done(const Plan& plan, const PlanProgress& progress, double time_s) {
  const Behaviour& behaviour = plan.behaviours[progress.index];
  if (has_route(behaviour)) return progress.route.at_end;
  return behaviour.duration_s > 0 && time_s - progress.since_s >= behaviour.duration_s;
}

Mission route_of(const Behaviour& behaviour, const Mission& mission, AtEnd at_end) {
  Mission route = mission;
  route.at_end = at_end;
  if (behaviour.speed_mps > 0) route.speed_mps = behaviour.speed_mps;
  route.waypoints = behaviour.kind == BehaviourKind::kSurvey ? survey_points(behaviour) : behaviour.waypoints;
  if (!has_route(behaviour)) route.waypoints.clear();
  require(!has_route(behaviour) || !route.waypoints.empty(), "a behaviour of waypoints needs one");
  return route;
}

Vec3 center_of(const Behaviour& b) { return {b.center_north_m, b.center_east_m, b.depth_m}; }

SetPoints at_the_end(const Plan& plan, const PlanProgress& progress, const Vec3& position) {
  const Behaviour& last = plan.behaviours[progress.index];
  SetPoints points{.z_ned_m = progress.end_ned_m.z(), .speed_mps = plan.routes[progress.index].speed_mps};
  if (stops(plan.at_end)) return stopped(plan.at_end, points.z_ned_m);
  if (last.kind == BehaviourKind::kLoiter) {
    points.course_rad =
        course_on_circle(center_of(last), last.radius_m, last.sense == Sense::kClockwise, position);
  } else {
    points.course_rad = course_on_circle(progress.end_ned_m, plan.hold_radius_m, true, position);
  }
  return points;
}

SetPoints without_route(const Behaviour& behaviour, double speed_mps, const Vec3& position) {
  if (behaviour.kind == BehaviourKind::kWait) return stopped(AtEnd::kStop, position.z());
  SetPoints points{.course_rad = behaviour.heading_rad, .z_ned_m = behaviour.depth_m, .speed_mps = speed_mps};
  if (behaviour.kind == BehaviourKind::kLoiter) {
    points.course_rad = course_on_circle(center_of(behaviour), behaviour.radius_m,
                                         behaviour.sense == Sense::kClockwise, position);
  }
  return points;
}

}  // namespace

std::vector<Vec3> survey_points(const Behaviour& s) {
  require(s.track_spacing_m > 0 && s.length_m > 0 && s.width_m >= 0,
          "a survey needs a box and a spacing above 0");
  const Vec2 along(elementary::cos(s.heading_rad), elementary::sin(s.heading_rad)),
      starboard(-along.y(), along.x());
  const Vec2 center(s.center_north_m, s.center_east_m);
  const auto gaps = static_cast<int>(std::floor(s.width_m / s.track_spacing_m + 1e-9));
  std::vector<Vec3> points;
  for (int i = 0; i <= gaps; ++i) {
    const Vec2 middle = center + (i - 0.5 * gaps) * s.track_spacing_m * starboard;
    const double half_m = (i % 2 == 0 ? 1 : -1) * (0.5 * s.length_m + s.turn_m);
    const Vec2 from = middle - half_m * along, to = middle + half_m * along;
    points.emplace_back(from.x(), from.y(), s.depth_m);
    points.emplace_back(to.x(), to.y(), s.depth_m);
  }
  return points;
}

Plan make_plan(const Mission& mission, std::vector<Behaviour> behaviours) {
  if (behaviours.empty()) behaviours.push_back({.waypoints = mission.waypoints});
  Plan plan{std::move(behaviours), {}, mission.at_end, mission.hold_radius_m};
  const std::size_t count = plan.behaviours.size();
  for (std::size_t i = 0; i < count; ++i) {
    // Only the last route applies at_end, and not when the plan loops; a route before it stops at its end,
    // where the next behaviour takes over.
    const bool ends_here = is_last(plan, i) && (plan.at_end != AtEnd::kLoop || count == 1);
    plan.routes.push_back(route_of(plan.behaviours[i], mission, ends_here ? plan.at_end : AtEnd::kStop));
  }
  return plan;
}

PlanProgress begin(const Vec3& position_ned_m, double time_s) {
  return {.since_s = time_s, .route = begin(position_ned_m)};
}

PlanProgress advance(const Plan& plan, PlanProgress progress, const Vec3& position_ned_m, double time_s) {
  // One round at most, as in advance() of a mission's waypoints.
  for (std::size_t i = 0; i < plan.behaviours.size() && !progress.ended; ++i) {
    if (has_route(plan.behaviours[progress.index])) {
      progress.route = advance(plan.routes[progress.index], progress.route, position_ned_m);
    }
    if (!is_done(plan, progress, time_s)) break;
    const bool last = is_last(plan, progress.index);
    if (last && plan.at_end != AtEnd::kLoop) {
      progress.ended = !has_route(plan.behaviours[progress.index]);
      progress.end_ned_m = position_ned_m;
      break;
    }
    progress = {.index = last ? 0 : progress.index + 1, .since_s = time_s, .route = begin(position_ned_m)};
  }
  return progress;
}

SetPoints set_points(const Plan& plan, const PlanProgress& progress, const Vec3& position_ned_m) {
  const Behaviour& behaviour = plan.behaviours.at(progress.index);
  const Mission& route = plan.routes.at(progress.index);
  SetPoints points = progress.ended         ? at_the_end(plan, progress, position_ned_m)
                     : has_route(behaviour) ? set_points(route, progress.route, position_ned_m)
                                            : without_route(behaviour, route.speed_mps, position_ned_m);
  if (has_route(behaviour)) points.station_ned_m = route.waypoints.at(progress.route.target);
  if (behaviour.altitude_m > 0) {
    points.altitude_m = behaviour.altitude_m;
    points.max_z_ned_m = behaviour.max_depth_m;
  }
  return points;
}

}  // namespace halocline::clients
