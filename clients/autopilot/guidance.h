// SPDX-License-Identifier: BSD-3-Clause
// From a mission's waypoints and a vehicle's position to where to head, how deep and how fast.
//
// Model: the waypoints are joined by straight legs. On a leg, line-of-sight guidance (Fossen 2021, Handbook,
// 2nd ed., section 12.3): course = leg's azimuth - atan(cross-track error / lookahead). A waypoint is reached
// within the acceptance radius (horizontal), or when the plane through it across the leg is passed. After the
// last one the mission starts again, stops, comes to the surface, or holds: a clockwise orbit by a vector
// field (Beard and McLain 2012, Small Unmanned Aircraft, eq. 10.13): course = azimuth from the centre + pi/2
// + atan(gain (distance - radius) / radius). Depth is that of the waypoint ahead, from the start of its leg.
// Frame: world NED, metres; course clockwise from north, radians. Left out: current (the error it leaves
// shrinks with the lookahead), obstacles, time of arrival. Pure functions; threads do not matter.
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
  AtEnd at_end = AtEnd::kHold;     // after the last waypoint
  double acceptance_radius_m = 5;  // above 0
  double hold_radius_m = 30;       // of the orbit, above 0
  double lookahead_m = 15;         // of the line of sight, above 0
  double min_altitude_m = 3;       // kept above the seabed where the altimeter sees it; 0 or above
};

// How far a mission has come.
struct Progress {
  std::size_t target = 0;  // index of the waypoint ahead
  Vec3 leg_start_ned_m = Vec3::Zero();
  bool at_end = false;  // the last waypoint was reached, and the mission does not loop

  void archive(Archive& a) { a(target, leg_start_ned_m, at_end); }
};

// Where the depth of the set points comes from (seabed_ahead.h).
enum class DepthRule {
  kPlanned,         // the plan's
  kByAltitude,      // the plan's height above the seabed
  kDescending,      // down to a height above a seabed that the altimeter does not see yet
  kAvoidingSeabed,  // the least height above the seabed, instead of the plan's depth
};

// What to steer for.
struct SetPoints {
  bool propel = true;     // false: stopped, fins amidships
  bool surface = false;   // not propelled: rises by buoyancy engine or drop weight
  double course_rad = 0;  // -pi to pi
  double z_ned_m = 0;
  double speed_mps = 0;
  double climb_rad = 0;    // slope of the set path, up positive: added to the pitch of the depth law
  double altitude_m = 0;   // above 0: height above the ground to keep instead of z (seabed_ahead.h)
  double max_z_ned_m = 0;  // with an altitude: never deeper
  std::optional<Vec3> station_ned_m{};  // the point steered for, where there is one
  DepthRule depth_rule = DepthRule::kPlanned;
};

// The start of a mission from where the vehicle is.
Progress begin(const Vec3& position_ned_m);

// Moves on past every waypoint that is reached at this position.
Progress advance(const Mission& mission, Progress progress, const Vec3& position_ned_m);

// The set points at this position. `progress` is from advance() at the same position.
SetPoints set_points(const Mission& mission, const Progress& progress, const Vec3& position_ned_m);

// The course of a circle about `center`, from wherever the vehicle is; `radius_m` above 0.
double course_on_circle(const Vec3& center_ned_m, double radius_m, bool clockwise,
                        const Vec3& position_ned_m);

// Stopped where a plan ends; kSurface: to rise. `at_end` kStop or kSurface.
SetPoints stopped(AtEnd at_end, double z_ned_m);
inline bool stops(AtEnd at_end) { return at_end == AtEnd::kStop || at_end == AtEnd::kSurface; }

// The same direction within -pi (excluded) to pi.
double wrapped(double angle_rad);

}  // namespace halocline::clients
