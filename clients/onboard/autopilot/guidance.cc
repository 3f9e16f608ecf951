// SPDX-License-Identifier: BSD-3-Clause
#include "clients/onboard/autopilot/guidance.h"

#include <cmath>
#include <numbers>

#include "core/check.h"
#include "core/elementary.h"

namespace halocline::clients {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kOrbitGain = 2.0;  // gain of the approach to the orbit; Beard and McLain use 1 to 4

Eigen::Vector2d horizontal(const Vec3& from, const Vec3& to) { return (to - from).head<2>(); }

double azimuth(const Eigen::Vector2d& north_east) {
  return elementary::atan2(north_east.y(), north_east.x());
}

// A waypoint is reached within the acceptance radius, or beyond the plane through it normal to the leg.
bool is_reached(const Mission& mission, const Progress& progress, const Vec3& position) {
  const Vec3& waypoint = mission.waypoints[progress.target];
  if (horizontal(position, waypoint).norm() <= mission.acceptance_radius_m) return true;
  const Eigen::Vector2d leg = horizontal(progress.leg_start_ned_m, waypoint);
  const bool has_direction = leg.norm() > mission.acceptance_radius_m;
  return has_direction && horizontal(waypoint, position).dot(leg) >= 0;
}

// Line-of-sight guidance (Fossen 2021, section 12.3), with e the cross-track error, positive to starboard:
//
//   course = azimuth of the leg - atan(e / lookahead)
//
// A leg shorter than the acceptance radius has no reliable direction; the course is then straight to the
// waypoint.
double course_on_leg(const Mission& mission, const Progress& progress, const Vec3& position) {
  const Vec3& waypoint = mission.waypoints[progress.target];
  const Eigen::Vector2d leg = horizontal(progress.leg_start_ned_m, waypoint);
  if (leg.norm() <= mission.acceptance_radius_m) return azimuth(horizontal(position, waypoint));
  const Eigen::Vector2d along = leg.normalized();
  const Eigen::Vector2d starboard(-along.y(), along.x());
  const double cross_track_m = horizontal(progress.leg_start_ned_m, position).dot(starboard);
  return wrapped(azimuth(along) - elementary::atan2(cross_track_m, mission.lookahead_m));
}

}  // namespace

double wrapped(double angle_rad) {
  const double turned = std::remainder(angle_rad, 2 * kPi);
  return turned == -kPi ? kPi : turned;
}

Progress begin(const Vec3& position_ned_m) { return {.leg_start_ned_m = position_ned_m}; }

Progress advance(const Mission& mission, Progress progress, const Vec3& position_ned_m) {
  require(!mission.waypoints.empty(), "a mission needs a waypoint");
  // One round at most: bounds the loop when all waypoints of a looping mission lie within the acceptance
  // radius.
  for (std::size_t i = 0; i < mission.waypoints.size() && !progress.at_end; ++i) {
    if (!is_reached(mission, progress, position_ned_m)) break;
    const bool last = progress.target + 1 == mission.waypoints.size();
    if (last && mission.at_end != AtEnd::kLoop) {
      progress.at_end = true;
    } else {
      progress.leg_start_ned_m = mission.waypoints[progress.target];
      progress.target = last ? 0 : progress.target + 1;
    }
  }
  return progress;
}

SetPoints set_points(const Mission& mission, const Progress& progress, const Vec3& position_ned_m) {
  SetPoints points{.z_ned_m = mission.waypoints.at(progress.target).z(), .speed_mps = mission.speed_mps};
  if (progress.at_end && stops(mission.at_end)) return stopped(mission.at_end, points.z_ned_m);
  if (progress.at_end) {
    points.course_rad =
        course_on_circle(mission.waypoints.back(), mission.hold_radius_m, true, position_ned_m);
  } else {
    points.course_rad = course_on_leg(mission, progress, position_ned_m);
  }
  return points;
}

SetPoints stopped(AtEnd at_end, double z_ned_m) {
  return {.propel = false, .surface = at_end == AtEnd::kSurface, .z_ned_m = z_ned_m};
}

// Orbit by a vector field (Beard and McLain 2012, eq. 10.13), with d the distance from the centre:
//
//   course = azimuth from the centre +- (pi/2 + atan(gain (d - radius) / radius)),  + clockwise
double course_on_circle(const Vec3& center_ned_m, double radius_m, bool clockwise,
                        const Vec3& position_ned_m) {
  const Eigen::Vector2d from_center = horizontal(center_ned_m, position_ned_m);
  const double inwards = kPi / 2 + elementary::atan(kOrbitGain * (from_center.norm() - radius_m) / radius_m);
  return wrapped(azimuth(from_center) + (clockwise ? inwards : -inwards));
}

}  // namespace halocline::clients
