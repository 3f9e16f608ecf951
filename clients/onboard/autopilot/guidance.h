// SPDX-License-Identifier: BSD-3-Clause
// Waypoint guidance: from a mission's waypoints and a vehicle's position to set points of course, depth and
// speed.
//
// Model: the waypoints are joined by straight legs. On a leg the course is that of line-of-sight guidance
// (Fossen 2021, Handbook, 2nd ed., section 12.3):
//
//   course = azimuth of the leg - atan(cross-track error / lookahead)
//
// A waypoint is reached within the acceptance radius (horizontal distance), or when the vehicle passes the
// plane through it normal to the leg. After the last waypoint the mission starts again, stops, surfaces, or
// holds. To hold is a clockwise orbit about the waypoint by a vector field (Beard and McLain 2012, Small
// Unmanned Aircraft, eq. 10.13):
//
//   course = azimuth from the centre + pi/2 + atan(gain (distance - radius) / radius)
//
// The set depth is that of the next waypoint, from the start of its leg. Frame: world NED, metres; course
// clockwise from north, radians. Left out: currents (the error they cause shrinks with the look-ahead
// distance), obstacles, times of arrival. Pure functions, safe in any thread.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/archive.h"
#include "core/frames.h"

namespace halocline::clients {

enum class AtEnd { kLoop, kHold, kStop, kSurface };

struct Mission {
  std::vector<Vec3> waypoints;     // at least one
  double speed_mps = 1.5;          // through the water, above 0
  AtEnd at_end = AtEnd::kHold;     // action after the last waypoint
  double acceptance_radius_m = 5;  // above 0
  double hold_radius_m = 30;       // radius of the orbit, above 0
  double lookahead_m = 15;         // look-ahead distance of line-of-sight guidance, above 0
  double min_altitude_m = 3;       // minimum height above the seabed, where it is measured; 0 or above
};

struct Progress {
  std::size_t target = 0;  // index of the next waypoint
  Vec3 leg_start_ned_m = Vec3::Zero();
  bool at_end = false;  // the last waypoint was reached, and the mission does not loop

  void archive(Archive& a) { a(target, leg_start_ned_m, at_end); }
};

// Origin of the set depth (seabed_ahead.h).
enum class DepthRule {
  kPlanned,         // depth of the plan
  kByAltitude,      // height above the seabed given by the plan
  kDescending,      // descending until the altimeter sees the seabed, to keep a height above it
  kAvoidingSeabed,  // minimum height above the seabed overrides the plan's depth
};

// Set points of the control laws.
struct SetPoints {
  bool propel = true;     // false: stopped, fins amidships
  bool surface = false;   // rise by buoyancy engine or drop weight, without propulsion
  double course_rad = 0;  // -pi to pi
  double z_ned_m = 0;
  double speed_mps = 0;
  double climb_rad = 0;    // slope of the set path, positive up: added to the pitch of the depth law
  double altitude_m = 0;   // above 0: height above the seabed to keep instead of z (seabed_ahead.h)
  double max_z_ned_m = 0;  // with an altitude: limit of z
  std::optional<Vec3> station_ned_m{};  // target point of thruster steering; empty: follow the course
  DepthRule depth_rule = DepthRule::kPlanned;
};

// Returns the progress of a mission that starts at this position.
Progress begin(const Vec3& position_ned_m);

// Returns the progress past every waypoint that is reached at this position.
Progress advance(const Mission& mission, Progress progress, const Vec3& position_ned_m);

// Returns the set points at this position. `progress` must be from advance() at the same position.
SetPoints set_points(const Mission& mission, const Progress& progress, const Vec3& position_ned_m);

// Returns the course onto and along a circle about `center_ned_m`, from any position; `radius_m` above 0.
double course_on_circle(const Vec3& center_ned_m, double radius_m, bool clockwise,
                        const Vec3& position_ned_m);

// Returns the set points at the end of a plan: stopped, and rising with kSurface. `at_end`: kStop or
// kSurface.
SetPoints stopped(AtEnd at_end, double z_ned_m);
inline bool stops(AtEnd at_end) { return at_end == AtEnd::kStop || at_end == AtEnd::kSurface; }

// Returns the angle wrapped to -pi (excluded) ... pi.
double wrapped(double angle_rad);

}  // namespace halocline::clients
